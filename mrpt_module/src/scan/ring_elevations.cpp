// SPDX-License-Identifier: BSD-3-Clause
#include "scan/ring_elevations.h"
#include "scan/median.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lidar_obstacles {
namespace {

constexpr float kUnknown = -10.0f;  // no elevation [rad]

/// Median elevation of some returns of a ring against its sensor's horizon; kUnknown where it has none.
float medianElevation(const PointCloud& cloud, const SensorRays& sensor, int ring) {
    constexpr int kLooked = 64;  // columns
    const OrganizedView& view = cloud.view;
    std::vector<float> sines;
    sines.reserve(2 * kLooked);
    const int stride = std::max(1, view.columns / kLooked);
    for (int column = ring % stride; column < view.columns; column += stride) {
        const std::int32_t i = view.at(ring, column);
        if (i >= 0) sines.push_back((cloud.xyz[i] - sensor.origin).normalized().dot(sensor.up));
    }
    if (sines.empty()) return kUnknown;
    // In double: the C library's asin of floats differs between releases.
    return static_cast<float>(std::asin(static_cast<double>(std::clamp(medianOf(sines), -1.0f, 1.0f))));
}

/// Fills unknown entries evenly between the known ones, and beyond them with the steps of the nearest two.
void fillUnknown(std::vector<float>& angle) {
    std::vector<int> known;
    for (int ring = 0; ring < static_cast<int>(angle.size()); ++ring)
        if (angle[ring] != kUnknown) known.push_back(ring);
    if (known.size() < 2) {
        angle.clear();
        return;
    }
    for (int ring = 0; ring < static_cast<int>(angle.size()); ++ring) {
        if (angle[ring] != kUnknown) continue;
        const auto next = std::upper_bound(known.begin() + 1, known.end() - 1, ring);
        const int a = *(next - 1);
        const int b = *next;
        angle[ring] = angle[a] + (angle[b] - angle[a]) * static_cast<float>(ring - a) / static_cast<float>(b - a);
    }
}

}  // namespace

RingElevations::RingElevations(const PointCloud& cloud) {
    if (cloud.sensors.empty()) {
        addSensor(cloud, cloud.allSensors().front(), 0);
        return;
    }
    int first = 0;
    for (const SensorRays& sensor : cloud.sensors) {
        addSensor(cloud, sensor, first);
        step_.resize(static_cast<std::size_t>(sensor.end_ring) + 1, std::numeric_limits<float>::infinity());
        first = sensor.end_ring;
    }
}

void RingElevations::addSensor(const PointCloud& cloud, const SensorRays& sensor, int first) {
    std::vector<float> angle;
    angle.reserve(static_cast<std::size_t>(sensor.end_ring - first));
    for (int ring = first; ring < sensor.end_ring; ++ring) angle.push_back(medianElevation(cloud, sensor, ring));
    if (angle.size() > 1) fillUnknown(angle);
    if (angle.empty()) return;
    step_.resize(static_cast<std::size_t>(first) + angle.size() + 1, std::numeric_limits<float>::infinity());
    for (std::size_t ring = 1; ring < angle.size(); ++ring)
        step_[static_cast<std::size_t>(first) + ring] = std::max(0.0f, angle[ring] - angle[ring - 1]);
}

}  // namespace lidar_obstacles
