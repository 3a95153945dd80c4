// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/ring_view.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

/// Azimuth of each return in the sensor's sense of rotation (clockwise from above), in turns: [0, 1).
std::vector<float> azimuthInTurns(const SensorFrame& frame, const PointCloud& cloud) {
    std::vector<float> turns(cloud.size());
    const Eigen::Vector3f X = frame.rotation.col(0), Y = frame.rotation.col(1);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f d = cloud.xyz[i] - frame.translation;
        // In double, whose last bit is the same everywhere: the C library's atan2 of floats differs between releases.
        const double angle = std::atan2(static_cast<double>(-Y.dot(d)), static_cast<double>(X.dot(d)));
        const auto turn = static_cast<float>(angle * (0.5 / M_PI));
        turns[i] = turn < 0.0f ? std::min(turn + 1.0f, std::nextafter(1.0f, 0.0f)) : turn;
    }
    return turns;
}

/// Azimuths of the ring with most returns.
std::vector<float> fullestRing(const PointCloud& cloud, const std::vector<float>& turns, int rings) {
    std::vector<int> count(static_cast<std::size_t>(rings), 0);
    for (std::uint16_t ring : cloud.ring) ++count[ring];
    const auto fullest = std::max_element(count.begin(), count.end()) - count.begin();
    std::vector<float> in_ring;
    for (std::size_t i = 0; i < turns.size(); ++i)
        if (cloud.ring[i] == fullest) in_ring.push_back(turns[i]);
    return in_ring;
}

int columnsOf(std::vector<float> turns) {
    constexpr int kMin = 90, kMax = 4500;
    std::sort(turns.begin(), turns.end());
    std::vector<float> step;
    for (std::size_t i = 1; i < turns.size(); ++i) step.push_back(turns[i] - turns[i - 1]);
    if (step.empty()) return kMin;
    const auto median = step.begin() + static_cast<std::ptrdiff_t>(step.size() / 2);
    std::nth_element(step.begin(), median, step.end());
    return static_cast<int>(std::lround(1.0 / std::clamp<double>(*median, 1.0 / kMax, 1.0 / kMin)));
}

}  // namespace

void listInView(PointCloud& cloud, std::size_t i, int column) {
    cloud.view.column_of[i] = column;
    std::int32_t& listed = cloud.view.at(cloud.ring[i], column);
    const auto squared_range = [&](std::size_t j) { return (cloud.xyz[j] - cloud.sensor_origin).squaredNorm(); };
    if (listed < 0 || squared_range(i) < squared_range(static_cast<std::size_t>(listed)))
        listed = static_cast<std::int32_t>(i);
}

void buildRingView(const SensorFrame& frame, int rings, PointCloud& cloud) {
    if (cloud.empty()) return;
    const std::vector<float> turns = azimuthInTurns(frame, cloud);
    OrganizedView& view = cloud.view;
    view.rings = rings;
    view.columns = columnsOf(fullestRing(cloud, turns, rings));
    view.index.assign(static_cast<std::size_t>(rings) * static_cast<std::size_t>(view.columns), -1);
    view.column_of.resize(cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i)
        listInView(cloud, i, std::min(static_cast<int>(turns[i] * static_cast<float>(view.columns)), view.columns - 1));
}

}  // namespace lidar_obstacles
