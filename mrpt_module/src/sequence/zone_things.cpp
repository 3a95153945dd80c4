// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/zone_things.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace lidar_obstacles {
namespace {

constexpr double kGroup = 1.0;  ///< loose returns in a square of this edge are one thing [m]

/// An obstacle, or a group of loose returns.
struct Thing {
    int id = -1;
    ObstacleClass cls = ObstacleClass::Unknown;
    ZoneReason how = ZoneReason::Returns;
    int returns = 0;        ///< in the zone
    double distance = 0.0;  ///< from the vehicle [m]
    MovingThing moving;
};

/// Of a polygon, along the axes: quicker to ask than the polygon.
struct Bounds {
    Eigen::Array2d low = Eigen::Array2d::Constant(std::numeric_limits<double>::infinity());
    Eigen::Array2d high = -low;

    double distanceTo(const Eigen::Vector2d& p) const {
        return (low - p.array()).max(p.array() - high).max(0.0).matrix().norm();
    }
};

Bounds boundsOf(const ZonePolygon& polygon) {
    Bounds bounds;
    for (const ZonePoint& corner : polygon.outer()) {
        bounds.low = bounds.low.min(Eigen::Array2d(corner.x(), corner.y()));
        bounds.high = bounds.high.max(Eigen::Array2d(corner.x(), corner.y()));
    }
    return bounds;
}

bool hasClass(const ZoneRule& rule, ObstacleClass cls) { return rule.classes[static_cast<std::size_t>(cls)]; }

bool counts(const ZoneRule& rule, const Obstacle& o) {
    if (!hasClass(rule, o.cls)) return false;
    if (rule.min_age > 0.0 && (!o.track || o.track->age < rule.min_age)) return false;
    float all = 0.0f, listed = 0.0f;
    for (std::size_t c = 0; c < o.probability.size(); ++c) {
        all += o.probability[c];
        listed += rule.classes[c] ? o.probability[c] : 0.0f;
    }
    return all <= 0.0f || listed >= rule.min_probability;  // all zero: told by size, which gives no probability
}

bool isIn(const PlacedZone& zone, const Eigen::Vector2d& p) { return distance(zone.polygon, p) <= zone.rule.margin; }

/// Those of the returns that are in the zone and low enough.
std::vector<std::int32_t> returnsIn(const PlacedZone& zone, const std::vector<std::int32_t>& returns,
                                    const SequenceResult& found) {
    const Bounds around = boundsOf(zone.polygon);
    std::vector<std::int32_t> in;
    for (const std::int32_t i : returns) {
        if (static_cast<double>(found.detection.ground.height[i]) > zone.rule.max_height) continue;
        const Eigen::Vector2d p = found.cloud.xyz[i].head<2>().cast<double>();
        if (around.distanceTo(p) <= zone.rule.margin && isIn(zone, p)) in.push_back(i);
    }
    return in;
}

/// From the vehicle's outline to the nearest of the returns [m]; from the origin where there is none.
double nearestOf(const std::vector<std::int32_t>& returns, const ZoneScene& scene) {
    double nearest = std::numeric_limits<double>::infinity();
    const Bounds around = boundsOf(scene.vehicle);
    for (const std::int32_t i : returns) {
        const Eigen::Vector2d p = scene.found.cloud.xyz[i].head<2>().cast<double>();
        if (scene.vehicle.outer().empty())
            nearest = std::min(nearest, p.norm());
        else if (around.distanceTo(p) < nearest)
            nearest = std::min(nearest, distance(scene.vehicle, p));
    }
    return nearest;
}

bool standsAbove(const Obstacle& o, const ZoneRule& rule, const GroundModel& ground) {
    return !o.points.empty() && std::all_of(o.points.begin(), o.points.end(), [&](std::int32_t i) {
        return static_cast<double>(ground.height[i]) > rule.max_height;
    });
}

/// Do all its returns over the zone hang higher than what counts: a crown beside its trunk?
bool hangsOver(const Obstacle& o, const PlacedZone& zone, const ZoneScene& scene) {
    if (o.cls != ObstacleClass::Structure) return false;
    return std::any_of(o.points.begin(), o.points.end(),
                       [&](std::int32_t i) { return isIn(zone, scene.found.cloud.xyz[i].head<2>().cast<double>()); });
}

/// Is it the box alone that reaches into the zone, far from all returns of this scan, and beams passed there?
bool isDisproved(const Obstacle& o, const PlacedZone& zone, const ZoneScene& scene) {
    constexpr double kFar = 0.5;  // from the returns on an object to what of it is hidden behind a corner at most [m]
    const auto isNear = [&](std::int32_t i) {
        return distance(zone.polygon, Eigen::Vector2d(scene.found.cloud.xyz[i].head<2>().cast<double>())) <= kFar;
    };
    if (std::any_of(o.points.begin(), o.points.end(), isNear)) return false;
    return zone.view.passedThrough(toPolygon(moved(cornersOf(o.box), zone.T_zone_vehicle)));
}

/// How far beyond its box a thing may reach of which no side was seen whole: half of what was added to the one that was
/// seen best; a rider whose box is shorter than any bicycle, half of what it lacks. Of vehicles their tracks know
/// better [m].
double doubtOf(const Obstacle& o) {
    constexpr double kShortestBicycle = 1.6;  // [m]
    if (o.cls == ObstacleClass::Vehicle || o.cls == ObstacleClass::Structure || o.points.empty()) return 0.0;
    const Eigen::Vector2d added = (o.box.size - o.seen_box.size).head<2>();
    const double lacking = o.cls == ObstacleClass::Cyclist ? kShortestBicycle - o.box.size.head<2>().maxCoeff() : 0.0;
    return 0.5 * std::max({0.0, added.minCoeff(), lacking});
}

/// An obstacle in the zone; none where it is not, or does not count.
std::optional<Thing> thingOf(const Obstacle& o, const PlacedZone& zone, const ZoneScene& scene) {
    if (!counts(zone.rule, o) || standsAbove(o, zone.rule, scene.found.detection.ground)) return std::nullopt;
    const bool hidden = o.track && !o.track->seen;
    if (!hidden && o.num_points < zone.rule.min_returns) return std::nullopt;
    Thing thing;
    thing.id = o.id;
    thing.cls = o.cls;
    thing.moving.outline = cornersOf(o.box);
    const ZonePolygon box = toPolygon(thing.moving.outline);
    const std::vector<std::int32_t> in = returnsIn(zone, o.points, scene.found);
    thing.returns = static_cast<int>(in.size());
    const bool by_returns = thing.returns >= zone.rule.min_returns;
    const bool by_box = distance(zone.polygon, box) <= zone.rule.margin + doubtOf(o);
    if (!by_returns && (!by_box || isDisproved(o, zone, scene))) return std::nullopt;
    if (in.empty() && !hidden && hangsOver(o, zone, scene)) return std::nullopt;
    thing.how = hidden ? ZoneReason::Hidden : by_returns ? ZoneReason::Returns : ZoneReason::Box;
    thing.distance = nearestOf(in, scene);
    if (by_box && !scene.vehicle.outer().empty())  // no nearer than the zone is
        thing.distance =
            std::min(thing.distance, std::max(distance(scene.vehicle, box), distance(scene.vehicle, zone.polygon)));
    if (!std::isfinite(thing.distance)) thing.distance = distance(box, Eigen::Vector2d(0.0, 0.0));
    if (o.track && o.track->velocity && o.cls != ObstacleClass::Structure) thing.moving.velocity = *o.track->velocity;
    return thing;
}

/// Has a return another one beside it in the scan that is no ground and may be on the same thing? Drops of rain have
/// none. True where the scan has no view.
bool hasCompany(const SequenceResult& found, std::int32_t i) {
    const PointCloud& cloud = found.cloud;
    const std::vector<std::uint8_t>& is_ground = found.detection.ground.is_ground;
    constexpr int kColumns = 3;
    constexpr float kApart = 0.1f, kPerMetre = 0.06f;  // a ring and a half of a VLP-16 [m]
    if (cloud.view.empty()) return true;
    const int ring = cloud.ring[i], column = cloud.view.column_of[i];
    const float limit = kApart + kPerMetre * (cloud.xyz[i] - cloud.originOf(i)).norm();
    for (int r = std::max(ring - 1, cloud.firstRing(ring)); r <= std::min(ring + 1, cloud.endRing(ring) - 1); ++r)
        for (int k = -kColumns; k <= kColumns; ++k) {
            const std::int32_t j = cloud.view.at(r, cloud.view.wrap(column + k));
            if (j >= 0 && j != i && is_ground[j] == 0 && (cloud.xyz[j] - cloud.xyz[i]).norm() < limit) return true;
        }
    return false;
}

/// Loose returns in the zone, by squares.
std::vector<Thing> looseThings(const PlacedZone& zone, const ZoneScene& scene) {
    if (!hasClass(zone.rule, ObstacleClass::Unknown) || zone.rule.min_age > 0.0) return {};
    std::map<std::pair<int, int>, std::vector<std::int32_t>> squares;
    for (const std::int32_t i : returnsIn(zone, scene.loose, scene.found)) {
        if (!hasCompany(scene.found, i)) continue;
        const Eigen::Vector3f& p = scene.found.cloud.xyz[i];
        squares[{static_cast<int>(std::floor(p.x() / kGroup)), static_cast<int>(std::floor(p.y() / kGroup))}].push_back(
            i);
    }
    std::vector<Thing> things;
    for (const auto& [square, returns] : squares) {
        if (static_cast<int>(returns.size()) < zone.rule.min_returns) continue;
        Thing thing;
        thing.returns = static_cast<int>(returns.size());
        thing.distance = nearestOf(returns, scene);
        OrientedBox box;
        box.center = {kGroup * (square.first + 0.5), kGroup * (square.second + 0.5), 0.0};
        box.size = {kGroup, kGroup, 1.0};
        thing.moving.outline = cornersOf(box);
        things.push_back(std::move(thing));
    }
    return things;
}

/// How many beams show a step, a drop or missing ground in the zone, and how near the first of them is.
Thing lowIn(const LowThing& low, const PlacedZone& zone, const ZoneScene& scene) {
    Thing thing;
    thing.cls = ObstacleClass::Structure;
    thing.how = low.kind == LowKind::Drop ? ZoneReason::Drop : ZoneReason::Step;
    thing.moving.outline = cornersOf(low.box);
    thing.distance = std::numeric_limits<double>::infinity();
    const Bounds around = boundsOf(zone.polygon);
    for (const LowSpan& s : low.spans) {
        const Eigen::Vector2d from = s.from.cast<double>(), to = s.to.cast<double>();
        const double length = (to - from).norm();
        if (around.distanceTo(0.5 * (from + to)) > 0.5 * length + zone.rule.margin) continue;
        const ZoneSegment segment({from.x(), from.y()}, {to.x(), to.y()});
        if (distance(zone.polygon, segment) > zone.rule.margin) continue;
        ++thing.returns;
        thing.distance =
            std::min(thing.distance, scene.vehicle.outer().empty() ? from.norm() : distance(scene.vehicle, from));
    }
    return thing;
}

/// Steps and drops in the zone, and whether ground is missing.
std::vector<Thing> lowThings(const PlacedZone& zone, const ZoneScene& scene, ZoneContent& content) {
    std::vector<Thing> things;
    for (const LowThing& low : scene.found.detection.low) {
        const bool hole = low.kind == LowKind::NoGround;
        if (hole && zone.rule.min_seen <= 0.0) continue;  // what nobody sees does not count there
        const bool counts = hasClass(zone.rule, ObstacleClass::Structure) && zone.rule.min_age <= 0.0;
        if (!hole && (!counts || std::abs(low.height) < zone.rule.min_height)) continue;
        Thing thing = lowIn(low, zone, scene);
        if (thing.returns < (hole ? 1 : zone.rule.min_returns)) continue;
        if (hole)
            content.ground_missing = true;
        else
            things.push_back(std::move(thing));
    }
    return things;
}

/// Takes a thing into account.
void add(const Thing& thing, const PlacedZone& zone, const ZoneScene& scene, ZoneContent& content) {
    const ZoneRule& rule = zone.rule;
    content.returns += thing.returns;
    const bool is_nearest = !content.nearest || thing.distance < *content.nearest;
    if (is_nearest) content.nearest = thing.distance;
    bool near = rule.nearest ? thing.distance < *rule.nearest : !rule.time_to_contact;
    ZoneReason how = thing.how;
    if (rule.time_to_contact && !near) {
        if (!scene.motion) {
            content.speed_missing = true;
            return;
        }
        const auto soon =
            timeToContact(scene.vehicle, *scene.motion, thing.moving, {rule.margin, *rule.time_to_contact});
        if (soon && (!content.time_to_contact || *soon < *content.time_to_contact)) content.time_to_contact = soon;
        near = soon.has_value();
        how = ZoneReason::Contact;
    }
    if (!near || (content.reason && !is_nearest)) return;
    content.reason = how;
    content.id = thing.id;
    content.cls = thing.cls;
}

}  // namespace

