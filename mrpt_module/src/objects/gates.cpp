// SPDX-License-Identifier: BSD-3-Clause
#include "objects/gates.h"

#include <algorithm>
#include <utility>

#include "lidar_obstacles/classification.h"
#include "objects/expectations.h"
#include "objects/footprint.h"
#include "objects/structure_boxes.h"
#include "scan/median.h"

namespace lidar_obstacles {
namespace {

float distance(const PointCloud& cloud, std::int32_t i) {
    return (cloud.xyz[i].head<2>() - cloud.originOf(i).head<2>()).norm();
}

/// How high it may be: where the next ring passed above its returns [m].
float highestTop(const Cluster& cluster, const SurfaceTops& topOf, const Beams& beams) {
    float top = cluster.top;
    for (const std::int32_t i : cluster.points) {
        const float range = (topOf.cloud.xyz[i] - topOf.cloud.originOf(i)).norm();
        top = std::max(top, topOf.ground.height[i] + beams.stepUp(beams.ring(i)) * range);
    }
    return top;
}

/// The ground about a thing, above what the model says: the median of the returns on it; the thing's own bottom where
/// there is none.
float groundAbout(const Cluster& cluster, const SurfaceTops& scan) {
    constexpr float kNear = 1.0f;  // [m]
    Eigen::Vector2f middle = Eigen::Vector2f::Zero();
    for (const std::int32_t i : cluster.points) middle += scan.cloud.xyz[i].head<2>();
    middle /= static_cast<float>(cluster.points.size());
    std::vector<float> heights;
    for (std::size_t i = 0; i < scan.cloud.size(); ++i)
        if (scan.ground.is_ground[i] != 0 && (scan.cloud.xyz[i].head<2>() - middle).norm() < kNear)
            heights.push_back(scan.ground.height[i]);
    return heights.empty() ? cluster.bottom : medianOf(heights);
}

/// How high it rises [m]. Where the model lies above the ground, as on the far side of a ridge, things seem to lie
/// below it: they rise above the ground about them. Mirror images in wet asphalt do not: the ground is where it should
/// be.
float riseOf(const Cluster& cluster, const SurfaceTops& scan, const GateParams& params) {
    const float top = cluster.max_top;
    if (top >= params.min_top || top - cluster.bottom < params.min_top) return top;
    return top - std::min(0.0f, groundAbout(cluster, scan));
}

/// Bottom and top; the top followed upwards along its surfaces.
void measureHeights(Cluster& cluster, SurfaceTops& topOf) {
    constexpr float kFollowFrom = 1.5f;  // lower surfaces are not followed: what is above them is known
    constexpr std::size_t kMaxFollowed = 64;
    const std::size_t stride = 1 + cluster.points.size() / kMaxFollowed;
    cluster.bottom = bottomOf(cluster.points, topOf.ground);
    cluster.top = -1e9f;
    for (std::size_t k = 0; k < cluster.points.size(); ++k) {
        const std::int32_t i = cluster.points[k];
        const float height = topOf.ground.height[i];
        const bool follow = k % stride == 0 && height > kFollowFrom && !topOf.cloud.view.empty();
        cluster.top = std::max(cluster.top, follow ? topOf(i) : height);
    }
}

/// The class probabilities of a group. What is rather a small piece of a road user than most of one is Unknown: the
/// class is that of the larger piece.
ClassProbabilities probabilitiesOf(const Hypothesis& h) {
    const auto of = [&](Category c) { return h.category[static_cast<std::size_t>(c)]; };
    ClassProbabilities p = h.probability;
    const auto keep = [&](ObstacleClass cls, float whole, float piece) {
        if (piece <= whole) return;
        float& told = p[static_cast<std::size_t>(cls)];
        const float kept = told * whole / (whole + piece);
        p[static_cast<std::size_t>(ObstacleClass::Unknown)] += told - kept;
        told = kept;
    };
    const float person = of(Category::Pedestrian) + of(Category::Cyclist);
    keep(ObstacleClass::Vehicle, of(Category::Vehicle), of(Category::VehiclePart));
    keep(ObstacleClass::Pedestrian, person, of(Category::PersonPart));
    keep(ObstacleClass::Cyclist, person, of(Category::PersonPart));
    return p;
}

/// The class of a group: the one that is more likely than not, and no structure that is in doubt. What may be a road
/// user and what may be a wall is unknown.
ObstacleClass classOfGroup(const ClassProbabilities& p) {
    constexpr float kSure = 0.8f;
    constexpr float kLikely = 0.5f;
    const auto best = topClass(p);
    const bool doubtful = p[static_cast<std::size_t>(best)] < (best == ObstacleClass::Structure ? kSure : kLikely);
    return doubtful ? ObstacleClass::Unknown : best;
}

/// The same with what was expected there: that speaks for road users only.
ObstacleClass classOfGroup(const ClassProbabilities& scan, const ClassProbabilities& expected) {
    const ObstacleClass cls = classOfGroup(expected);
    return isRoadUser(cls) ? cls : classOfGroup(scan);
}

/// Is it to be followed by small boxes, as it has no box of its own: structure, what is more likely several things than
/// one, and what is unknown and longer than such a box?
bool followed(const Cluster& c, const Hypothesis& h, const PointCloud& cloud) {
    if (c.cls == ObstacleClass::Structure) return true;
    return c.cls == ObstacleClass::Unknown &&
           (h.whole < 0.5f || smallestRectangle(footprintOf(c.points, cloud)).length > kLongestStructureBox);
}

}  // namespace

bool passedBelow(const SurfaceTops& scan, std::int32_t i) {
    constexpr float kBehind = 0.5f;
    constexpr float kBelly = 0.6f;  // beams go through below a truck [m]
    const PointCloud& cloud = scan.cloud;
    for (int ring = cloud.ring[i] - 1; ring >= cloud.firstRing(cloud.ring[i]); --ring) {
        const std::int32_t j = cloud.view.at(ring, cloud.view.column_of[i]);
        if (j < 0) continue;
        const float here = distance(cloud, i);
        const float there = distance(cloud, j);
        if (there <= here + kBehind) return false;
        const float origin = cloud.originOf(i).z();
        const float beam = origin + (cloud.xyz[j].z() - origin) * here / there;  // z of the beam where the return is
        return beam - (cloud.xyz[i].z() - scan.ground.height[i]) > kBelly;
    }
    return false;
}

bool floats(const std::vector<std::int32_t>& points, const SurfaceTops& scan) {
    const PointCloud& cloud = scan.cloud;
    if (cloud.view.empty()) return false;
    std::vector<std::pair<std::int32_t, std::int32_t>> hits;  // column, return; the lowest ring of a column first
    hits.reserve(points.size());
    const auto columnOf = [&](std::int32_t i) {  // those of each sensor are others
        return cloud.view.column_of[i] + cloud.view.columns * static_cast<std::int32_t>(cloud.sensorOf(i));
    };
    for (const std::int32_t i : points) hits.emplace_back(columnOf(i), i);
    std::sort(hits.begin(), hits.end(), [&](const auto& a, const auto& b) {
        return a.first != b.first ? a.first < b.first : cloud.ring[a.second] < cloud.ring[b.second];
    });
    std::size_t columns = 0;
    std::size_t passed = 0;
    for (std::size_t k = 0; k < hits.size(); ++k) {
        if (k > 0 && hits[k].first == hits[k - 1].first) continue;
        ++columns;
        passed += static_cast<std::size_t>(passedBelow(scan, hits[k].second));
    }
    return 2 * passed > columns;
}

float bottomOf(const std::vector<std::int32_t>& points, const GroundModel& ground) {
    float bottom = 1e9f;
    for (const std::int32_t i : points) bottom = std::min(bottom, ground.height[i]);
    return bottom;
}

void markHanging(std::vector<Cluster>& pieces, const SurfaceTops& scan, const GateParams& params) {
    for (Cluster& piece : pieces) {
        piece.bottom = bottomOf(piece.points, scan.ground);
        piece.hangs = piece.bottom > params.max_bottom && floats(piece.points, scan);
    }
}

std::vector<Cluster> withoutOverhangs(std::vector<Cluster> pieces, const SurfaceTops& scan, const GateParams& params,
                                      std::vector<RejectedCluster>& rejected) {
    std::vector<Cluster> kept;
    kept.reserve(pieces.size());
    markHanging(pieces, scan, params);
    for (Cluster& piece : pieces) {
        const float bottom = piece.bottom;
        if (piece.hangs)
            rejected.push_back({std::move(piece), RejectReason::Floating, bottom, params.max_bottom});
        else
            kept.push_back(std::move(piece));
    }
    return kept;
}

Clusters sortGroups(const std::vector<Hypothesis>& tree, SurfaceTops& topOf, const Beams& beams,
                    const GateParams& params) {
    constexpr int kFewest = 3;  // one or two may be drops or dust
    const int fewest = std::min(kFewest, params.min_points);
    Clusters out;
    for (const Hypothesis& h : tree) {
        if (!h.chosen) continue;
        Cluster c;
        c.points = h.points;
        c.probability = probabilitiesOf(h);
        c.cls = classOfGroup(c.probability, asExpected(c.probability, h));
        measureHeights(c, topOf);
        c.max_top = highestTop(c, topOf, beams);
        const auto points = static_cast<double>(c.points.size());
        const bool few = points < params.min_points;
        if (few) c.cls = ObstacleClass::Unknown;
        if (points < fewest)
            out.rejected.push_back({std::move(c), RejectReason::TooFewPoints, points, 1.0 * fewest});
        else if (const float bottom = c.bottom; h.hanging == h.pieces)
            out.rejected.push_back({std::move(c), RejectReason::Floating, bottom, params.max_bottom});
        else if (const float rise = riseOf(c, topOf, params); rise < params.min_top)
            out.rejected.push_back({std::move(c), RejectReason::TooLow, rise, params.min_top});
        else
            (few || followed(c, h, topOf.cloud) ? out.structure : out.accepted).push_back(std::move(c));
    }
    return out;
}

Clusters gateBySize(std::vector<Cluster> components, SurfaceTops& topOf, const GateParams& params, double person) {
    Clusters out;
    for (Cluster& c : components) {
        const SmallestRectangle size = smallestRectangle(footprintOf(c.points, topOf.cloud));
        const auto points = static_cast<double>(c.points.size());
        measureHeights(c, topOf);
        c.max_top = c.top;
        c.cls = size.length <= person ? ObstacleClass::Pedestrian : ObstacleClass::Vehicle;
        if (points < params.min_points)
            out.rejected.push_back({std::move(c), RejectReason::TooFewPoints, points, 1.0 * params.min_points});
        else if (size.length < params.min_extent)
            out.rejected.push_back({std::move(c), RejectReason::TooSmall, size.length, params.min_extent});
        else if (size.length > params.max_length)
            out.rejected.push_back({std::move(c), RejectReason::TooLarge, size.length, params.max_length});
        else if (size.width > params.max_width)
            out.rejected.push_back({std::move(c), RejectReason::TooLarge, size.width, params.max_width});
        else
            out.accepted.push_back(std::move(c));
    }
    return out;
}

}  // namespace lidar_obstacles
