// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/zone_view.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sequence/zone_shape.h"

namespace lidar_obstacles {
namespace {

enum : std::uint8_t { kSeen = 1, kPassed = 2 };
constexpr double kMostCells = 20000.0;  ///< a larger zone has larger cells

/// The part of a ray, 0 to 1, along which it is not higher than `limit`.
std::optional<std::pair<double, double>> lowPart(double start, double end, double limit) {
    if (start <= limit && end <= limit) return std::pair(0.0, 1.0);
    if (start > limit && end > limit) return std::nullopt;
    const double crosses = (limit - start) / (end - start);
    return start > limit ? std::pair(crosses, 1.0) : std::pair(0.0, crosses);
}

/// The part along which it is as high as a body that hides nothing below it, and goes on behind.
std::optional<std::pair<double, double>> bodyPart(double start, double end, const std::pair<double, double>& low,
                                                  double length) {
    constexpr double kBelly = 0.4;   // beams pass below what is higher: under vehicles [m]
    constexpr double kBehind = 0.5;  // where a beam ends something may begin nearer by this [m]
    double from = low.first, to = std::min(low.second, 1.0 - kBehind / std::max(length, 1e-3));
    if (start < kBelly && end < kBelly) return std::nullopt;
    if (start < kBelly || end < kBelly) {
        const double crosses = (kBelly - start) / (end - start);
        (start < kBelly ? from : to) = start < kBelly ? std::max(from, crosses) : std::min(to, crosses);
    }
    if (from >= to) return std::nullopt;
    return std::pair(from, to);
}

bool isBlocked(const HealthReport* health, const Eigen::Vector2d& from_sensor) {
    if (health == nullptr || health->blocked.empty()) return false;
    const double azimuth = std::atan2(from_sensor.y(), from_sensor.x());
    return std::any_of(health->blocked.begin(), health->blocked.end(), [&](const AzimuthSpan& s) {
        return (azimuth >= s.from && azimuth < s.to) || azimuth + 2.0 * M_PI < s.to;
    });
}

}  // namespace

ZoneView::ZoneView(const Zone& zone) : object_height_(zone.rule.object_height) {
    const ZonePolygon shape = toPolygon(zone.polygon);
    const double area = boost::geometry::area(shape);
    cell_ = std::max(std::clamp(std::sqrt(area / 400.0), 0.1, 0.25), std::sqrt(area / kMostCells));
    Eigen::Vector2d high = zone.polygon.front();
    low_ = high;
    for (const Eigen::Vector2d& p : zone.polygon) {
        low_ = low_.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    columns_ = static_cast<int>(std::ceil((high.x() - low_.x()) / cell_));
    rows_ = static_cast<int>(std::ceil((high.y() - low_.y()) / cell_));
    for (int row = 0; row < rows_; ++row) {
        for (int column = 0; column < columns_; ++column) {
            const Eigen::Vector2d middle = low_ + cell_ * Eigen::Vector2d(column + 0.5, row + 0.5);
            if (distance(shape, middle) <= 0.0) inside_.push_back(row * columns_ + column);
        }
    }
    if (inside_.empty()) inside_.push_back(rows_ / 2 * columns_ + columns_ / 2);  // a sliver between the middles
    seen_.resize(static_cast<std::size_t>(columns_) * rows_);
}

void ZoneView::mark(const Ray& ray, std::uint8_t how) {
    const Eigen::Vector2d way = ray.to - ray.from;
    double from = 0.0, to = 1.0;
    const Eigen::Vector2d high = low_ + cell_ * Eigen::Vector2d(columns_, rows_);
    for (int axis = 0; axis < 2; ++axis) {  // the part of it over the cells
        const double to_low = low_[axis] - ray.from[axis], to_high = high[axis] - ray.from[axis];
        if (std::abs(way[axis]) < 1e-9) {
            if (to_low > 0.0 || to_high < 0.0) return;
            continue;
        }
        from = std::max(from, std::min(to_low / way[axis], to_high / way[axis]));
        to = std::min(to, std::max(to_low / way[axis], to_high / way[axis]));
    }
    if (from > to) return;
    const double step = 0.5 * cell_ / std::max(way.norm(), 0.5 * cell_);
    for (double t = from;; t = std::min(t + step, to)) {
        const Eigen::Vector2d place = (ray.from + t * way - low_) / cell_;
        const int column = std::clamp(static_cast<int>(std::floor(place.x())), 0, columns_ - 1);
        const int row = std::clamp(static_cast<int>(std::floor(place.y())), 0, rows_ - 1);
        seen_[static_cast<std::size_t>(row) * columns_ + column] |= how;
        if (t >= to) return;
    }
}

void ZoneView::mark(const PointCloud& cloud, const GroundModel& ground, const Eigen::Isometry2d& T_zone_vehicle) {
    std::fill(seen_.begin(), seen_.end(), std::uint8_t{0});
    std::int32_t i = 0;
    for (const SensorRays& sensor : cloud.allSensors()) {
        const Eigen::Vector3d origin = sensor.origin.cast<double>();
        const double start = origin.z() - ground.heightAt(origin.x(), origin.y());
        const Eigen::Vector2d from = T_zone_vehicle * Eigen::Vector2d(origin.head<2>());
        for (; i < sensor.end; ++i) {
            const auto end = static_cast<double>(ground.height[i]);
            const auto part = lowPart(start, end, object_height_);
            if (!part) continue;
            const Eigen::Vector2d way = T_zone_vehicle * Eigen::Vector2d(cloud.xyz[i].head<2>().cast<double>()) - from;
            mark(Ray{from + part->first * way, from + part->second * way}, kSeen);
            const auto body = bodyPart(start, end, *part, way.norm());
            if (body) mark(Ray{from + body->first * way, from + body->second * way}, kPassed);
        }
    }
}

ZoneSight ZoneView::look(const SequenceResult& found, const Eigen::Isometry2d& T_zone_vehicle, const DetectorView& view,
                         const HealthReport* health) {
    const GroundModel& ground = found.detection.ground;
    mark(found.cloud, ground, T_zone_vehicle);
    const Eigen::Isometry2d T_vehicle_zone = T_zone_vehicle.inverse();
    const Eigen::Vector2d sensor = found.cloud.sensor_origin.head<2>().cast<double>();
    ZoneSight sight;
    std::size_t seen = 0, counted = 0;
    for (const std::int32_t cell : inside_) {
        const int row = cell / columns_;
        const Eigen::Vector2d in_zone = low_ + cell_ * Eigen::Vector2d(cell % columns_ + 0.5, row + 0.5);
        const Eigen::Vector2d p = T_vehicle_zone * in_zone;
        const double z = ground.heightAt(p.x(), p.y()) + 0.5 * object_height_;
        const Eigen::Vector3f middle = Eigen::Vector3d(p.x(), p.y(), z).cast<float>();
        if (view.own_body.holds(middle)) continue;
        ++counted;
        seen += static_cast<std::size_t>((seen_[cell] & kSeen) != 0 && view.searched.holds(middle));
        sight.blocked = sight.blocked || isBlocked(health, p - sensor);
    }
    sight.seen = counted == 0 ? 0.0 : static_cast<double>(seen) / static_cast<double>(counted);
    return sight;
}

bool ZoneView::passedThrough(const ZonePolygon& outline) const {
    constexpr double kShare = 0.9;
    std::size_t cells = 0, passed = 0;
    for (const std::int32_t cell : inside_) {
        const std::int32_t column = cell % columns_, row = cell / columns_;
        const Eigen::Vector2d p = low_ + cell_ * Eigen::Vector2d(column + 0.5, row + 0.5);
        if (distance(outline, p) > 0.0) continue;
        ++cells;
        passed += static_cast<std::size_t>((seen_[cell] & kPassed) != 0);
    }
    return cells > 0 && static_cast<double>(passed) >= kShare * static_cast<double>(cells);
}

}  // namespace lidar_obstacles