ZoneScene zoneScene(const SequenceResult& found, const Outline& vehicle, const Trajectory& trajectory) {
    ZoneScene scene{found, {}, {}, vehicleMotion(trajectory, found.cloud.timestamp)};
    if (!vehicle.empty()) scene.vehicle = toPolygon(vehicle);
    std::vector<std::uint8_t> taken(found.cloud.size(), 0);
    for (const std::int32_t i : found.detection.filtered) taken[i] = 1;
    for (const Obstacle& o : found.detection.obstacles)
        for (const std::int32_t i : o.points) taken[i] = 1;
    scene.loose.reserve(found.detection.candidates.size());
    for (const std::int32_t i : found.detection.candidates)
        if (taken[i] == 0) scene.loose.push_back(i);
    return scene;
}

ZoneContent contentOf(const PlacedZone& zone, const ZoneScene& scene) {
    ZoneContent content;
    for (const Obstacle& o : scene.found.detection.obstacles)
        if (const auto thing = thingOf(o, zone, scene)) add(*thing, zone, scene, content);
    for (const Thing& thing : looseThings(zone, scene)) add(thing, zone, scene, content);
    for (const Thing& thing : lowThings(zone, scene, content)) add(thing, zone, scene, content);
    return content;
}

}  // namespace lidar_obstacles
