// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <ostream>
#include <stdexcept>
#include <utility>

#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/testing/matchers.h"
#include "text.h"

namespace lidar_obstacles::testing {
namespace {

constexpr std::size_t kMisses = 3;  ///< that a message lists

void requirePositive(double tolerance) {
    if (!(tolerance > 0.0)) throw std::invalid_argument("HasObstacle: a tolerance must be a positive number");
}

/// Between two directions [deg], 0 .. 180; `period` [rad] is what they hold modulo.
double apart(double a, double b, double period) { return std::abs(std::remainder(a - b, period)) * 180.0 / M_PI; }

}  // namespace

HasObstacle& HasObstacle::near(double x, double y, double tolerance) {
    requirePositive(tolerance);
    place_ = Place{x, y, tolerance};
    return *this;
}

HasObstacle& HasObstacle::heading(double yaw, double tolerance_deg) {
    requirePositive(tolerance_deg);
    heading_ = Angle{yaw, tolerance_deg};
    return *this;
}

HasObstacle& HasObstacle::facing(double yaw, double tolerance_deg) {
    requirePositive(tolerance_deg);
    facing_ = Angle{yaw, tolerance_deg};
    return *this;
}

HasObstacle& HasObstacle::speed(double metres_per_second, double tolerance) {
    requirePositive(tolerance);
    speed_ = Speed{metres_per_second, tolerance};
    return *this;
}

HasObstacle& HasObstacle::probability(double at_least) {
    if (!(at_least >= 0.0 && at_least <= 1.0)) {
        throw std::invalid_argument("HasObstacle: a probability lies between 0 and 1");
    }
    min_probability_ = at_least;
    return *this;
}

double HasObstacle::distanceTo(const Obstacle& o) const {
    const double x = place_ ? place_->x : 0.0;
    const double y = place_ ? place_->y : 0.0;
    return std::hypot(o.box.center.x() - x, o.box.center.y() - y);
}

// Here and below: what is no number is in no tolerance.
void HasObstacle::addAngleFaults(const Obstacle& o, std::vector<std::string>& faults) const {
    if (heading_ && !o.heading_valid) faults.emplace_back("has no heading");
    if (heading_ && o.heading_valid) {
        const double off = apart(o.box.yaw, heading_->yaw, M_PI);
        if (!(off <= heading_->tolerance_deg)) faults.push_back("heading " + number(off) + " deg off");
    }
    if (!facing_) return;
    if (!o.track || !o.track->direction_known) {
        faults.emplace_back("its front is not known");
        return;
    }
    const double off = apart(o.box.yaw, facing_->yaw, 2.0 * M_PI);
    if (!(off <= facing_->tolerance_deg)) faults.push_back("front " + number(off) + " deg off");
}

void HasObstacle::addTrackFaults(const Obstacle& o, std::vector<std::string>& faults) const {
    if (!speed_) return;
    if (!o.track || !o.track->velocity) {
        faults.emplace_back("its speed is not known");
        return;
    }
    const double off = o.track->velocity->norm() - speed_->metres_per_second;
    if (!(std::abs(off) <= speed_->tolerance)) {
        faults.push_back(number(std::abs(off)) + " m/s too " + (off > 0.0 ? "fast" : "slow"));
    }
}

std::vector<std::string> HasObstacle::faultsOf(const Obstacle& o) const {
    std::vector<std::string> faults;
    if (o.cls != cls_) faults.push_back(std::string("is no ") + toString(cls_));
    if (place_ && !(distanceTo(o) <= place_->tolerance)) faults.push_back(number(distanceTo(o), 2) + " m away");
    addAngleFaults(o, faults);
    addTrackFaults(o, faults);
    const double probability = probabilityOf(o);
    if (probability < min_probability_) faults.push_back("probability " + number(probability, 2));
    return faults;
}

bool HasObstacle::matches(const std::vector<Obstacle>& obstacles, std::ostream* explanation) const {
    std::vector<std::pair<const Obstacle*, std::vector<std::string>>> misses;
    for (const Obstacle& o : obstacles) {
        std::vector<std::string> faults = faultsOf(o);
        if (faults.empty()) {
            if (explanation != nullptr) *explanation << describe(o);
            return true;
        }
        misses.emplace_back(&o, std::move(faults));
    }
    if (explanation == nullptr) return false;
    if (misses.empty()) *explanation << "there is no obstacle at all";
    std::stable_sort(misses.begin(), misses.end(), [this](const auto& a, const auto& b) {
        return place_ ? distanceTo(*a.first) < distanceTo(*b.first) : a.second.size() < b.second.size();
    });
    misses.resize(std::min(misses.size(), kMisses));
    for (const auto& [obstacle, faults] : misses) {
        *explanation << "\n    " << describe(*obstacle) << ": ";
        for (std::size_t i = 0; i < faults.size(); ++i) *explanation << (i > 0 ? ", " : "") << faults[i];
    }
    return false;
}

std::string HasObstacle::wanted() const {
    std::string text = toString(cls_);
    if (place_) text += " within " + number(place_->tolerance, 2) + " m of " + place(place_->x, place_->y);
    if (heading_) text += ", heading " + degrees(heading_->yaw) + " within " + number(heading_->tolerance_deg) + " deg";
    if (facing_) text += ", front to " + degrees(facing_->yaw) + " within " + number(facing_->tolerance_deg) + " deg";
    if (speed_) text += ", " + number(speed_->metres_per_second) + " m/s within " + number(speed_->tolerance) + " m/s";
    if (min_probability_ > 0.0) text += ", probability at least " + number(min_probability_, 2);
    return text;
}

void HasObstacle::DescribeTo(std::ostream* os) const { *os << "has an obstacle: " << wanted(); }
void HasObstacle::DescribeNegationTo(std::ostream* os) const { *os << "has no obstacle: " << wanted(); }

}  // namespace lidar_obstacles::testing
