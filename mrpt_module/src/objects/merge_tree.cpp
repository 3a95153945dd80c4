// SPDX-License-Identifier: BSD-3-Clause
#include "objects/merge_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "objects/footprint.h"
#include "objects/join_gap.h"
#include "scan/label_sets.h"

namespace lidar_obstacles {
namespace {

/// Two pieces, and how near they are.
struct Link {
    int a = 0;
    int b = 0;
    float length = 0.0f;  ///< as the scan could resolve it [m]
};

/// A gap as the scan could resolve it [m].
float resolved(const Gap& gap, const PointCloud& cloud) {
    constexpr float kLean = 0.4f;  // rise over run of a windscreen, 22 deg
    const Eigen::Vector2f from = cloud.xyz[gap.from].head<2>();
    const Eigen::Vector2f way = cloud.xyz[gap.to].head<2>() - from;
    const Eigen::Vector2f sight = (from + 0.5f * way - cloud.originOf(gap.from).head<2>()).normalized();
    const float along = sight.dot(way);
    const float across = sight.x() * way.y() - sight.y() * way.x();
    return std::hypot(across, kLean * along);
}

/// Are two together no larger than the largest vehicle?
bool mayFit(const Footprint& a, const Footprint& b, const GroupingParams& params) {
    if (surelyWithin(a.box.merged(b.box).sizes(), params.max_length, params.max_width)) return true;
    const SmallestRectangle r = smallestRectangle(merged(a, b));
    return r.length <= params.max_length && r.width <= params.max_width;
}

class TreeBuilder {
  public:
    TreeBuilder(const std::vector<Cluster>& pieces, const Beams& beams, const GroupingParams& params)
        : beams_(beams), params_(params), sets_(static_cast<int>(pieces.size())) {
        tree_.reserve(2 * pieces.size());
        footprints_.reserve(2 * pieces.size());
        for (const Cluster& piece : pieces) {
            tree_.emplace_back();
            tree_.back().points = piece.points;
            tree_.back().hanging = piece.hangs ? 1 : 0;
            footprints_.push_back(footprintOf(piece.points, beams.cloud()));
        }
        root_.resize(pieces.size());
        std::iota(root_.begin(), root_.end(), 0);
    }

    MergeTree build() {
        std::vector<Link> links = linksOfNeighbours();
        std::sort(links.begin(), links.end(), [](const Link& p, const Link& q) {
            return p.length != q.length ? p.length < q.length : p.a != q.a ? p.a < q.a : p.b < q.b;
        });
        for (const Link& link : links) note(link);
        for (const Link& link : links) join(link);
        return {std::move(tree_), std::move(footprints_), {}};
    }

  private:
    /// All pairs of pieces within reach of each other: a sweep along x.
    std::vector<Link> linksOfNeighbours() const {
        const auto reach = static_cast<float>(params_.max_depth);
        std::vector<int> order;
        order.reserve(tree_.size());
        for (int k = 0; k < static_cast<int>(tree_.size()); ++k) order.push_back(k);
        std::sort(order.begin(), order.end(), [&](int a, int b) { return boxOf(a).min().x() < boxOf(b).min().x(); });
        std::vector<Link> links;
        for (auto p = order.begin(); p != order.end(); ++p) {
            for (auto q = p + 1; q != order.end() && boxOf(*q).min().x() < boxOf(*p).max().x() + reach; ++q) {
                if (boxOf(*p).squaredExteriorDistance(boxOf(*q)) >= reach * reach) continue;
                const auto [a, b] = std::minmax(*p, *q);
                const float length = linkBetween(footprints_[a], footprints_[b], beams_.cloud(), params_);
                if (length <= params_.max_gap) links.push_back({a, b, length});
            }
        }
        return links;
    }

    const Eigen::AlignedBox2f& boxOf(int k) const { return footprints_[k].box; }

    /// The nearest other piece of each.
    void note(const Link& link) {
        for (const int k : {link.a, link.b}) tree_[k].next_gap = std::min(tree_[k].next_gap, link.length);
    }

    void join(const Link& link) {
        const int set_a = sets_.find(link.a);
        const int set_b = sets_.find(link.b);
        if (set_a == set_b) return;
        const int a = root_[set_a];
        const int b = root_[set_b];
        if (!mayFit(footprints_[a], footprints_[b], params_)) return;
        const int whole = static_cast<int>(tree_.size());
        Hypothesis h;
        h.part = {a, b};
        h.gap = link.length;
        h.pieces = tree_[a].pieces + tree_[b].pieces;
        h.hanging = tree_[a].hanging + tree_[b].hanging;
        h.points.reserve(tree_[a].points.size() + tree_[b].points.size());
        h.points = tree_[a].points;
        h.points.insert(h.points.end(), tree_[b].points.begin(), tree_[b].points.end());
        tree_[a].parent = tree_[b].parent = whole;
        tree_[a].next_gap = std::min(tree_[a].next_gap, link.length);
        tree_[b].next_gap = std::min(tree_[b].next_gap, link.length);
        tree_.push_back(std::move(h));
        footprints_.push_back(merged(footprints_[a], footprints_[b]));
        sets_.join(set_a, set_b);
        root_[sets_.find(set_a)] = whole;
    }

    const Beams& beams_;
    const GroupingParams& params_;
    LabelSets sets_;
    std::vector<int> root_;  ///< hypothesis of each set of pieces
    std::vector<Hypothesis> tree_;
    std::vector<Footprint> footprints_;
};

}  // namespace

float linkBetween(const Footprint& a, const Footprint& b, const PointCloud& cloud, const GroupingParams& params) {
    constexpr float kTooFar = 1e9f;
    return mayFit(a, b, params) ? resolved(gapBetween(a, b), cloud) : kTooFar;
}

MergeTree mergeTree(const std::vector<Cluster>& pieces, const Beams& beams, const GroupingParams& params) {
    return TreeBuilder(pieces, beams, params).build();
}

}  // namespace lidar_obstacles
