#include "lidar_obstacles/occupancy_grid.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "floor_to_int.h"

namespace lidar_obstacles {
namespace {

constexpr std::uint8_t kFree = static_cast<std::uint8_t>(CellState::Free);
constexpr std::uint8_t kOccupied = static_cast<std::uint8_t>(CellState::Occupied);

OccupancyGrid emptyGrid(const RegionParams& region, double resolution) {
    OccupancyGrid grid;
    grid.resolution = resolution;
    grid.origin =
        Eigen::Vector2d(std::floor(-region.rear / resolution), std::floor(-region.lateral / resolution)) * resolution;
    const int cols = static_cast<int>(std::ceil((region.front - grid.origin.x()) / resolution - 1e-9));
    const int rows = static_cast<int>(std::ceil((region.lateral - grid.origin.y()) / resolution - 1e-9));
    grid.state = cv::Mat1b::zeros(rows, cols);
    grid.count = cv::Mat1w::zeros(rows, cols);
    return grid;
}

/// Azimuth step of the scan [rad]; the usual 0.2 deg where the source does not tell.
double azimuthStep(const PointCloud& cloud) {
    constexpr double kTwoPi = 6.283185307179586;
    return kTwoPi / (cloud.view.columns > 0 ? cloud.view.columns : 1800);
}

void markGround(const PointCloud& cloud, const GroundModel& ground, OccupancyGrid& grid) {
    const float inv = static_cast<float>(1.0 / grid.resolution);
    const Eigen::Vector2f origin = grid.origin.cast<float>();
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (!ground.is_ground[i]) continue;
        const int col = floorToInt((cloud.xyz[i].x() - origin.x()) * inv);
        const int row = floorToInt((cloud.xyz[i].y() - origin.y()) * inv);
        if (static_cast<unsigned>(col) >= static_cast<unsigned>(grid.width()) ||
            static_cast<unsigned>(row) >= static_cast<unsigned>(grid.height()))
            continue;
        grid.state(row, col) = kFree;
    }
}

/// Marks what each ray crossed below the height limit: from where it comes down to it to where it ends.
void carveRays(const PointCloud& cloud, const GroundModel& ground, double max_height, OccupancyGrid& grid) {
    const Eigen::Vector2d center = cloud.sensor_origin.head<2>().cast<double>();
    const double top = cloud.sensor_origin.z() - ground.heightAt(center.x(), center.y());
    const cv::Size size = grid.state.size();
    const auto cell = [&](const Eigen::Vector2d& p) {
        return cv::Point(static_cast<int>(std::floor((p.x() - grid.origin.x()) / grid.resolution)),
                         static_cast<int>(std::floor((p.y() - grid.origin.y()) / grid.resolution)));
    };
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const double height = ground.height[i];
        if (height > max_height) continue;
        const double skip = top > max_height ? (top - max_height) / (top - height) : 0.0;
        const Eigen::Vector2d end = cloud.xyz[i].head<2>().cast<double>();
        cv::Point from = cell(center + skip * (end - center));
        cv::Point to = cell(end);
        if (!cv::clipLine(size, from, to)) continue;
        cv::LineIterator it(grid.state, from, to, 8);
        for (int k = 0; k + 1 < it.count; ++k, ++it) **it = kFree;
        if (ground.is_ground[i]) **it = kFree;
    }
}

}  // namespace

std::vector<std::int32_t> cropToRegion(const PointCloud& cloud, const GroundModel& ground, const RegionParams& params) {
    std::vector<std::int32_t> candidates;
    candidates.reserve(cloud.size() / 2);
    const auto inside = [](const Eigen::Vector3f& p, double front, double rear, double lateral) {
        return p.x() < front && p.x() >= -rear && p.y() < lateral && p.y() >= -lateral;
    };
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f& p = cloud.xyz[i];
        if (ground.is_ground[i] || ground.height[i] > params.max_height) continue;
        if (!inside(p, params.front, params.rear, params.lateral)) continue;
        if (inside(p, params.own_front, params.own_rear, params.own_lateral)) continue;
        candidates.push_back(static_cast<std::int32_t>(i));
    }
    return candidates;
}

OccupancyGrid assignToCells(OccupancyGrid grid, const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                            const GroundModel& ground) {
    const float inv = static_cast<float>(1.0 / grid.resolution);
    const Eigen::Vector2f origin = grid.origin.cast<float>();
    const Eigen::Vector3f normal = ground.normal.cast<float>();
    grid.cell_of_candidate.resize(candidates.size());
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const std::int32_t i = candidates[k];
        const Eigen::Vector2f q = (projectAlongNormal(cloud.xyz[i], ground.height[i], normal) - origin) * inv;
        const int col = floorToInt(q.x());
        const int row = floorToInt(q.y());
        const bool outside = col < 0 || row < 0 || col >= grid.width() || row >= grid.height();
        grid.cell_of_candidate[k] = outside ? -1 : row * grid.width() + col;
    }
    return grid;
}

OccupancyGrid buildOccupancyGrid(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                                 const GroundModel& ground, const DetectorParams& params) {
    OccupancyGrid grid = emptyGrid(params.region, params.grid.resolution);
    if (params.grid.free == FreeSpace::Rays)
        carveRays(cloud, ground, params.region.max_height, grid);
    else
        markGround(cloud, ground, grid);
    grid = assignToCells(grid, cloud, candidates, ground);
    std::uint16_t* count = grid.count[0];
    for (const std::int32_t cell : grid.cell_of_candidate)
        if (cell >= 0 && count[cell] < 65535) ++count[cell];
    // one plane leaves resolution / (range * step) returns on a wall across the cell
    const double expected = params.grid.min_fraction * params.grid.resolution / azimuthStep(cloud);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const std::int32_t cell = grid.cell_of_candidate[k];
        if (cell < 0) continue;
        if (count[cell] >= params.grid.max_threshold) {
            grid.state.data[cell] = kOccupied;
            continue;
        }
        const double range = (cloud.xyz[candidates[k]] - cloud.sensor_origin).norm();
        const int threshold =
            std::clamp(static_cast<int>(expected / std::max(range, 0.1)), 1, params.grid.max_threshold);
        if (count[cell] >= threshold) grid.state.data[cell] = kOccupied;
    }
    return grid;
}

}  // namespace lidar_obstacles
