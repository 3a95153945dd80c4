// SPDX-License-Identifier: BSD-3-Clause
#include "exports/foxglove.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/number_text.h"
#include "exports/bytes.h"
#include "exports/foxglove_schemas.h"
#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles::apps {
namespace {

using Json = nlohmann::ordered_json;

enum Topic : std::uint16_t { kTf, kPoints, kGrid, kObstacles, kLog };

/// Types of packed fields, and levels of the log, as Foxglove numbers them.
enum Packed : std::uint8_t { kUint8 = 1, kInt32 = 6, kFloat32 = 7 };
enum Level : std::uint8_t { kInfo = 2, kWarning = 3 };

std::uint64_t nanoseconds(double seconds) {
    // A double holds times of this century to a quarter of a microsecond.
    return static_cast<std::uint64_t>(std::llround(std::max(0.0, seconds) * 1e6)) * 1000;
}

Json timeJson(std::uint64_t ns) { return {{"sec", ns / 1000000000}, {"nsec", ns % 1000000000}}; }

Json vectorJson(const Eigen::Vector3d& v) { return {{"x", v.x()}, {"y", v.y()}, {"z", v.z()}}; }

Json poseJson(const Eigen::Vector3d& position, const Eigen::Quaterniond& q = Eigen::Quaterniond::Identity()) {
    return {{"position", vectorJson(position)},
            {"orientation", {{"x", q.x()}, {"y", q.y()}, {"z", q.z()}, {"w", q.w()}}}};
}

Eigen::Quaterniond turned(double yaw) { return Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ())); }

Json colorJson(ReturnKind kind, double alpha) {
    const auto rgb = colorOf(kind);
    return {{"r", rgb[0] / 255.0}, {"g", rgb[1] / 255.0}, {"b", rgb[2] / 255.0}, {"a", alpha}};
}

Json field(const char* name, int offset, Packed type) { return {{"name", name}, {"offset", offset}, {"type", type}}; }

Json transform(const Eigen::Isometry3d& T_world_vehicle, std::uint64_t ns) {
    const Json pose = poseJson(T_world_vehicle.translation(), Eigen::Quaterniond(T_world_vehicle.linear()));
    return {{"timestamp", timeJson(ns)},
            {"parent_frame_id", "world"},
            {"child_frame_id", "vehicle"},
            {"translation", pose["position"]},
            {"rotation", pose["orientation"]}};
}

Json points(const ScanOutput& scan, std::uint64_t ns) {
    const PointCloud& cloud = scan.found.cloud;
    const ReturnLabels labels = labelReturns(scan.found);
    constexpr int kStride = 21;
    std::string bytes;
    bytes.reserve(cloud.size() * kStride);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis) putFloat(bytes, cloud.xyz[i][axis]);
        putFloat(bytes, cloud.intensity.empty() ? 0.0F : cloud.intensity[i]);
        const std::int32_t place = labels.obstacle[i];
        putInteger<std::int32_t>(bytes,
                                 place < 0 ? -1 : scan.found.detection.obstacles[static_cast<std::size_t>(place)].id);
        putInteger(bytes, static_cast<std::uint8_t>(labels.kind[i]));
    }
    return {{"timestamp", timeJson(ns)},
            {"frame_id", "vehicle"},
            {"pose", poseJson(Eigen::Vector3d::Zero())},
            {"point_stride", kStride},
            {"fields",
             {field("x", 0, kFloat32), field("y", 4, kFloat32), field("z", 8, kFloat32),
              field("intensity", 12, kFloat32), field("track", 16, kInt32), field("class", 20, kUint8)}},
            {"data", base64(bytes)}};
}

Json grid(const KnownCells& known, const ScanOutput& scan, std::uint64_t ns) {
    const double z = scan.found.detection.ground.heightAt(0.0, 0.0);
    return {{"timestamp", timeJson(ns)},
            {"frame_id", "vehicle"},
            {"pose", poseJson({known.origin.x(), known.origin.y(), z})},
            {"column_count", known.columns},
            {"cell_size", {{"x", known.resolution}, {"y", known.resolution}}},
            {"row_stride", known.columns},
            {"cell_stride", 1},
            {"fields", Json::array({field("state", 0, kUint8)})},
            {"data", base64(known.states)}};
}

Json arrow(const Eigen::Vector3d& from, double yaw, double length, const Json& color) {
    return {{"pose", poseJson(from, turned(yaw))}, {"shaft_length", 0.8 * length}, {"shaft_diameter", 0.12},
            {"head_length", 0.2 * length},         {"head_diameter", 0.3},         {"color", color}};
}

Json arrows(const Obstacle& o) {
    Json list = Json::array();
    const Eigen::Vector3d top = o.box.center + Eigen::Vector3d(0.0, 0.0, o.box.size.z() / 2);
    if (o.heading_valid && o.cls != ObstacleClass::Structure)
        list.push_back(arrow(o.box.center, o.box.yaw, o.box.size.x() / 2 + 1.0, colorJson(kindOf(o.cls), 1.0)));
    if (o.track && o.track->moving && o.track->velocity) {
        const Eigen::Vector2d& v = *o.track->velocity;
        list.push_back(arrow(top, std::atan2(v.y(), v.x()), v.norm(), {{"r", .75}, {"g", 1.}, {"b", .24}, {"a", 1.}}));
    }
    return list;
}

