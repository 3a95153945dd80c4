// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>

#include "lidar_obstacles/testing/matchers.h"
#include "text.h"

namespace lidar_obstacles::testing {
namespace {

constexpr std::size_t kListed = 5;  ///< obstacles that a message lists

}  // namespace

EmptyCorridor::EmptyCorridor(double x_from, double x_to, double half_width)
    : x_from_(x_from), x_to_(x_to), half_width_(half_width) {
    if (!(x_from < x_to) || !(half_width > 0.0)) {
        throw std::invalid_argument("EmptyCorridor: it must reach from a smaller to a larger x and have a width");
    }
}

/// Two rectangles are apart if the axes of one of them tell them apart. A box that is no box may be anywhere.
bool EmptyCorridor::holds(const OrientedBox& box) const {
    const double c = std::cos(box.yaw);
    const double s = std::sin(box.yaw);
    const double half_length = 0.5 * (x_to_ - x_from_);
    const double dx = box.center.x() - 0.5 * (x_from_ + x_to_);
    const double dy = box.center.y();
    const double box_length = 0.5 * box.size.x();
    const double box_width = 0.5 * box.size.y();
    const double turned_c = std::abs(c);
    const double turned_s = std::abs(s);
    return !(std::abs(dx) >= half_length + box_length * turned_c + box_width * turned_s ||
             std::abs(dy) >= half_width_ + box_length * turned_s + box_width * turned_c ||
             std::abs(dx * c + dy * s) >= box_length + half_length * turned_c + half_width_ * turned_s ||
             std::abs(dy * c - dx * s) >= box_width + half_length * turned_s + half_width_ * turned_c);
}

bool EmptyCorridor::matches(const std::vector<Obstacle>& obstacles, std::ostream* explanation) const {
    std::vector<const Obstacle*> inside;
    for (const Obstacle& o : obstacles)
        if (holds(o.box)) inside.push_back(&o);
    if (inside.empty() || explanation == nullptr) return inside.empty();
    std::stable_sort(inside.begin(), inside.end(), [](const Obstacle* a, const Obstacle* b) {
        return a->box.center.head<2>().norm() < b->box.center.head<2>().norm();
    });
    *explanation << inside.size() << " in it:";
    for (std::size_t i = 0; i < std::min(inside.size(), kListed); ++i) *explanation << "\n    " << describe(*inside[i]);
    if (inside.size() > kListed) *explanation << "\n    and " << inside.size() - kListed << " farther away";
    return false;
}

void EmptyCorridor::DescribeTo(std::ostream* os) const {
    *os << "has no obstacle between x = " << number(x_from_) << " and " << number(x_to_) << ", within "
        << number(half_width_) << " m of the middle";
}

void EmptyCorridor::DescribeNegationTo(std::ostream* os) const {
    *os << "has an obstacle between x = " << number(x_from_) << " and " << number(x_to_) << ", within "
        << number(half_width_) << " m of the middle";
}

}  // namespace lidar_obstacles::testing
