// SPDX-License-Identifier: BSD-3-Clause
// The whole detector on any cloud: boxes are finite, in order, and stand in places of their own; what comes out is a
// function of what goes in.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <stdexcept>

#include "lidar_obstacles/pipelines.h"
#include "objects/overlap.h"
#include "scan/organize.h"

namespace {

using namespace lidar_obstacles;

std::uint16_t wordAt(const std::uint8_t* data) { return static_cast<std::uint16_t>(data[0] | data[1] << 8U); }

/// Returns as a turning sensor has them: ring, azimuth and range, 5 bytes each, each place of the view once.
PointCloud turnOf(const std::uint8_t* data, std::size_t size, int rings) {
    PointCloud cloud;
    cloud.sensor_origin = {0.0F, 0.0F, 1.8F};
    cloud.view.rings = rings;
    cloud.view.columns = kUsualColumns;
    cloud.view.index.assign(static_cast<std::size_t>(rings) * kUsualColumns, -1);
    for (std::size_t at = 0; at + 5 <= size; at += 5) {
        const int ring = data[at] % rings, column = wordAt(data + at + 1) % kUsualColumns;
        if (cloud.view.at(ring, column) >= 0) continue;
        const float range = 0.002F * static_cast<float>(wordAt(data + at + 3));
        const float azimuth = 6.2831853F * (static_cast<float>(column) + 0.5F) / kUsualColumns;
        const float elevation = (-15.0F + 30.0F * static_cast<float>(ring) / static_cast<float>(rings)) * 0.01745329F;
        cloud.view.at(ring, column) = static_cast<std::int32_t>(cloud.size());
        cloud.view.column_of.push_back(column);
        cloud.ring.push_back(static_cast<std::uint16_t>(ring));
        const float flat = range * std::cos(elevation);
        cloud.xyz.emplace_back(flat * std::cos(azimuth), flat * std::sin(azimuth), 1.8F + range * std::sin(elevation));
    }
    return cloud;
}

/// Points of three floating-point numbers each, whatever they are.
PointCloud pointsOf(const std::uint8_t* data, std::size_t size) {
    PointCloud cloud;
    for (std::size_t at = 0; at + 12 <= size; at += 12) {
        Eigen::Vector3f p;
        std::memcpy(p.data(), data + at, 12);
        cloud.xyz.push_back(p);
    }
    return cloud;
}

bool isRoadUser(const Obstacle& o) { return o.cls != ObstacleClass::Structure && o.cls != ObstacleClass::Unknown; }

double areaOf(const Obstacle& o) { return o.box.size.x() * o.box.size.y(); }

/// Boxes of road users of one class share no more than a tenth of the smaller one. A person may stand at a car, and
/// what is not known may be boxed in pieces, as walls are.
void checkPair(const Obstacle& a, const Obstacle& b) {
    const Obstacle& smaller = areaOf(a) < areaOf(b) ? a : b;
    if (!isRoadUser(a) || a.cls != b.cls) return;
    if (sharedArea(a.box, b.box) > 0.11 * areaOf(smaller) + 1e-3) std::abort();
}

void check(const Obstacle& o, std::size_t returns) {
    if (!o.box.center.allFinite() || !o.box.size.allFinite() || !std::isfinite(o.box.yaw)) std::abort();
    if (o.box.size.minCoeff() < 0.0 || !std::isfinite(o.heading_std)) std::abort();
    if (o.points.empty() || o.points.size() > returns) std::abort();
    for (const float p : o.probability)
        if (!(p >= 0.0F && p <= 1.0F)) std::abort();
}

std::vector<Obstacle> obstaclesOf(const PointCloud& cloud, const DetectorParams& params) {
    std::vector<Obstacle> obstacles = detect(cloud, params).obstacles;
    double before = 0.0;
    for (std::size_t a = 0; a < obstacles.size(); ++a) {
        check(obstacles[a], cloud.size());
        const double distance = obstacles[a].box.center.head<2>().norm();
        if (obstacles[a].id != static_cast<int>(a) || distance < before - 1e-9) std::abort();
        before = distance;
        for (std::size_t b = a + 1; b < obstacles.size(); ++b) checkPair(obstacles[a], obstacles[b]);
    }
    return obstacles;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2) return 0;
    constexpr Algorithm kAlgorithms[] = {Algorithm::Planes16, Algorithm::Planes8, Algorithm::Auto};
    constexpr int kRings[] = {16, 8, 4, 32};
    const DetectorParams params = withAlgorithm(kAlgorithms[(data[0] >> 2U) % 3]);
    const bool any_points = (data[0] & 0x80U) != 0;
    const PointCloud cloud =
        any_points ? pointsOf(data + 1, size - 1) : turnOf(data + 1, size - 1, kRings[data[0] % 4]);
    try {
        const auto once = obstaclesOf(cloud, params), again = obstaclesOf(cloud, params);
        if (once.size() != again.size()) std::abort();
        for (std::size_t k = 0; k < once.size(); ++k)
            if (once[k].box.center != again[k].box.center || once[k].cls != again[k].cls) std::abort();
    } catch (const std::invalid_argument&) {
        if (!any_points) std::abort();  // all of a turn's returns are good
    }
    return 0;
}