std::string labelOf(const Obstacle& o) {
    std::string words = std::string(toString(o.cls)) + ' ' + std::to_string(o.id);
    if (o.track && o.track->moving && o.track->velocity)
        words += ", " + fixedText(o.track->velocity->norm(), 1) + " m/s";
    return words;
}

Json label(const Obstacle& o) {
    return {{"pose", poseJson(o.box.center + Eigen::Vector3d(0.0, 0.0, o.box.size.z() / 2 + 0.4))},
            {"billboard", true},
            {"font_size", 12},
            {"scale_invariant", true},
            {"color", colorJson(kindOf(o.cls), 1.0)},
            {"text", labelOf(o)}};
}

/// What Foxglove shows of a box that is clicked.
Json numbersOf(const Obstacle& o) {
    Json list = Json::array();
    const auto add = [&list](const char* key, const std::string& value) {
        list.push_back({{"key", key}, {"value", value}});
    };
    add("class", toString(o.cls));
    add("probability", fixedText(probabilityOf(o), 4));
    add("distance", fixedText(distanceTo(o.box), 2));
    add("num_points", std::to_string(o.num_points));
    add("heading_valid", o.heading_valid ? "1" : "0");
    if (!o.track) return list;
    add("age", fixedText(o.track->age, 2));
    add("seen", o.track->seen ? "1" : "0");
    if (!o.track->velocity) return list;
    add("vx", fixedText(o.track->velocity->x(), 2));
    add("vy", fixedText(o.track->velocity->y(), 2));
    add("moving", o.track->moving ? "1" : "0");
    return list;
}

Json entity(const Obstacle& o, std::uint64_t ns) {
    const bool is_structure = o.cls == ObstacleClass::Structure;
    const Json none = Json::array();
    const Json cube = {{"pose", poseJson(o.box.center, turned(o.box.yaw))},
                       {"size", vectorJson(o.box.size)},
                       {"color", colorJson(kindOf(o.cls), is_structure ? 0.2 : 0.45)}};
    return {{"timestamp", timeJson(ns)},
            {"frame_id", "vehicle"},
            {"id", std::to_string(o.id)},
            {"lifetime", {{"sec", 0}, {"nsec", 0}}},
            {"frame_locked", true},
            {"metadata", numbersOf(o)},
            {"arrows", arrows(o)},
            {"cubes", Json::array({cube})},
            {"spheres", none},
            {"cylinders", none},
            {"lines", none},
            {"triangles", none},
            {"texts", is_structure ? none : Json::array({label(o)})},
            {"models", none}};
}

/// Takes away what the scan before showed.
Json scene(const std::vector<Obstacle>& obstacles, std::uint64_t ns) {
    Json entities = Json::array();
    for (const Obstacle& o : obstacles) entities.push_back(entity(o, ns));
    constexpr int kAll = 1;
    return {{"deletions", Json::array({{{"timestamp", timeJson(ns)}, {"type", kAll}, {"id", ""}}})},
            {"entities", entities}};
}

Json logLine(const ScanOutput& scan, std::uint64_t ns) {
    const SequenceResult& found = scan.found;
    std::string words = "scan " + std::to_string(scan.scan_index) + ": " + std::to_string(found.cloud.size()) +
                        " returns, " + std::to_string(found.detection.obstacles.size()) + " obstacles";
    const bool has_ground = found.detection.ground.evidence != GroundEvidence::None;
    if (!has_ground) words += "; no ground";
    if (found.restarted) words += "; the vehicle's poses broke off: all is forgotten";
    return {{"timestamp", timeJson(ns)},
            {"level", has_ground && !found.restarted ? kInfo : kWarning},
            {"message", words},
            {"name", "obstacle-replay"},
            {"file", ""},
            {"line", 0}};
}

}  // namespace

const std::vector<McapChannel>& foxgloveChannels() {
    static const std::vector<McapChannel> channels = [] {
        std::vector<McapChannel> list;
        list.reserve(5);
        for (const auto& [topic, name] : {std::pair("/tf", "FrameTransform"),
                                          {"/points", "PointCloud"},
                                          {"/grid", "Grid"},
                                          {"/obstacles", "SceneUpdate"},
                                          {"/log", "Log"}})
            list.push_back({topic, std::string("foxglove.") + name, foxgloveSchema(name)});
        return list;
    }();
    return channels;
}

std::vector<McapMessage> foxgloveMessages(const ScanOutput& scan) {
    const std::uint64_t ns = nanoseconds(scan.found.cloud.timestamp);
    std::vector<McapMessage> messages;
    if (scan.T_world_vehicle) messages.push_back({kTf, ns, transform(*scan.T_world_vehicle, ns).dump()});
    messages.push_back({kPoints, ns, points(scan, ns).dump()});
    const KnownCells known = knownCells(scan.found.detection.grid);
    if (known.columns > 0) messages.push_back({kGrid, ns, grid(known, scan, ns).dump()});
    messages.push_back({kObstacles, ns, scene(scan.found.detection.obstacles, ns).dump()});
    messages.push_back({kLog, ns, logLine(scan, ns).dump()});
    return messages;
}

std::string base64(const std::string& bytes) {
    static constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t at = 0; at < bytes.size(); at += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three = three << 8U | (at + k < bytes.size() ? static_cast<std::uint8_t>(bytes[at + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += at + k > bytes.size() ? '=' : kLetters[three >> (18U - 6U * k) & 63U];
    }
    return text;
}

}  // namespace lidar_obstacles::apps
