#include "ring_elevations.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lidar_obstacles {
namespace {

constexpr float kUnknown = -10.0f;  // no elevation [rad]

/// Median elevation of some returns of a ring against the sensor's horizon; kUnknown where it has none.
float medianElevation(const PointCloud& cloud, int ring) {
    constexpr int kLooked = 64;  // columns
    const OrganizedView& view = cloud.view;
    std::vector<float> sines;
    const int stride = std::max(1, view.columns / kLooked);
    for (int column = ring % stride; column < view.columns; column += stride) {
        const std::int32_t i = view.at(ring, column);
        if (i >= 0) sines.push_back((cloud.xyz[i] - cloud.sensor_origin).normalized().dot(cloud.sensor_up));
    }
    if (sines.empty()) return kUnknown;
    const auto middle = sines.begin() + static_cast<std::ptrdiff_t>(sines.size() / 2);
    std::nth_element(sines.begin(), middle, sines.end());
    return std::asin(std::clamp(*middle, -1.0f, 1.0f));
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
    for (int ring = 0; ring < cloud.view.rings; ++ring) angle_.push_back(medianElevation(cloud, ring));
    if (angle_.size() > 1) fillUnknown(angle_);
}

float RingElevations::step(int lower, int upper) const {
    constexpr float kUsual = 0.035f;  // 2 deg
    if (angle_.empty()) return kUsual;
    if (lower < 0 || upper >= static_cast<int>(angle_.size())) return std::numeric_limits<float>::infinity();
    return std::max(0.0f, angle_[upper] - angle_[lower]);
}

}  // namespace lidar_obstacles
