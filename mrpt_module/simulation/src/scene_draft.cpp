// SPDX-License-Identifier: BSD-3-Clause
#include "scene_draft.h"

#include <algorithm>
#include <cmath>

#include "clutter_builder.h"
#include "lidar_obstacles/simulation/models.h"
#include "lidar_obstacles/simulation/motion.h"

namespace lidar_obstacles::simulation {
namespace {

constexpr double kTimeStep = 0.2;       ///< between the times at which room is looked at [s]
constexpr double kMargin = 0.12;        ///< between any two things [m]
constexpr double kMovingMargin = 0.35;  ///< about what moves: it is looked at now and then only

bool isLine(ClutterKind kind) {
    return kind == ClutterKind::Wall || kind == ClutterKind::Fence || kind == ClutterKind::Hedge ||
           kind == ClutterKind::Rail;
}

}  // namespace

SceneDraft::SceneDraft(Scenario scenario, const Random& random)
    : scenario_(std::move(scenario)), random_(random), track_(std::make_shared<const Track>(scenario_.track)) {
    for (double s = 0.0; s <= length(); s += 2.0) middle_line_.push_back(track_->at(s).position);
    const double top = scenario_.sensor.pose.position.z() + 0.3;
    const Eigen::Vector3d body(scenario_.ego.wheelbase + 1.2, scenario_.ego.gauge + 0.6, top);
    site_.add({roomAlong(scenario_.ego.waypoints, body)});
}

double SceneDraft::logUniform(double low, double high) { return low * std::exp(uniform(0.0, std::log(high / low))); }

int SceneDraft::count(int low, int high) {
    return std::min(high, low + static_cast<int>(random_.uniform() * (high - low + 1)));
}

std::string SceneDraft::choose(const Choices& choices) {
    double sum = 0.0;
    for (const auto& [name, weight] : choices) sum += weight;
    double left = uniform(0.0, sum);
    for (const auto& [name, weight] : choices)
        if ((left -= weight) < 0.0) return name;
    return choices.back().first;
}

Spot SceneDraft::spotIn(const Zone& zone) {
    const double s = uniform(zone.from, zone.to), d = uniform(zone.low, zone.high);
    return {s, d, uniform(-M_PI, M_PI)};
}

Spot SceneDraft::spotBeside() {
    if (edges_.empty()) return {};
    const Edge& edge = edges_[static_cast<std::size_t>(count(0, static_cast<int>(edges_.size()) - 1))];
    const double away = uniform(0.35, 0.8), along = uniform(-1.0, 1.0);
    Eigen::Vector2d offset(along * edge.half.x(), edge.half.y() + away);
    if (chance(0.3)) offset = {edge.half.x() + away, along * edge.half.y()};
    if (chance(0.5)) offset = -offset;
    const double c = std::cos(edge.spot.yaw), s = std::sin(edge.spot.yaw);
    return {edge.spot.s + c * offset.x() - s * offset.y(), edge.spot.d + s * offset.x() + c * offset.y(),
            uniform(-M_PI, M_PI)};
}

std::uint64_t SceneDraft::newVariant() { return 1 + static_cast<std::uint64_t>(uniform(0.0, 1e6)); }

Footprint SceneDraft::footprintAt(const Spot& spot, const Eigen::Vector3d& size) const {
    return {track_->place(spot.s, spot.d), 0.5 * size.head<2>(), track_->at(spot.s).heading + spot.yaw, 0.0, size.z()};
}

Room SceneDraft::roomAlong(const std::vector<Waypoint>& waypoints, const Eigen::Vector3d& size) const {
    const Path path(track_, waypoints);
    Room room;
    for (double t = 0.0; t < scenario_.duration + kTimeStep; t += kTimeStep) {
        const PlanarPose pose = path.at(t);
        room.push_back({pose.position, 0.5 * size.head<2>(), pose.yaw, 0.0, size.z()});
    }
    return room;
}

bool SceneDraft::isInside(const std::vector<Room>& parts) const {
    // Within the terrain's reach of the middle line.
    for (const Room& part : parts)
        for (const Footprint& f : part) {
            double nearest = 1e9;
            for (const Eigen::Vector2d& place : middle_line_) nearest = std::min(nearest, (place - f.center).norm());
            if (nearest + f.half.norm() > scenario_.terrain.reach - 2.5) return false;
        }
    return true;
}

bool SceneDraft::claim(const std::vector<Room>& parts, double margin) {
    if (!site_.isFree(parts, margin) || !isInside(parts)) return false;
    site_.add(parts);
    return true;
}

bool SceneDraft::addObject(ObjectSpec object, const Room& room) {
    if (!claim({room}, room.size() > 1 ? kMovingMargin : kMargin)) return false;
    scenario_.objects.push_back(std::move(object));
    return true;
}

bool SceneDraft::stand(const std::string& model, const Spot& spot) {
    const std::uint64_t variant = newVariant();
    const Eigen::Vector3d size = modelNamed(model, variant)->size;
    if (!addObject({model, Standing{spot.s, spot.d, spot.yaw}, variant}, {footprintAt(spot, size)})) return false;
    edges_.push_back({spot, 0.5 * size.head<2>()});
    return true;
}

bool SceneDraft::move(const std::string& model, const std::vector<Waypoint>& path) {
    const std::uint64_t variant = newVariant();
    return addObject({model, Moving{path, false}, variant}, roomAlong(path, modelNamed(model, variant)->size));
}

bool SceneDraft::moveOn(const std::string& model, const Spot& from, double speed) {
    const double way = speed * duration();
    return move(model, {{0.0, from.s, from.d},
                        {duration(), from.s + way * std::cos(from.yaw), from.d + way * std::sin(from.yaw)}});
}

std::vector<Room> SceneDraft::roomOf(const ClutterSpec& spec) const {
    std::vector<Room> parts;
    if (isLine(spec.kind)) {
        const int n = std::max(1, static_cast<int>(std::ceil((spec.to - spec.from) / 2.0)));
        const double length = (spec.to - spec.from) / n;
        for (int i = 0; i < n; ++i)
            parts.push_back({footprintAt({spec.from + (i + 0.5) * length, spec.d, 0.0},
                                         {1.1 * length, 1.1 * spec.width + 0.1, spec.height})});
        return parts;
    }
    const double heading = track_->at(spec.from).heading + spec.yaw;
    const Eigen::Vector2d place = track_->place(spec.from, spec.d);
    for (const Part& part : partsOf(spec)) {
        const Eigen::AlignedBox3d bounds = boundsOf(part.mesh);
        const Eigen::Vector2d middle = bounds.center().head<2>(), half = 0.5 * bounds.sizes().head<2>();
        parts.push_back(
            {{place + Eigen::Rotation2Dd(heading) * middle, half, heading, bounds.min().z(), bounds.max().z()}});
    }
    return parts;
}

bool SceneDraft::put(ClutterSpec spec) {
    spec.variant = newVariant();
    if (isDrivable(spec.kind)) {
        scenario_.clutter.push_back(spec);
        return true;
    }
    if (!claim(roomOf(spec), kMargin)) return false;
    scenario_.clutter.push_back(spec);
    if (spec.kind == ClutterKind::Tree) return true;
    Edge edge{{spec.from, spec.d, spec.yaw}, {0.5 * std::max(spec.length, spec.width), 0.5 * spec.width}};
    if (isLine(spec.kind)) {
        edge.spot.s = 0.5 * (spec.from + spec.to);
        edge.half.x() = 0.5 * (spec.to - spec.from);
    }
    edges_.push_back(edge);
    return true;
}

}  // namespace lidar_obstacles::simulation
