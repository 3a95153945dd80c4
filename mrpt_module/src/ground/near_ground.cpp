// SPDX-License-Identifier: BSD-3-Clause
#include "ground/near_ground.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "lidar_obstacles/own_body.h"
#include "scan/column_map.h"

namespace lidar_obstacles {
namespace {

/// Mean slope of the ground next to the sensor.
Eigen::Vector2f nearSlope(const GroundModel& model) {
    constexpr double kNear = 3.0;  // [m]
    const double x = model.center.x(), y = model.center.y();
    const double along = model.heightAt(x + kNear, y) - model.heightAt(x - kNear, y);
    const double across = model.heightAt(x, y + kNear) - model.heightAt(x, y - kNear);
    return Eigen::Vector2d(along, across).cast<float>() / static_cast<float>(2.0 * kNear);
}

/// The number that most of the values are near to.
float modeOf(const std::vector<float>& values) {
    constexpr float kBin = 0.02f, kLowest = -2.0f;  // [m]
    constexpr int kBins = 200;
    std::array<int, kBins> count{};
    for (const float v : values) {
        const int bin = static_cast<int>(std::floor((v - kLowest) / kBin));
        if (bin >= 0 && bin < kBins) ++count[static_cast<std::size_t>(bin)];
    }
    int best = 1, most = -1;
    for (int b = 1; b + 1 < kBins; ++b) {
        const auto k = static_cast<std::size_t>(b);
        const int near = count[k - 1] + 2 * count[k] + count[k + 1];
        if (near > most) most = near, best = b;
    }
    double sum = 0.0;
    int near = 0;
    for (const float v : values)
        if (std::abs(v - (kLowest + kBin * (static_cast<float>(best) + 0.5f))) < 2.0f * kBin)
            sum += static_cast<double>(v), ++near;
    return near == 0 ? 0.0f : static_cast<float>(sum / near);
}

}  // namespace

NearGround::NearGround(const PointCloud& cloud, const GroundModel& model, const DetectorParams& params,
                       std::size_t sensor)
    : cloud_(cloud),
      searched_(params.region),
      columns_(cloud.view.columns),
      step_(static_cast<float>(params.low.min_step)),
      steepest_(static_cast<float>(std::tan(params.ground.max_slope_deg * M_PI / 180.0))),
      tallest_(static_cast<float>(params.gates.min_top)),
      reach_(static_cast<float>(params.low.range)),
      slope_(nearSlope(model)) {
    const std::vector<SensorRays> sensors = cloud.allSensors();
    const SensorRays& rays = sensors[sensor];
    origin_ = rays.origin.head<2>();
    sensor_z_ = rays.origin.z();
    sensor_height_ = sensor_z_ - static_cast<float>(model.heightAt(origin_.x(), origin_.y()));
    fill(rays, sensor == 0 ? 0 : sensors[sensor - 1].end_ring, params);
    setLevel();
    setDirections();
    setExpected(rays);
}

/// Cells of the rings that look below the horizon. Heights are told below the sensor until the level is known.
void NearGround::fill(const SensorRays& rays, int first_ring, const DetectorParams& params) {
    constexpr int kAboveHorizon = 3;  // rings
    const OwnBody own(params.region.own_body);
    int above = 0;
    for (int ring = first_ring; ring < rays.end_ring; ++ring) {
        double sum = 0.0;
        int returns = 0;
        const std::size_t begin = cells_.size();
        cells_.resize(begin + static_cast<std::size_t>(columns_));
        for (int column = 0; column < columns_; ++column) {
            const std::int32_t i = cloud_.view.at(ring, column);
            if (i < 0) continue;
            const Eigen::Vector3f way = cloud_.xyz[i] - rays.origin;
            Cell& cell = cells_[begin + static_cast<std::size_t>(column)];
            cell.range = way.head<2>().norm();
            if (column % 16 == 0) sum += static_cast<double>(way.dot(rays.up) / way.norm()), ++returns;
            cell.height = way.z() - slope_.dot(way.head<2>());
            cell.left_out = searched_.leavesOut(cloud_.xyz[i]);
            cell.point = own.holds(cloud_.xyz[i]) || cell.left_out ? -1 : i;
            if (cell.point < 0) cell.range = -1.0f;
        }
        const float sine = returns > 0 ? static_cast<float>(sum / returns) : -1.0f;
        ++all_rings_;
        if (sine >= 0.0f && ++above >= kAboveHorizon) break;
        if (above > 0) continue;
        elevation_.push_back(sine);
        ++rings_;
    }
}

/// The vehicle stands on what the lowest beams meet most often: that may be a platform above the ground of the model.
void NearGround::setLevel() {
    std::vector<float> lowest;
    lowest.reserve(static_cast<std::size_t>(columns_));
    for (int column = 0; column < columns_; ++column)
        for (int ring = 0; ring < rings_; ++ring) {
            if (!isNear(at(ring, column))) continue;
            lowest.push_back(at(ring, column).height + sensor_height_);
            break;
        }
    sensor_height_ -= modeOf(lowest);
    for (Cell& cell : cells_) cell.height += sensor_height_;
}

void NearGround::setDirections() {
    direction_.resize(static_cast<std::size_t>(columns_));
    const ColumnMap map(cloud_);
    const double turn = 2.0 * M_PI / columns_;
    for (int column = 0; column < columns_; ++column) {
        const double azimuth = turn * map.sense() * (column - map.columnOf(0.0));
        direction_[static_cast<std::size_t>(column)] = {static_cast<float>(std::cos(azimuth)),
                                                        static_cast<float>(std::sin(azimuth))};
    }
}

void NearGround::setExpected(const SensorRays& rays) {
    expected_.resize(static_cast<std::size_t>(rings_) * columns_);
    for (int ring = 0; ring < rings_; ++ring) {
        const float sine = elevation_[static_cast<std::size_t>(ring)];
        const float down = -sine / std::sqrt(1.0f - sine * sine);
        for (int column = 0; column < columns_; ++column) {
            const Eigen::Vector2f& u = direction_[static_cast<std::size_t>(column)];
            const float falls = down + rays.up.head<2>().dot(u) / rays.up.z() + slope_.dot(u);
            const float range = falls > 0.0f ? sensor_height_ / falls : std::numeric_limits<float>::infinity();
            const Eigen::Vector3f on_plane =
                rays.origin + Eigen::Vector3f(range * u.x(), range * u.y(), -sensor_height_);
            const bool searched = !at(ring, column).left_out && !(range <= reach_ && searched_.leavesOut(on_plane));
            expected_[static_cast<std::size_t>(ring) * columns_ + column] =
                searched ? range : std::numeric_limits<float>::infinity();
        }
    }
}

bool NearGround::isFoot(int ring, int column) const {
    constexpr int kAbove = 8;      // rings
    constexpr float kDeep = 0.4f;  // [m]
    const Cell& foot = at(ring, column);
    for (int r = ring + 1; r < std::min(all_rings_, ring + kAbove); ++r)
        for (int k = -1; k <= 1; ++k) {
            const Cell& above = at(r, wrap(column + k));
            if (above.isReturn() && above.height > tallest_ && above.range < foot.range + kDeep) return true;
        }
    return false;
}

}  // namespace lidar_obstacles
