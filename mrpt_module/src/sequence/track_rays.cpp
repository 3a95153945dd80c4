// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/track_rays.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

constexpr double kCircle = 2.0 * M_PI;

std::size_t sectorOf(double bearing, int sectors) {
    const int sector = static_cast<int>((bearing + M_PI) / kCircle * sectors);
    return static_cast<std::size_t>(std::clamp(sector, 0, sectors - 1));
}

/// A box and the rays from one place, in the box's own axes.
class RayBox {
  public:
    RayBox(const OrientedBox& box, const Eigen::Vector3d& origin)
        : cos_(std::cos(box.yaw)),
          sin_(std::sin(box.yaw)),
          half_(0.5 * box.size),
          middle_((box.center - origin).head<2>()),
          from_(turned(origin - box.center)) {}

    /// Part of a ray (unit length) within the box [m]; empty where first >= second.
    std::pair<double, double> crossing(const Eigen::Vector3d& way) const {
        const Eigen::Vector3d along = turned(way);
        double in = 0.0, out = 1e9;
        for (int k = 0; k < 3; ++k) {
            if (std::abs(along[k]) < 1e-9) {
                if (std::abs(from_[k]) > half_[k]) return {1.0, 0.0};
                continue;
            }
            const double a = (-half_[k] - from_[k]) / along[k], b = (half_[k] - from_[k]) / along[k];
            in = std::max(in, std::min(a, b));
            out = std::min(out, std::max(a, b));
        }
        return {in, out};
    }

    /// Counts a ray by where it ended. @param other  it ended on what was taken for something else.
    void count(const Eigen::Vector3d& way, bool other, BeamCount& count) const {
        constexpr double kMargin = 0.3;  // what lies nearer to the box's surface may be its own [m]
        const double range = way.norm();
        const auto [in, out] = crossing(way / std::max(1e-6, range));
        if (in >= out) return;
        const bool blocked = range<in - kMargin, passed = range> out + kMargin;
        count.blocked += blocked ? 1 : 0;
        count.passed += passed ? 1 : 0;
        count.hit += blocked || passed ? 0 : 1;
        count.other += !blocked && !passed && other ? 1 : 0;
    }

    /// False for rays that surely pass beside it, seen from above.
    bool mayHit(const Eigen::Vector3d& way) const {
        const double beside = way.x() * middle_.y() - way.y() * middle_.x();
        return beside * beside <= half_.head<2>().squaredNorm() * way.head<2>().squaredNorm() &&
               way.head<2>().dot(middle_) > -half_.head<2>().norm() * way.head<2>().norm();
    }

  private:
    Eigen::Vector3d turned(const Eigen::Vector3d& v) const {
        return {cos_ * v.x() + sin_ * v.y(), cos_ * v.y() - sin_ * v.x(), v.z()};
    }

    double cos_, sin_;
    Eigen::Vector3d half_;
    Eigen::Vector2d middle_;  ///< from the origin, seen from above
    Eigen::Vector3d from_;
};

}  // namespace

void BeamMap::look(const PointCloud* cloud, const std::uint8_t* other) {
    other_ = other;
    cloud_ = cloud != nullptr && !cloud->view.empty() && !cloud->empty() ? cloud : nullptr;
    if (cloud_ == nullptr) return;
    sensors_ = cloud_->allSensors();
    constexpr std::size_t kLooks = 2000;  // some 16 returns per sector
    column_of_sector_.fill(-1);
    const std::size_t step = 1 + cloud_->size() / kLooks;
    for (std::size_t i = 0; i < cloud_->size(); i += step) {
        // In double: the C library's atan2 of floats differs between releases.
        const Eigen::Vector3d d = (cloud_->xyz[i] - cloud_->originOf(static_cast<std::int32_t>(i))).cast<double>();
        column_of_sector_[sectorOf(std::atan2(d.y(), d.x()), kSectors)] = cloud_->view.column_of[i];
    }
}

/// Columns around the bearing of a box that may lead to it: columns turn one way, evenly.
BeamMap::Columns BeamMap::columnsTowards(const OrientedBox& box, const Eigen::Vector3d& origin) const {
    constexpr int kSamples = 24;  // columns looked at, about
    const OrganizedView& view = cloud_->view;
    const Eigen::Vector2d d = (box.center - origin).head<2>();
    const double radius = 0.5 * box.size.head<2>().norm();
    const double half = d.norm() > radius ? std::asin(radius / d.norm()) : M_PI;
    const std::size_t sector = sectorOf(std::atan2(d.y(), d.x()), kSectors);
    for (std::size_t off = 0; off <= kSectors / 2; ++off) {
        const std::int32_t left = column_of_sector_[(sector + off) % kSectors];
        const std::int32_t right = column_of_sector_[(sector + kSectors - off) % kSectors];
        if (left < 0 && right < 0) continue;
        const double reach_angle = half + (static_cast<double>(off) + 1.0) * kCircle / kSectors;
        const int reach = std::min(view.columns / 2, 1 + static_cast<int>(reach_angle / kCircle * view.columns));
        const int step = std::max(1, 2 * reach / kSamples);
        return {(left >= 0 ? left : right) - reach, 2 * reach / step, step};
    }
    return {};
}

BeamCount BeamMap::through(const OrientedBox& box) const {
    BeamCount count;
    if (empty()) return count;
    for (const SensorRays& sensor : sensors_) addBeams(box, sensor, count);
    return count;
}

/// The beams of one sensor.
void BeamMap::addBeams(const OrientedBox& box, const SensorRays& sensor, BeamCount& count) const {
    const PointCloud& cloud = *cloud_;
    const Eigen::Vector3d origin = sensor.origin.cast<double>();
    const Columns columns = columnsTowards(box, origin);
    const RayBox rays(box, origin);
    for (int ring = sensor.first_ring; ring < sensor.end_ring; ++ring) {
        for (int k = 0; k < columns.count; ++k) {
            const std::int32_t i = cloud.view.at(ring, cloud.view.wrap(columns.first + k * columns.step));
            if (i < 0) continue;
            const Eigen::Vector3d way = cloud.xyz[static_cast<std::size_t>(i)].cast<double>() - origin;
            if (!rays.mayHit(way)) continue;
            const bool other = other_ != nullptr && other_[static_cast<std::size_t>(i)] != 0;
            rays.count(way, other, count);
        }
    }
}

double openShare(const PlacedBox& box, const std::vector<PlacedBox>& others) {
    constexpr int kSamples = 9;
    constexpr double kBefore = 0.3;  // so much nearer to the sensor [m]
    int open = 0;
    for (int k = 0; k < kSamples; ++k) {
        const double bearing = box.bearing + box.half_angle * (2.0 * (k + 0.5) / kSamples - 1.0);
        const bool covered = std::any_of(others.begin(), others.end(), [&](const PlacedBox& o) {
            return o.range < box.range - kBefore && std::abs(normalizeAngle(o.bearing - bearing)) < o.half_angle;
        });
        open += covered ? 0 : 1;
    }
    return static_cast<double>(open) / kSamples;
}

}  // namespace lidar_obstacles
