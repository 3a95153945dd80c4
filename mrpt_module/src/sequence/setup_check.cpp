// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/setup_check.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lidar_obstacles/ground.h"
#include "lidar_obstacles/own_body_learner.h"
#include "lidar_obstacles/seam.h"
#include "scan/median.h"

namespace lidar_obstacles {
namespace {

constexpr double kSteepest = 30.0;  // ground.max_slope_deg goes no farther [deg]
constexpr float kNear = 1.0f;       // [m]

/// z of the ground around the sensor [m]: none is seen right below it.
double meanHeightAround(const GroundModel& ground, const Eigen::Vector3d& sensor) {
    constexpr int kDirections = 12;
    constexpr double kRange = 3.0, kStep = 2.0 * M_PI / kDirections;  // [m], [rad]
    double sum = 0.0;
    for (int k = 0; k < kDirections; ++k)
        sum += ground.heightAt(sensor.x() + kRange * std::cos(kStep * k), sensor.y() + kRange * std::sin(kStep * k));
    return sum / kDirections;
}

double median(std::vector<double> values) { return values.empty() ? 0.0 : medianOf(values); }

double azimuthOf(const Eigen::Vector3f& ray) {
    return std::atan2(static_cast<double>(ray.y()), static_cast<double>(ray.x()));
}

double elevationOf(const Eigen::Vector3f& ray) {
    return std::atan2(static_cast<double>(ray.z()), static_cast<double>(ray.head<2>().norm()));
}

}  // namespace

struct SetupCheck::Memory {
    explicit Memory(const DetectorParams& p) : params(p), known(p.region.own_body) {}

    void addGround(const PointCloud& cloud);
    void addBody(const PointCloud& cloud, const GroundModel& ground);
    void addRays(const PointCloud& cloud);
    void addTimes(const PointCloud& cloud);

    DetectorParams params;
    OwnBody known;
    OwnBodyLearner learner;
    std::vector<double> returns, heights, stamps, highest, lowest;
    Eigen::Vector3d up = Eigen::Vector3d::Zero();
    Eigen::Vector2d turn_begins = Eigen::Vector2d::Zero();  ///< sum of directions
    std::array<int, kSeedBins> bins{};                      ///< scans with a return in each azimuth bin
    std::vector<std::size_t> of_ring;                       ///< returns of each ring
    std::size_t on_ground = 0, in_ground_scans = 0, all = 0, own = 0, near = 0, torn = 0, with_times = 0;
};

void SetupCheck::Memory::addGround(const PointCloud& cloud) {
    GroundParams steep = params.ground;
    steep.max_slope_deg = kSteepest;
    GroundModel ground = segmentGround(cloud, params.ground);
    if (ground.evidence == GroundEvidence::None) ground = segmentGround(cloud, steep);
    addBody(cloud, ground);
    if (ground.evidence == GroundEvidence::None) return;
    const auto labels = std::count(ground.is_ground.begin(), ground.is_ground.end(), std::uint8_t{1});
    on_ground += static_cast<std::size_t>(labels);
    in_ground_scans += cloud.size();
    // The tilt is that of one plane through all of it: sectors of their own follow kerbs and the edges of what is
    // tilted.
    const GroundPlane plane = fitScanPlane(groundSeeds(cloud, azimuthBins(cloud)), cloud.sensor_origin, steep);
    const Eigen::Vector3d normal =
        plane.support > 0 ? Eigen::Vector3d(-plane.slope.x(), -plane.slope.y(), 1.0).normalized() : ground.normal;
    const Eigen::Vector3d sensor = cloud.sensor_origin.cast<double>();
    heights.push_back((sensor.z() - meanHeightAround(ground, sensor)) * normal.z());
    up += normal;
}

void SetupCheck::Memory::addBody(const PointCloud& cloud, const GroundModel& ground) {
    std::vector<std::int32_t> unknown;
    unknown.reserve(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const bool is_own = known.holds(cloud.xyz[i]);
        own += is_own ? 1 : 0;
        if (is_own || ground.is_ground[i] != 0) continue;
        unknown.push_back(static_cast<std::int32_t>(i));
        const float range = (cloud.xyz[i] - cloud.originOf(static_cast<std::int32_t>(i))).norm();
        near += range < kNear ? 1 : 0;
    }
    learner.add(cloud, unknown);
}

void SetupCheck::Memory::addRays(const PointCloud& cloud) {
    std::array<bool, kSeedBins> seen{};
    double low = M_PI, high = -M_PI;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f ray = cloud.xyz[i] - cloud.originOf(static_cast<std::int32_t>(i));
        const int bin = static_cast<int>(std::floor((azimuthOf(ray) + M_PI) / (2.0 * M_PI) * kSeedBins));
        seen[static_cast<std::size_t>(std::clamp(bin, 0, kSeedBins - 1))] = true;
        low = std::min(low, elevationOf(ray));
        high = std::max(high, elevationOf(ray));
    }
    for (std::size_t k = 0; k < seen.size(); ++k) bins[k] += seen[k] ? 1 : 0;
    if (!cloud.empty()) {
        lowest.push_back(low);
        highest.push_back(high);
    }
    if (cloud.view.empty()) return;
    of_ring.resize(std::max(of_ring.size(), static_cast<std::size_t>(cloud.view.rings)), 0);
    for (const std::uint16_t ring : cloud.ring) ++of_ring[ring];
}

