// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/navigation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace lidar_obstacles {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

bool isInside(const OrientedBox& box) {
    const double c = std::cos(box.yaw), s = std::sin(box.yaw);
    return std::abs(c * box.center.x() + s * box.center.y()) < box.size.x() / 2 &&
           std::abs(-s * box.center.x() + c * box.center.y()) < box.size.y() / 2;
}

/// Does a box begin higher than what drives below it? Crowns and facades of which nothing lower is seen.
bool isOverhead(const Obstacle& o, const GroundModel& ground) {
    constexpr double kVehicle = 2.0;  // [m]
    const double bottom = o.box.center.z() - 0.5 * o.box.size.z();
    return o.cls == ObstacleClass::Structure && bottom - ground.heightAt(o.box.center.x(), o.box.center.y()) > kVehicle;
}

/// Numbers of the returns that are in the way.
std::vector<std::int32_t> returnsOf(const PointCloud& cloud, const DetectionResult& result,
                                    const NavigationOptions& options) {
    std::vector<std::int32_t> returns;
    if (options.everything) returns = result.candidates;
    for (const Obstacle& o : result.obstacles)
        if (!isOverhead(o, result.ground)) returns.insert(returns.end(), o.points.begin(), o.points.end());
    std::sort(returns.begin(), returns.end());
    returns.erase(std::unique(returns.begin(), returns.end()), returns.end());
    const auto size = static_cast<std::int64_t>(cloud.size());
    if (!returns.empty() && (returns.front() < 0 || returns.back() >= size))
        throw std::invalid_argument("the result names returns that the cloud does not have");
    return returns;
}

void addOutline(const OrientedBox& box, double step, mrpt::maps::CSimplePointsMap& map) {
    const auto corners = cornersFromAbove(box);
    for (std::size_t k = 0; k < 4; ++k) {
        const Eigen::Vector2d from = corners[k], side = corners[(k + 1) % 4] - from;
        const int n = std::max(1, static_cast<int>(std::ceil(side.norm() / step)));
        for (int i = 0; i < n; ++i) {
            const Eigen::Vector2d p = from + side * (static_cast<double>(i) / n);
            map.insertPointFast(static_cast<float>(p.x()), static_cast<float>(p.y()),
                                static_cast<float>(box.center.z()));
        }
    }
}

/// Ranges of rays over the full circle, ray 0 half a step after straight behind.
class RayRanges {
  public:
    explicit RayRanges(int rays) : step_(2.0 * M_PI / rays), ranges_(static_cast<std::size_t>(rays), kNothing) {}

    void addPoint(double x, double y) {
        const auto ray = static_cast<std::size_t>((std::atan2(y, x) + M_PI) / step_);
        note(std::min(ray, ranges_.size() - 1), std::hypot(x, y));
    }

    /// Where the rays meet a straight side.
    void addSide(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
        const double from = std::atan2(a.y(), a.x()), turn = normalizeAngle(std::atan2(b.y(), b.x()) - from);
        const double low = turn >= 0.0 ? from : from + turn;
        const auto n = static_cast<long>(ranges_.size());
        const auto first = static_cast<long>(std::ceil((low + M_PI) / step_ - 0.5));
        const auto last = static_cast<long>(std::floor((low + std::abs(turn) + M_PI) / step_ - 0.5));
        const Eigen::Vector2d side = b - a;
        for (long k = first; k <= last; ++k) {
            const double angle = angleOf(k);
            const Eigen::Vector2d ray(std::cos(angle), std::sin(angle));
            const double across = ray.x() * side.y() - ray.y() * side.x();
            if (std::abs(across) < 1e-12) continue;  // along the ray: its ends are points of other sides
            const double range = (a.x() * side.y() - a.y() * side.x()) / across;
            if (range >= 0.0) note(static_cast<std::size_t>((k % n + n) % n), range);
        }
    }

    void blockAll() { std::fill(ranges_.begin(), ranges_.end(), 0.0); }
    const std::vector<double>& ranges() const { return ranges_; }

  private:
    double angleOf(long ray) const { return -M_PI + (static_cast<double>(ray) + 0.5) * step_; }
    void note(std::size_t ray, double range) { ranges_[ray] = std::min(ranges_[ray], range); }

    double step_;
    std::vector<double> ranges_;
};

}  // namespace

mrpt::maps::CSimplePointsMap toPointsMap(const PointCloud& cloud, const DetectionResult& result,
                                         const NavigationOptions& options) {
    if (!(options.outline_step >= 0.0)) throw std::invalid_argument("outline_step must not be negative");
    mrpt::maps::CSimplePointsMap map;
    for (const std::int32_t i : returnsOf(cloud, result, options)) {
        const Eigen::Vector3f& p = cloud.xyz[static_cast<std::size_t>(i)];
        map.insertPointFast(p.x(), p.y(), p.z());
    }
    if (options.outline_step > 0.0)
        for (const Obstacle& o : result.obstacles)
            if (!isOverhead(o, result.ground)) addOutline(o.box, options.outline_step, map);
    map.mark_as_modified();
    return map;
}

mrpt::obs::CObservation2DRangeScan toVirtualScan(const PointCloud& cloud, const DetectionResult& result,
                                                 const NavigationOptions& options) {
    if (options.rays < 3 || !(options.scan_range >= 0.0))
        throw std::invalid_argument("a virtual scan needs 3 rays or more and a range that is not negative");
    RayRanges rays(options.rays);
    for (const std::int32_t i : returnsOf(cloud, result, options)) {
        const Eigen::Vector3f& p = cloud.xyz[static_cast<std::size_t>(i)];
        rays.addPoint(p.x(), p.y());
    }
    for (const Obstacle& o : result.obstacles) {
        if (isOverhead(o, result.ground)) continue;
        if (isInside(o.box)) rays.blockAll();
        const auto corners = cornersFromAbove(o.box);
        for (std::size_t k = 0; k < 4; ++k) rays.addSide(corners[k], corners[(k + 1) % 4]);
    }
    mrpt::obs::CObservation2DRangeScan scan;
    scan.timestamp = mrpt::Clock::fromDouble(cloud.timestamp);
    scan.sensorLabel = "virtual_scan";
    scan.rightToLeft = true;
    // MRPT's rays go from -aperture/2 to +aperture/2, both included: a full circle less one step has no ray twice.
    scan.aperture = static_cast<float>(2.0 * M_PI * (options.rays - 1) / options.rays);
    scan.maxRange = static_cast<float>(options.scan_range);
    scan.resizeScan(static_cast<std::size_t>(options.rays));
    for (std::size_t i = 0; i < rays.ranges().size(); ++i) {
        const bool hit = rays.ranges()[i] <= options.scan_range;
        scan.setScanRange(i, static_cast<float>(hit ? rays.ranges()[i] : options.scan_range));
        scan.setScanRangeValidity(i, hit);
    }
    return scan;
}

}  // namespace lidar_obstacles
