// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/evaluation/truth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "lidar_obstacles/evaluation/box_overlap.h"
#include "lidar_obstacles/evaluation/csv_table.h"

namespace lidar_obstacles::evaluation {
namespace {

const std::set<std::string>& typesOf(Group group) {
    static const std::set<std::string> vehicles = {"van", "car",   "truck", "bus",     "vehicle",    "sedan",
                                                   "suv", "hatch", "tram",  "trailer", "motorcycle", "misc_vehicle"};
    static const std::set<std::string> pedestrians = {"pedestrian", "person", "person_sitting"};
    static const std::set<std::string> cyclists = {"cyclist", "bicycle", "bicyclist", "rider", "motorcyclist"};
    return group == Group::Vehicle ? vehicles : group == Group::Pedestrian ? pedestrians : cyclists;
}

/// Where a pose stands in the file.
struct PoseColumns {
    std::string suffix;            ///< of x, y, z and yaw
    bool undo_own_motion = false;  ///< ... which are moved by the object's velocity to t_obs
};

PoseColumns poseColumns(const CsvReader& csv, TruthPose pose) {
    if (pose == TruthPose::EgoCorrected) return {"", csv.has("t_obs")};
    const std::string suffix = pose == TruthPose::MidScan ? "_mid" : pose == TruthPose::Observed ? "_obs" : "";
    return {csv.has("x" + suffix) ? suffix : "", false};
}

/// A coordinate of the pose; where the object has no return the file need not tell when it was seen.
double poseCell(const CsvReader& csv, const std::string& column, int num_points) {
    return num_points > 0 ? csv.number(column) : csv.numberOrNan(column);
}

/// The time from the scan's timestamp to the instant when the object was seen; 0 where that is not known.
double delayOf(const CsvReader& csv, double timestamp) {
    const double delay = csv.numberOrNan("t_obs") - timestamp;
    return std::isfinite(delay) && std::abs(delay) < 1.0 ? delay : 0.0;
}

OrientedBox boxOf(const CsvReader& csv, const PoseColumns& from, double timestamp, int num_points) {
    OrientedBox box;
    for (int k = 0; k < 3; ++k) box.center[k] = poseCell(csv, std::string(1, "xyz"[k]) + from.suffix, num_points);
    box.yaw = poseCell(csv, "yaw" + from.suffix, num_points);
    box.size = {csv.nonNegative("length"), csv.nonNegative("width"), csv.nonNegative("height")};
    if (from.undo_own_motion) {
        const double delay = delayOf(csv, timestamp);
        box.center.x() += csv.number("vx") * delay;
        box.center.y() += csv.number("vy") * delay;
        if (csv.has("yaw_rate")) box.yaw += csv.number("yaw_rate") * delay;
    }
    return box;
}

/// R_world_vehicle.
Eigen::Matrix3d rotationOf(const EgoPose& ego) {
    return (Eigen::AngleAxisd(ego.rpy.z(), Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(ego.rpy.y(), Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(ego.rpy.x(), Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
}

}  // namespace

const char* toString(Group group) {
    switch (group) {
        case Group::Vehicle:
            return "vehicle";
        case Group::Pedestrian:
            return "pedestrian";
        case Group::Cyclist:
            return "cyclist";
        case Group::Other:
            break;
    }
    return "other";
}

Group groupOf(const std::string& type) {
    const auto it =
        std::find_if(kGroups.begin(), kGroups.end(), [&](Group group) { return typesOf(group).count(type) != 0; });
    return it == kGroups.end() ? Group::Other : *it;
}

ObstacleClass classOf(Group group) {
    switch (group) {
        case Group::Vehicle:
            return ObstacleClass::Vehicle;
        case Group::Pedestrian:
            return ObstacleClass::Pedestrian;
        case Group::Cyclist:
            return ObstacleClass::Cyclist;
        case Group::Other:
            break;
    }
    return ObstacleClass::Unknown;
}

std::vector<TruthObject> readTruth(const std::string& file, TruthPose pose, const std::string& points_column) {
    CsvReader csv(file, {"timestamp", "scan_index", "object_id", "type", "x", "y", "z", "length", "width", "height",
                         "yaw", "vx", "vy", "num_points"});
    const PoseColumns from = poseColumns(csv, pose);
    for (const char* name : {"y", "z", "yaw"}) {
        if (!csv.has(name + from.suffix))
            csv.fail("no column '" + (name + from.suffix) + "' beside 'x" + from.suffix + "'");
    }
    const std::string points = csv.has(points_column) ? points_column : "num_points";
    std::vector<TruthObject> objects;
    while (csv.next()) {
        TruthObject o;
        o.timestamp = csv.number("timestamp");
        o.scan_index = csv.integer("scan_index");
        o.object_id = csv.text("object_id");
        o.type = csv.lowerText("type");
        o.group = groupOf(o.type);
        o.num_points = csv.integer(points);
        o.box = boxOf(csv, from, o.timestamp, o.num_points);
        o.velocity = {csv.numberOrNan("vx"), csv.numberOrNan("vy")};
        o.range = nearestFaceDistance(o.box);
        if (csv.has("occluded")) o.occluded = csv.number("occluded");
        objects.push_back(std::move(o));
    }
    return objects;
}

std::vector<StaticBox> readStaticBoxes(const std::string& file) {
    CsvReader csv(file, {"type", "x", "y", "z", "length", "width", "height", "yaw"});
    std::vector<StaticBox> boxes;
    while (csv.next()) {
        StaticBox b;
        b.type = csv.text("type");
        b.box.center = {csv.number("x"), csv.number("y"), csv.number("z")};
        b.box.size = {csv.nonNegative("length"), csv.nonNegative("width"), csv.nonNegative("height")};
        b.box.yaw = csv.number("yaw");
        boxes.push_back(std::move(b));
    }
    return boxes;
}

std::vector<EgoPose> readEgoPoses(const std::string& file) {
    CsvReader csv(file, {"scan_index", "timestamp", "x", "y", "z", "roll", "pitch", "yaw"});
    std::vector<EgoPose> poses;
    while (csv.next()) {
        EgoPose p;
        p.timestamp = csv.number("timestamp");
        p.scan_index = csv.integer("scan_index");
        p.position = {csv.number("x"), csv.number("y"), csv.number("z")};
        p.rpy = {csv.number("roll"), csv.number("pitch"), csv.number("yaw")};
        poses.push_back(p);
    }
    return poses;
}

std::vector<Eigen::Vector2d> egoVelocities(const std::vector<EgoPose>& poses) {
    constexpr double kNeighbour = 1.0;  // [s]
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    std::vector<Eigen::Vector2d> velocities;
    for (std::size_t k = 0; k < poses.size(); ++k) {
        const EgoPose& now = poses[k];
        const EgoPose& before = poses[k > 0 ? k - 1 : 0];
        const EgoPose& after = poses[std::min(k + 1, poses.size() - 1)];
        const double passed = after.timestamp - before.timestamp;
        const bool known = passed > 0.0 && now.timestamp - before.timestamp <= kNeighbour &&
                           after.timestamp - now.timestamp <= kNeighbour;
        const Eigen::Vector3d in_world = (after.position - before.position) / (known ? passed : kUnknown);
        velocities.emplace_back((rotationOf(now).transpose() * in_world).head<2>());
    }
    return velocities;
}

std::vector<StaticBox> staticBoxesNear(const std::vector<StaticBox>& boxes, const EgoPose& ego, double reach) {
    const Eigen::Matrix3d R_world_vehicle = rotationOf(ego);
    std::vector<StaticBox> near;
    for (const StaticBox& b : boxes) {
        if ((b.box.center - ego.position).head<2>().norm() >= reach) continue;
        StaticBox seen = b;
        seen.box.center = R_world_vehicle.transpose() * (b.box.center - ego.position);
        seen.box.yaw = b.box.yaw - ego.rpy.z();
        near.push_back(std::move(seen));
    }
    return near;
}

}  // namespace lidar_obstacles::evaluation
