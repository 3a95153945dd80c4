// SPDX-License-Identifier: BSD-3-Clause
#include "support/low_scenes.h"

#include <cmath>
#include <cstdio>

#include "lidar_obstacles/pipelines.h"
#include "lidar_obstacles/zones.h"

namespace lidar_obstacles::test {
namespace {

constexpr double kWidth = 0.7;  ///< of the robot [m]

/// Level ground that ends at a distance ahead; beyond it steps down of this height, so deep each, until the bottom.
World edgeAt(double distance, double step, double depth, double bottom) {
    World world;
    world.ground.push_back({{0.0, 0.0}, 0.0, -kInfinity, distance});
    double from = distance, z = -step;
    for (; z > bottom + 1e-9; z -= step, from += depth) world.ground.push_back({{0.0, 0.0}, z, from, from + depth});
    world.ground.push_back({{0.0, 0.0}, bottom, from, kInfinity});
    return world;
}

World boxAhead(const OrientedBox& box) {
    World world = flatWorld();
    world.boxes.push_back(box);
    return world;
}

/// A scooter that lies: a board, a bar along it, wheels.
World lyingScooter(double distance) {
    World world = flatWorld();
    world.boxes = {boxAt(distance + 0.1, 0.0, 70.0, {0.9, 0.12, 0.1}),
                   boxAt(distance + 0.1, 0.55, 70.0, {0.3, 0.05, 0.18}),
                   boxAt(distance + 0.15, -0.5, 70.0, {0.2, 0.06, 0.2})};
    return world;
}

World dog(double distance) {
    World world = flatWorld();
    OrientedBox body = boxAt(distance + 0.1, 0.0, 80.0, {0.45, 0.16, 0.16});
    body.center.z() = 0.2;
    world.boxes = {body};
    for (const double along : {-0.17, 0.17})
        for (const double across : {-0.05, 0.05})
            world.boxes.push_back(boxAt(distance + 0.1 + across, along, 0.0, {0.035, 0.035, 0.14}));
    return world;
}

/// A chain between two posts of 0.45 m, its middle as high as this; small boxes of 2 cm.
World chain(double distance, double low) {
    World world = flatWorld();
    for (const double y : {-0.9, 0.9}) world.boxes.push_back(boxAt(distance, y, 0.0, {0.06, 0.06, 0.45}));
    for (double y = -0.9; y < 0.9; y += 0.02) {
        OrientedBox link = boxAt(distance, y + 0.01, 0.0, {0.02, 0.022, 0.02});
        link.center.z() = low + (0.4 - low) * y * y / 0.81;
        world.boxes.push_back(link);
    }
    return world;
}

World bar(double distance, double height) {
    World world = flatWorld();
    OrientedBox beam = boxAt(distance, 0.0, 0.0, {0.1, 3.0, 0.15});
    beam.center.z() = height + 0.075;
    world.boxes = {beam};
    return world;
}

bool isFound(const LowScene& scene, double distance, const Sensor& sensor) {
    PointCloud cloud = castRays(scene.at(distance), sensor).cloud;
    cloud.timestamp = 1.0;
    ObstacleDetector detector(lookingLow());
    ZoneRule rule;
    rule.margin = 0.0;
    rule.min_height = 0.08;
    rule.max_height = scene.robot_height;
    ZoneSet set;
    const double half = 0.5 * kWidth;
    set.zones.push_back({"ahead",
                         ZoneFrame::Vehicle,
                         {{0.7, -half}, {distance + 0.6, -half}, {distance + 0.6, half}, {0.7, half}},
                         rule});
    ZoneMonitor zones(set, RegionParams{});
    const SequenceResult found = detector.process(std::move(cloud));
    return zones.update({found, detector.trajectory(), nullptr, std::nullopt}).front().state == ZoneState::Occupied;
}

}  // namespace

const std::vector<LowScene>& lowScenes() {
    static const std::vector<LowScene> scenes{
        {"kerb of 0.10 m across the way",
         [](double d) { return boxAhead(boxAt(d + 5.0, 0.0, 0.0, {10.0, 30.0, 0.1})); }},
        {"kerb of 0.15 m across the way",
         [](double d) { return boxAhead(boxAt(d + 5.0, 0.0, 0.0, {10.0, 30.0, 0.15})); }},
        {"kerb of 0.12 m at 30 degrees",
         [](double d) {
             return boxAhead(
                 boxAt(d + 20.0 * std::cos(M_PI / 6.0), 20.0 * std::sin(M_PI / 6.0), 30.0, {40.0, 40.0, 0.12}));
         }},
        {"brick of 0.20 x 0.20 x 0.12 m",
         [](double d) { return boxAhead(boxAt(d + 0.1, 0.0, 20.0, {0.2, 0.2, 0.12})); }},
        {"scooter that lies", lyingScooter},
        {"dog, 0.28 m high", dog},
        {"chain, 0.15 m high in the middle", [](double d) { return chain(d, 0.15); }},
        {"person who lies, 0.25 m high",
         [](double d) { return boxAhead(boxAt(d + 0.2, 0.0, 90.0, {1.7, 0.4, 0.25})); }},
        {"stairs down (0.17 / 0.29 m)", [](double d) { return edgeAt(d, 0.17, 0.29, -1.7); }},
        {"edge of a platform, 0.55 m deep", [](double d) { return edgeAt(d, 0.55, 1.0, -0.55); }},
        {"edge of a platform, 1.2 m deep", [](double d) { return edgeAt(d, 1.2, 1.0, -1.2); }},
        {"kerb down, 0.12 m", [](double d) { return edgeAt(d, 0.12, 1.0, -0.12); }},
        {"bar at 0.9 m, robot of 1.2 m", [](double d) { return bar(d, 0.9); }, 1.2, true},
    };
    return scenes;
}

FoundAt foundFrom(const LowScene& scene, double sensor_height, double step) {
    constexpr int kScans = 3;
    FoundAt result;
    Sensor sensor;
    sensor.position.z() = sensor_height;
    sensor.noise = 0.02;
    for (double d = 0.8; d < 8.05; d += step) {
        int found = 0;
        for (int k = 0; k < kScans; ++k) found += static_cast<int>(isFound(scene, d + 0.05 * k, sensor));
        result.distances.push_back(d);
        result.found.push_back(found == kScans);
    }
    return result;
}

std::string toText(const FoundAt& found) {
    std::string text;
    for (std::size_t k = 0; k < found.found.size(); ++k) {
        if (!found.found[k]) continue;
        std::size_t end = k;
        while (end + 1 < found.found.size() && found.found[end + 1]) ++end;
        char stretch[64];
        std::snprintf(stretch, sizeof stretch, "%s%.1f to %.1f m", text.empty() ? "" : ", ", found.distances[k],
                      found.distances[end]);
        text += stretch;
        k = end;
    }
    return text.empty() ? "never" : text;
}

}  // namespace lidar_obstacles::test
