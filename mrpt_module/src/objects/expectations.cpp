// SPDX-License-Identifier: BSD-3-Clause
#include "objects/expectations.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "lidar_obstacles/classification.h"
#include "objects/groups.h"

namespace lidar_obstacles {
namespace {

/// 0 where at most half of the returns that are in the group or in the box are in both, 1 where all are.
float agreementOf(const ExpectedMatch& e, std::size_t points) {
    if (e.inside == 0) return 0.0f;
    const float either = static_cast<float>(static_cast<int>(points) + e.in_box - e.inside);
    return std::max(0.0f, 2.0f * static_cast<float>(e.inside) / either - 1.0f);
}

/// The box of an object seen from above, with the error of its place.
class ExpectedBox {
  public:
    explicit ExpectedBox(const ExpectedObject& object)
        : center_(object.box.center.head<2>().cast<float>()),
          along_(static_cast<float>(std::cos(object.box.yaw)), static_cast<float>(std::sin(object.box.yaw))) {
        constexpr double kRough = 0.15;  // no box fits its body better [m]
        constexpr double kMost = 0.5;    // beyond it stands something else [m]
        half_ = (0.5 * object.box.size.head<2>().array() + kRough + std::min(kMost, object.std)).cast<float>();
        const Eigen::Vector2f reach(std::abs(along_.x()) * half_.x() + std::abs(along_.y()) * half_.y(),
                                    std::abs(along_.y()) * half_.x() + std::abs(along_.x()) * half_.y());
        bounds_ = {center_ - reach, center_ + reach};
    }
    /// How far from its middle, as a share of the way to its sides; above 1: outside.
    float placeOf(const Eigen::Vector3f& p) const {
        const Eigen::Vector2f d = p.head<2>() - center_;
        return std::max(std::abs(d.dot(along_)) / half_.x(),
                        std::abs(d.x() * along_.y() - d.y() * along_.x()) / half_.y());
    }
    bool holds(const Eigen::Vector3f& p) const { return placeOf(p) <= 1.0f; }
    const Eigen::AlignedBox2f& bounds() const { return bounds_; }

  private:
    Eigen::Vector2f center_, along_, half_;
    Eigen::AlignedBox2f bounds_;
};

/// Returns of each hypothesis in a box.
void countInside(const MergeTree& tree, const PointCloud& cloud, const ExpectedBox& box, std::vector<int>& inside) {
    for (std::size_t k = 0; k < tree.hypotheses.size(); ++k) {
        const Hypothesis& h = tree.hypotheses[k];
        if (h.part[0] >= 0)
            inside[k] = inside[static_cast<std::size_t>(h.part[0])] + inside[static_cast<std::size_t>(h.part[1])];
        else if (tree.footprints[k].box.intersects(box.bounds()))
            inside[k] = static_cast<int>(std::count_if(h.points.begin(), h.points.end(),
                                                       [&](std::int32_t i) { return box.holds(cloud.xyz[i]); }));
        else
            inside[k] = 0;
    }
}

/// The returns of a piece by the box they are deepest in; those in none come last.
std::vector<std::vector<std::int32_t>> byBox(const std::vector<std::int32_t>& points, const PointCloud& cloud,
                                             const std::vector<const ExpectedBox*>& boxes) {
    std::vector<std::vector<std::int32_t>> parts(boxes.size() + 1);
    for (const std::int32_t i : points) {
        std::size_t in = boxes.size();
        float least = 1.0f;
        for (std::size_t k = 0; k < boxes.size(); ++k) {
            const float place = boxes[k]->placeOf(cloud.xyz[i]);
            if (place > least) continue;
            least = place;
            in = k;
        }
        parts[in].push_back(i);
    }
    return parts;
}

/// Adds a piece in the parts that its boxes make of it.
void addParted(Cluster piece, const PointCloud& cloud, const std::vector<const ExpectedBox*>& boxes,
               std::vector<Cluster>& out) {
    std::vector<std::vector<std::int32_t>> parts = byBox(piece.points, cloud, boxes);
    std::vector<std::int32_t> rest = std::move(parts.back());
    parts.pop_back();
    for (std::vector<std::int32_t>& part : parts) {
        if (part.size() >= kSpeck && part.size() + kSpeck <= piece.points.size()) {
            out.emplace_back();
            out.back().points = std::move(part);
        } else {
            rest.insert(rest.end(), part.begin(), part.end());
        }
    }
    if (rest.empty()) return;
    std::sort(rest.begin(), rest.end());
    piece.points = std::move(rest);
    out.push_back(std::move(piece));
}

}  // namespace

std::vector<Cluster> partedAtExpected(std::vector<Cluster> pieces, const PointCloud& cloud,
                                      const std::vector<ExpectedObject>& objects) {
    if (objects.empty()) return pieces;
    const std::vector<ExpectedBox> boxes(objects.begin(), objects.end());
    std::vector<Cluster> out;
    for (Cluster& piece : pieces) {
        const Eigen::AlignedBox2f bounds = boundsOf(piece.points, cloud);
        std::vector<const ExpectedBox*> near;
        for (const ExpectedBox& box : boxes)
            if (bounds.intersects(box.bounds())) near.push_back(&box);
        if (near.empty())
            out.push_back(std::move(piece));
        else
            addParted(std::move(piece), cloud, near, out);
    }
    return out;
}

void lookForExpected(MergeTree& tree, const PointCloud& cloud, const std::vector<ExpectedObject>& objects) {
    std::vector<int> inside(tree.hypotheses.size());
    for (std::size_t object = 0; object < objects.size(); ++object) {
        countInside(tree, cloud, ExpectedBox(objects[object]), inside);
        int in_box = 0;
        for (std::size_t k = 0; k < inside.size(); ++k)
            if (tree.hypotheses[k].parent < 0) in_box += inside[k];
        for (std::size_t k = 0; k < inside.size(); ++k) {
            Hypothesis& h = tree.hypotheses[k];
            const ExpectedMatch match{static_cast<int>(object), inside[k], in_box, objects[object].classes};
            if (inside[k] > 0 && agreementOf(match, h.points.size()) >= agreementOf(h.expected, h.points.size()))
                h.expected = match;
        }
    }
}

ExpectedMatch expectedOfUnion(const Hypothesis& a, const Hypothesis& b) {
    const bool larger = a.expected.inside >= b.expected.inside;
    ExpectedMatch e = larger ? a.expected : b.expected;
    if (a.expected.object == b.expected.object) e.inside = a.expected.inside + b.expected.inside;
    return e;
}

float likelierWhole(const Hypothesis& h) {
    constexpr float kTelling = 10.0f;  // a group ends by chance where an object was expected so much more rarely
    return std::pow(kTelling, agreementOf(h.expected, h.points.size()));
}

ClassProbabilities asExpected(const ClassProbabilities& scan, const Hypothesis& h) {
    const float agreement = agreementOf(h.expected, h.points.size());
    if (agreement <= 0.0f) return scan;
    constexpr auto kRarest = static_cast<float>(kRarestInOneLook);
    ClassProbabilities both{};
    for (std::size_t k = 0; k < both.size(); ++k)
        both[k] = std::max(kRarest, scan[k]) * std::pow(std::max(1e-6f, h.expected.classes[k]), agreement);
    const float sum = std::accumulate(both.begin(), both.end(), 0.0f);
    for (float& p : both) p /= sum;
    return both;
}

}  // namespace lidar_obstacles