void SetupCheck::Memory::addTimes(const PointCloud& cloud) {
    stamps.push_back(cloud.timestamp);
    if (cloud.time_offset.empty() || cloud.empty()) return;
    ++with_times;
    const auto first = std::min_element(cloud.time_offset.begin(), cloud.time_offset.end());
    const auto i = static_cast<std::int32_t>(first - cloud.time_offset.begin());
    const Eigen::Vector3f ray = cloud.xyz[static_cast<std::size_t>(i)] - cloud.originOf(i);
    turn_begins += ray.head<2>().cast<double>().normalized();
    if (cloud.sensors.empty() && findSeamGap(cloud).rings > 0) ++torn;
}

SetupCheck::SetupCheck(const DetectorParams& params) : memory_(std::make_unique<Memory>(params)) {}
SetupCheck::~SetupCheck() = default;

void SetupCheck::add(const PointCloud& cloud) {
    Memory& m = *memory_;
    m.returns.push_back(static_cast<double>(cloud.size()));
    m.all += cloud.size();
    m.addGround(cloud);
    m.addRays(cloud);
    m.addTimes(cloud);
}

namespace {

double shareOf(std::size_t part, std::size_t all) {
    return all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all);
}

void judgeTimes(const std::vector<double>& stamps, SetupReport& r) {
    std::vector<double> steps;
    steps.reserve(stamps.size());
    for (std::size_t k = 1; k < stamps.size(); ++k) {
        const double step = stamps[k] - stamps[k - 1];
        if (step > 0.0) steps.push_back(step);
        r.steps_back += step > 0.0 ? 0 : 1;
    }
    const double usual = median(steps);
    if (usual <= 0.0) return;
    r.rate = 1.0 / usual;
    r.gaps = static_cast<std::size_t>(
        std::count_if(steps.begin(), steps.end(), [&](double step) { return step > 1.5 * usual; }));
}

/// Rings without returns between rings that have some: the lowest and highest may look at nothing.
std::vector<int> silentRings(const std::vector<std::size_t>& of_ring) {
    std::vector<int> silent, open;
    silent.reserve(of_ring.size());
    open.reserve(of_ring.size());
    bool begun = false;
    for (std::size_t ring = 0; ring < of_ring.size(); ++ring) {
        if (of_ring[ring] == 0) {
            if (begun) open.push_back(static_cast<int>(ring));
            continue;
        }
        begun = true;
        silent.insert(silent.end(), open.begin(), open.end());
        open.clear();
    }
    return silent;
}

}  // namespace

SetupReport SetupCheck::report() const {
    const Memory& m = *memory_;
    SetupReport r;
    r.scans = m.returns.size();
    r.returns = median(m.returns);
    r.with_ground = m.heights.size();
    r.ground_share = shareOf(m.on_ground, m.in_ground_scans);
    if (!m.heights.empty()) {
        r.height = median(m.heights);
        r.up = m.up.normalized();
        r.tilt = std::acos(std::clamp(r.up.z(), -1.0, 1.0));
    }
    r.rings = static_cast<int>(m.of_ring.size());
    r.silent_rings = silentRings(m.of_ring);
    r.lowest = median(m.lowest);
    r.highest = median(m.highest);
    const auto often =
        std::count_if(m.bins.begin(), m.bins.end(), [&](int n) { return 2 * n > static_cast<int>(r.scans); });
    r.view = 2.0 * M_PI * static_cast<double>(often) / kSeedBins;
    judgeTimes(m.stamps, r);
    r.point_times = m.with_times > 0;
    if (m.turn_begins.norm() > 0.5 * static_cast<double>(m.with_times))
        r.turn_begins = std::atan2(m.turn_begins.y(), m.turn_begins.x());
    r.torn = m.torn;
    r.moved = m.learner.moved();
    r.own_body = m.learner.learnt();
    r.own_share = shareOf(m.own, m.all);
    r.near_share = shareOf(m.near, m.all);
    return r;
}

}  // namespace lidar_obstacles
