// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/lasers.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "lidar_obstacles/simulation/lidar.h"

namespace lidar_obstacles::simulation {
namespace {

constexpr double kDegree = M_PI / 180.0;

/// From `first` on [deg].
void addEvenly(std::vector<double>& elevations, int count, double first, double step) {
    for (int k = 0; k < count; ++k) elevations.push_back((first + k * step) * kDegree);
}

/// A VLP-16 fires from the lower and the upper half in turn.
std::vector<double> interleaved(double step) {
    std::vector<double> elevations;
    for (int laser = 0; laser < kLasers; ++laser) {
        const int ring = laser % 2 == 0 ? laser / 2 : kLasers / 2 + laser / 2;
        elevations.push_back((ring - 0.5 * (kLasers - 1)) * step * kDegree);
    }
    return elevations;
}

/// Places of the elevations in rising order; the ring of laser i is the i-th of them.
std::vector<int> ringsOf(const std::vector<double>& elevations) {
    std::vector<double> sorted = elevations;
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
        throw std::invalid_argument("sensor: two lasers point into the same elevation");
    std::vector<int> rings;
    for (double e : elevations)
        rings.push_back(static_cast<int>(std::lower_bound(sorted.begin(), sorted.end(), e) - sorted.begin()));
    return rings;
}

/// True for the rings that stay when every k-th of `lasers` does.
bool stays(int ring, int lasers, int rings) {
    const int k = lasers / rings;
    return ring % k == (k - 1) / 2;
}

void requireDivisor(int rings, std::size_t lasers) {
    if (rings < 1 || lasers % static_cast<std::size_t>(rings) != 0)
        throw std::invalid_argument("sensor: " + std::to_string(rings) + " planes do not divide " +
                                    std::to_string(lasers) + " lasers");
}

}  // namespace

std::vector<double> elevationsOf(LaserLayout layout) {
    std::vector<double> elevations;
    switch (layout) {
        case LaserLayout::Vlp16:
            return interleaved(2.0);
        case LaserLayout::Vlp16HiRes:
            return interleaved(4.0 / 3.0);
        case LaserLayout::Hdl32:
            addEvenly(elevations, 32, -92.0 / 3.0, 4.0 / 3.0);
            break;
        case LaserLayout::Hdl64:
            addEvenly(elevations, 32, 2.0, -1.0 / 3.0);
            addEvenly(elevations, 32, -53.0 / 6.0, -0.5);
            break;
    }
    return elevations;
}

std::vector<double> decimated(const std::vector<double>& elevations, int rings) {
    requireDivisor(rings, elevations.size());
    const std::vector<int> ring_of = ringsOf(elevations);
    std::vector<double> left;
    for (std::size_t i = 0; i < elevations.size(); ++i)
        if (stays(ring_of[i], static_cast<int>(elevations.size()), rings)) left.push_back(elevations[i]);
    return left;
}

std::vector<Laser> lasersOf(const SensorSpec& sensor) {
    const std::vector<double> elevations =
        sensor.elevations.empty() ? elevationsOf(LaserLayout::Vlp16) : sensor.elevations;
    const auto count = static_cast<int>(elevations.size());
    // Fewer planes are asked of the sensor than it has lasers: 0 leaves them all.
    const int planes = sensor.planes == 0 ? count : sensor.planes;
    requireDivisor(planes, elevations.size());
    const std::vector<int> ring_of = ringsOf(elevations);
    std::vector<Laser> lasers;
    for (int i = 0; i < count; ++i) {
        const int ring = ring_of[static_cast<std::size_t>(i)];
        const double delay = i * (kLaserPeriod * kLasers / count);
        lasers.push_back({elevations[static_cast<std::size_t>(i)], delay, ring, stays(ring, count, planes)});
    }
    return lasers;
}

}  // namespace lidar_obstacles::simulation
