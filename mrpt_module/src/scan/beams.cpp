// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/beams.h"

#include <algorithm>
#include <cmath>

#include "scan/organize.h"
#include "scan/ring_elevations.h"

namespace lidar_obstacles {
namespace {

constexpr auto kCircle = static_cast<float>(2.0 * M_PI);
constexpr float kLeastNoise = 0.003f;  // half the finest step of ranges that sensors send [m]

}  // namespace

Beams::Beams(const PointCloud& cloud)
    : cloud_(cloud),
      azimuth_step_(kCircle / static_cast<float>(cloud.view.columns > 0 ? cloud.view.columns : kUsualColumns)),
      noise_(kLeastNoise) {
    range_.resize(cloud.size());
    std::int32_t i = 0;
    for (const SensorRays& sensor : cloud.allSensors()) {
        const Eigen::Vector2f origin = sensor.origin.head<2>();
        for (; i < sensor.end; ++i) range_[i] = (cloud.xyz[i].head<2>() - origin).norm();
    }
    const RingElevations elevations(cloud);
    const int rings = std::max(1, cloud.view.rings);
    for (int ring = 0; ring < rings; ++ring) step_.push_back(elevations.stepDown(ring));
    step_.push_back(elevations.stepUp(rings - 1));
    estimateNoise();
}

std::int32_t Beams::beside(std::int32_t i, int step) const {
    constexpr int kFarthest = 3;  // beams
    const OrganizedView& view = cloud_.view;
    if (view.empty()) return -1;
    const std::int32_t* row = &view.index[static_cast<std::size_t>(cloud_.ring[i]) * view.columns];
    int column = view.column_of[i];
    for (int k = 0; k < kFarthest; ++k) {
        column += step;
        if (column < 0) column += view.columns;
        if (column >= view.columns) column -= view.columns;
        if (row[column] >= 0) return row[column];
    }
    return -1;
}

float Beams::roughness(std::int32_t i) const {
    constexpr float kNone = -1.0f;
    constexpr float kSurface = 0.3f;  // [m], and this share of the range more: farther neighbours lie on another one
    constexpr float kPerMetre = 0.02f;
    const std::int32_t a = beside(i, -1);
    const std::int32_t b = beside(i, 1);
    if (a < 0 || b < 0) return kNone;
    const float limit = kSurface + kPerMetre * range_[i];
    if (std::abs(range_[a] - range_[i]) > limit || std::abs(range_[b] - range_[i]) > limit) return kNone;
    const Eigen::Vector2f line = (cloud_.xyz[b] - cloud_.xyz[a]).head<2>();
    const Eigen::Vector2f to = (cloud_.xyz[i] - cloud_.xyz[a]).head<2>();
    const float length = line.norm();
    if (length < 1e-3f) return kNone;
    return std::abs(line.x() * to.y() - line.y() * to.x()) / length;
}

/// A quarter of normal errors is smaller than .319 standard deviations; the middle of three returns is off the line
/// between the others by sqrt(1.5) times the noise of one.
void Beams::estimateNoise() {
    constexpr float kQuarter = 0.319f * 1.2247f;
    constexpr std::size_t kLooked = 2000;
    std::vector<float> residuals;
    residuals.reserve(kLooked + 1);
    const std::size_t stride = 1 + cloud_.size() / kLooked;
    for (std::size_t i = 0; i < cloud_.size(); i += stride) {
        const float r = roughness(static_cast<std::int32_t>(i));
        if (r >= 0.0f) residuals.push_back(r);
    }
    if (residuals.size() < 20) return;
    const auto quarter = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 4);
    std::nth_element(residuals.begin(), quarter, residuals.end());
    noise_ = std::max(kLeastNoise, *quarter / kQuarter);
}

}  // namespace lidar_obstacles
