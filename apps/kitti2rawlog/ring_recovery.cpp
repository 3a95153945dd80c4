// SPDX-License-Identifier: BSD-3-Clause
#include "ring_recovery.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace lidar_obstacles::apps {
namespace {

/// Neighbours in a file may be stored against the sense of rotation by this much: lasers of a head look a little to
/// the left and right of it.
constexpr double kJitter = 5.0 * M_PI / 180.0;

/// The turn from one azimuth to the next, counter-clockwise, but for jitter: -kJitter .. 2 pi - kJitter.
double stepBetween(double from, double to) {
    double step = std::fmod(to - from, 2.0 * M_PI);
    if (step < -kJitter) step += 2.0 * M_PI;
    if (step >= 2.0 * M_PI - kJitter) step -= 2.0 * M_PI;
    return step;
}

}  // namespace

std::vector<std::uint16_t> recoverRings(const std::vector<Eigen::Vector3f>& points, int planes) {
    std::vector<std::uint16_t> ring;
    ring.reserve(points.size());
    int from_top = 0;
    double turned = 0.0;  // since straight ahead of the first plane
    double azimuth = 0.0;
    bool reaches_around = false;
    for (const Eigen::Vector3f& p : points) {
        const double next = std::atan2(p.y(), p.x());
        turned += stepBetween(azimuth, next);
        azimuth = next;
        from_top = std::max(from_top, static_cast<int>(std::floor(turned / (2.0 * M_PI))));
        reaches_around = reaches_around || p.x() < 0.0F;
        ring.push_back(static_cast<std::uint16_t>(from_top));
    }
    if (from_top >= planes) {
        throw std::runtime_error(std::to_string(from_top + 1) + " rings found, the sensor has " +
                                 std::to_string(planes) + ": the points are not stored plane by plane");
    }
    const int uppermost = reaches_around ? from_top : planes - 1;
    for (std::uint16_t& r : ring) r = static_cast<std::uint16_t>(uppermost - r);
    return ring;
}

}  // namespace lidar_obstacles::apps
