// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/elevation_rings.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"

namespace lidar_obstacles {
namespace {

constexpr double kBin = 0.05;  // [deg] a sixth of the finest steps of today's sensors
constexpr std::size_t kBins = 3602;
constexpr int kMostSteps = 128;
constexpr int kFewestSteps = 4;

/// Elevations above the sensor's horizon [deg].
std::vector<double> elevationsOf(const std::vector<Eigen::Vector3f>& points) {
    std::vector<double> elevation;
    elevation.reserve(points.size());
    for (const Eigen::Vector3f& p : points) {
        const double horizontal = std::hypot(static_cast<double>(p.x()), static_cast<double>(p.y()));
        elevation.push_back(std::atan2(static_cast<double>(p.z()), horizontal) * 180.0 / M_PI);
    }
    return elevation;
}

std::size_t binOf(double elevation) { return static_cast<std::size_t>(std::floor((elevation + 90.0) / kBin)) + 1; }

/// How many returns there are around each bin: those of its neighbours are counted with it.
std::vector<int> histogramOf(const std::vector<double>& elevation) {
    std::vector<int> count(kBins + 1, 0), smooth(kBins + 1, 0);
    for (const double e : elevation) ++count[std::min(binOf(e), kBins - 1)];
    for (std::size_t k = 1; k < kBins; ++k) smooth[k] = count[k - 1] + count[k] + count[k + 1];
    return smooth;
}

/// Bins at which one step ends and the next begins: the lowest place between two peaks, where it is below a quarter of
/// the lower one. The first entry is 0, the last kBins.
std::vector<std::size_t> bordersOf(const std::vector<int>& histogram) {
    std::vector<std::size_t> borders = {0};
    int peak = 0;    // of the step that is being passed
    int valley = 0;  // after it
    std::size_t valley_at = 0;
    for (std::size_t k = 0; k < kBins; ++k) {
        const int n = histogram[k];
        if (n < valley) valley = n, valley_at = k;
        const bool rises_again = 4 * valley < std::min(peak, n) || (valley == 0 && n > 0 && peak > 0);
        if (rises_again) {
            borders.push_back(valley_at);
            peak = valley = n;
        } else if (n > peak) {
            peak = valley = n;
        }
    }
    borders.push_back(kBins);
    return borders;
}

/// The middle of each step [deg], ascending: the median of its returns.
std::vector<double> stepsOf(std::vector<double> elevation) {
    std::sort(elevation.begin(), elevation.end());
    const std::vector<std::size_t> borders = bordersOf(histogramOf(elevation));
    std::vector<double> steps;
    auto begin = elevation.begin();
    for (std::size_t k = 1; k < borders.size(); ++k) {
        const auto end = std::partition_point(begin, elevation.end(), [&](double e) { return binOf(e) < borders[k]; });
        if (end != begin) steps.push_back(*(begin + (end - begin) / 2));
        begin = end;
    }
    return steps;
}

std::size_t nearest(const std::vector<double>& steps, double elevation) {
    const auto above = std::lower_bound(steps.begin(), steps.end(), elevation);
    if (above == steps.begin()) return 0;
    const auto at = static_cast<std::size_t>(above - steps.begin());
    return at < steps.size() && steps[at] - elevation < elevation - steps[at - 1] ? at : at - 1;
}

/// Distance to the nearer neighbour [deg].
double spacing(const std::vector<double>& steps, std::size_t k) {
    const double below = k > 0 ? steps[k] - steps[k - 1] : 180.0;
    const double above = k + 1 < steps.size() ? steps[k + 1] - steps[k] : 180.0;
    return std::min(below, above);
}

/// True if nearly all returns lie near a step.
bool fallOnSteps(const std::vector<double>& elevation, const std::vector<double>& steps) {
    constexpr double kNear = 0.25;  // of the distance to the next step: half way to where it could be either
    std::size_t between = 0;
    for (const double e : elevation) {
        const std::size_t k = nearest(steps, e);
        between += std::abs(e - steps[k]) > kNear * std::min(spacing(steps, k), 4.0);
    }
    return 20 * between <= elevation.size();
}

/// Number of each step among the rings of a known sensor; empty if it is none.
std::vector<int> asRingsOf(std::uint8_t kind, const std::vector<double>& steps, int& rings) {
    constexpr double kExact = 0.15;  // [deg]
    std::vector<double> known;
    for (const auto& laser : calibrationOf(kind)->laser_corrections)
        known.push_back(std::atan2(laser.sinVertCorrection, laser.cosVertCorrection) * 180.0 / M_PI);
    std::sort(known.begin(), known.end());
    std::vector<int> number;
    for (const double step : steps) {
        const std::size_t k = nearest(known, step);
        if (std::abs(known[k] - step) > kExact || (!number.empty() && number.back() >= static_cast<int>(k))) return {};
        number.push_back(static_cast<int>(k));
    }
    rings = static_cast<int>(known.size());
    return 2 * steps.size() > known.size() ? number : std::vector<int>{};
}

/// Number of each step, counted from the lowest. Where all distances are multiples of the usual one, steps that are
/// missing count, too, unless they are too many: then the sensor is denser in some places than in others.
std::vector<int> countedFromBelow(const std::vector<double>& steps) {
    std::vector<double> distance;
    for (std::size_t k = 1; k < steps.size(); ++k) distance.push_back(steps[k] - steps[k - 1]);
    const auto middle = distance.begin() + static_cast<std::ptrdiff_t>(distance.size() / 2);
    std::nth_element(distance.begin(), middle, distance.end());
    const double usual = *middle;
    bool even = true;
    std::vector<int> number = {0};
    for (std::size_t k = 1; k < steps.size(); ++k) {
        const double times = (steps[k] - steps[k - 1]) / usual;
        even = even && times > 0.5 && std::abs(times - std::round(times)) < 0.2;
        number.push_back(number.back() + static_cast<int>(std::lround(times)));
    }
    const bool few_are_missing = 4 * number.back() <= 5 * static_cast<int>(steps.size());
    if (!even || !few_are_missing || number.back() >= kMostSteps) std::iota(number.begin(), number.end(), 0);
    return number;
}

}  // namespace

std::optional<ElevationRings> ringsFromElevations(const std::vector<Eigen::Vector3f>& points) {
    constexpr std::size_t kFewestReturns = 10;  // of a step, on average
    const std::vector<double> elevation = elevationsOf(points);
    const std::vector<double> steps = stepsOf(elevation);
    const auto count = static_cast<int>(steps.size());
    if (count < kFewestSteps || count > kMostSteps || points.size() < kFewestReturns * steps.size() ||
        !fallOnSteps(elevation, steps))
        return std::nullopt;
    ElevationRings found;
    std::vector<int> number;
    for (const std::uint8_t kind : {0x22, 0x24, 0x21, 0x28})
        if (number.empty()) number = asRingsOf(kind, steps, found.rings);
    if (number.empty()) {
        number = countedFromBelow(steps);
        found.rings = number.back() + 1;
    }
    found.ring.reserve(elevation.size());
    for (const double e : elevation) found.ring.push_back(static_cast<std::uint16_t>(number[nearest(steps, e)]));
    return found;
}

}  // namespace lidar_obstacles
