// SPDX-License-Identifier: BSD-3-Clause
#include "scan/organize.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lidar_obstacles {
namespace {

constexpr auto kPi = static_cast<float>(M_PI);
constexpr float kDegree = kPi / 180.0f;
constexpr int kMostRings = 128;

float elevationOf(const PointCloud& cloud, std::size_t i) {
    const float sine = (cloud.xyz[i] - cloud.sensor_origin).normalized().dot(cloud.sensor_up);
    // In double, here and below: the C library's functions of floats differ between releases.
    return static_cast<float>(std::asin(static_cast<double>(std::clamp(sine, -1.0f, 1.0f))));
}

/// Lower limits of the rings, rising; empty where the elevations do not fall on steps.
std::vector<float> stepsOf(std::vector<float> elevations) {
    constexpr float kApart = 0.1f * kDegree;  // between the returns of neighbouring rings at least
    constexpr float kThin = 0.5f;             // a ring is thinner than this share of the usual step
    std::sort(elevations.begin(), elevations.end());
    std::vector<float> begins{elevations.front()};
    std::vector<float> steps;
    float widest = 0.0f;
    for (std::size_t k = 1; k < elevations.size(); ++k) {
        if (elevations[k] - elevations[k - 1] > kApart) {
            steps.push_back(elevations[k] - begins.back());
            begins.push_back(elevations[k]);
        }
        widest = std::max(widest, elevations[k] - begins.back());
    }
    if (steps.empty() || begins.size() > kMostRings) return {};
    std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
    return widest < kThin * steps[steps.size() / 2] ? begins : std::vector<float>{};
}

std::vector<float> bandsOf(const std::vector<float>& elevations) {
    const auto [lowest, highest] = std::minmax_element(elevations.begin(), elevations.end());
    std::vector<float> begins;
    for (float e = *lowest; e <= *highest && begins.size() < kMostRings; e += 2.0f * kDegree) begins.push_back(e);
    return begins;
}

constexpr float kUpright = 0.94f;  // cosine of 20 deg

void turnRings(PointCloud& cloud) {
    OrganizedView& view = cloud.view;
    for (std::uint16_t& ring : cloud.ring) ring = static_cast<std::uint16_t>(view.rings - 1 - ring);
    for (int ring = 0; 2 * ring < view.rings - 1; ++ring) {
        const auto row = view.index.begin() + static_cast<std::ptrdiff_t>(ring) * view.columns;
        const auto other = view.index.begin() + static_cast<std::ptrdiff_t>(view.rings - 1 - ring) * view.columns;
        std::swap_ranges(row, row + view.columns, other);
    }
}

}  // namespace

int columnOf(const Eigen::Vector3f& way, int columns) {
    // In double: the C library's atan2 of floats differs between releases.
    const auto bearing = static_cast<float>(std::atan2(static_cast<double>(way.y()), static_cast<double>(way.x())));
    const float turn = (bearing + kPi) / (2.0f * kPi);
    return std::min(static_cast<int>(turn * static_cast<float>(columns)), columns - 1);
}

void listNearest(std::int32_t i, const Eigen::Vector3f& origin, PointCloud& cloud) {
    std::int32_t& listed = cloud.view.at(cloud.ring[i], cloud.view.column_of[i]);
    if (listed < 0 || (cloud.xyz[i] - origin).squaredNorm() < (cloud.xyz[listed] - origin).squaredNorm()) listed = i;
}

PointCloud organized(PointCloud cloud, int columns) {
    if (!cloud.view.empty() || cloud.empty()) return cloud;
    std::vector<float> elevations(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) elevations[i] = elevationOf(cloud, i);
    std::vector<float> begins = stepsOf(elevations);
    if (begins.empty()) begins = bandsOf(elevations);
    OrganizedView& view = cloud.view;
    view.rings = static_cast<int>(begins.size());
    view.columns = columns;
    view.index.assign(begins.size() * static_cast<std::size_t>(columns), -1);
    view.column_of.resize(cloud.size());
    cloud.ring.resize(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const auto above = std::upper_bound(begins.begin(), begins.end(), elevations[i]);
        cloud.ring[i] = static_cast<std::uint16_t>(std::max<std::ptrdiff_t>(1, above - begins.begin()) - 1);
        view.column_of[i] = columnOf(cloud.xyz[i] - cloud.sensor_origin, columns);
        listNearest(static_cast<std::int32_t>(i), cloud.sensor_origin, cloud);
    }
    return cloud;
}

bool standsUpright(const PointCloud& cloud) { return cloud.sensor_up.z() >= kUpright; }

bool facesUp(const PointCloud& cloud) { return cloud.empty() || (standsUpright(cloud) && !cloud.view.empty()); }

PointCloud facingUp(PointCloud cloud) {
    const int columns = cloud.view.empty() ? kUsualColumns : cloud.view.columns;
    if (std::abs(cloud.sensor_up.z()) < kUpright) {
        cloud.view = {};
        cloud.ring.clear();
        cloud.sensor_up = Eigen::Vector3f::UnitZ();
    }
    cloud = organized(std::move(cloud), columns);
    if (cloud.sensor_up.z() > 0.0f) return cloud;
    cloud.sensor_up = -cloud.sensor_up;
    turnRings(cloud);
    return cloud;
}

}  // namespace lidar_obstacles
