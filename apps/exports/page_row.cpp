// SPDX-License-Identifier: BSD-3-Clause
#include "exports/page_row.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles::apps {
namespace {

using Json = nlohmann::json;

/// In hundredths or thousandths, whole.
long long parts(double value, double per_unit) { return std::llround(value * per_unit); }

int flagsOf(const Obstacle& o) {
    const bool seen = !o.track || o.track->seen;
    int flags = (o.heading_valid ? 1 : 0) | (seen ? 2 : 0);
    if (!o.track) return flags;
    flags |= (o.track->moving ? 4 : 0) | (o.track->direction_known ? 8 : 0) | (o.track->velocity ? 16 : 0);
    return flags | 32;
}

/// Up to the distance.
Json boxRow(const Obstacle& o) {
    Json row = {o.id, static_cast<int>(o.cls)};
    for (const Eigen::Vector3d* v : {&o.box.center, &o.box.size})
        for (int axis = 0; axis < 3; ++axis) row.push_back(parts((*v)[axis], 100.0));
    row.push_back(parts(o.box.yaw, 1000.0));
    for (const int number : {flagsOf(o), o.num_points, o.num_rings}) row.push_back(number);
    row.push_back(parts(distanceTo(o.box), 100.0));
    return row;
}

Json fullRow(const Obstacle& o) {
    Json row = boxRow(o);
    const TrackState t = o.track.value_or(TrackState{});
    for (const Eigen::Vector2d& v : {t.velocity.value_or(Eigen::Vector2d::Zero()), t.velocity_std})
        for (int axis = 0; axis < 2; ++axis) row.push_back(parts(v[axis], 100.0));
    row.push_back(parts(t.age, 1000.0));
    for (const float p : o.probability) row.push_back(parts(p, 1000.0));
    return row;
}

Json poseJson(const std::optional<Eigen::Isometry3d>& T_world_vehicle) {
    if (!T_world_vehicle) return 0;
    const auto rounded = [](double value, double per_unit) { return std::round(value * per_unit) / per_unit; };
    const Eigen::Vector3d& p = T_world_vehicle->translation();
    const Eigen::Quaterniond q(T_world_vehicle->linear());
    Json pose = Json::array();
    for (const double number : {p.x(), p.y(), p.z()}) pose.push_back(rounded(number, 1e3));
    for (const double number : {q.x(), q.y(), q.z(), q.w()}) pose.push_back(rounded(number, 1e6));
    return pose;
}

}  // namespace

std::string pageRow(const ScanOutput& scan) {
    const PointCloud& cloud = scan.found.cloud;
    Json rows = Json::array();
    for (const Obstacle& o : scan.found.detection.obstacles)
        if (o.cls != ObstacleClass::Structure) rows.push_back(fullRow(o));
    return Json{scan.scan_index, std::round(cloud.timestamp * 1e6) / 1e6, poseJson(scan.T_world_vehicle), cloud.size(),
                rows}
        .dump();
}

std::string pageStructure(const ScanOutput& scan) {
    Json rows = Json::array();
    for (const Obstacle& o : scan.found.detection.obstacles)
        if (o.cls == ObstacleClass::Structure) rows.push_back(boxRow(o));
    return rows.dump();
}

}  // namespace lidar_obstacles::apps
