// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/occupancy_grid.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/searched_place.h"
#include "scan/organize.h"

namespace lidar_obstacles {
namespace {

OccupancyGrid emptyGrid(const RegionParams& region, double resolution) {
    OccupancyGrid grid;
    grid.resolution = resolution;
    grid.origin =
        Eigen::Vector2d(std::floor(-region.rear / resolution), std::floor(-region.lateral / resolution)) * resolution;
    grid.width = static_cast<int>(std::ceil((region.front - grid.origin.x()) / resolution - 1e-9));
    grid.height = static_cast<int>(std::ceil((region.lateral - grid.origin.y()) / resolution - 1e-9));
    return grid;
}

/// Azimuth step of the scan [rad]; the usual 0.2 deg where the source does not tell.
double azimuthStep(const PointCloud& cloud) {
    return 2.0 * M_PI / (cloud.view.columns > 0 ? cloud.view.columns : kUsualColumns);
}

/// Column and row of the cell that holds a point.
struct Cell {
    int col = 0;
    int row = 0;
};

/// Finds the cell that holds a point: its number, or -1 outside.
struct CellFinder {
    explicit CellFinder(const OccupancyGrid& grid)
        : origin(grid.origin.cast<float>()),
          inv(static_cast<float>(1.0 / grid.resolution)),
          width(grid.width),
          height(grid.height) {}

    /// False where it lies outside; `cell` stays as it was then.
    bool find(const Eigen::Vector2f& p, Cell& cell) const {
        const float col = (p.x() - origin.x()) * inv;
        const float row = (p.y() - origin.y()) * inv;
        if (!(col >= 0.0f && row >= 0.0f && col < static_cast<float>(width) && row < static_cast<float>(height)))
            return false;
        cell = {static_cast<int>(col), static_cast<int>(row)};  // inside, truncation is floor
        return true;
    }
    std::int32_t operator()(const Eigen::Vector2f& p) const {
        Cell cell;
        return find(p, cell) ? cell.row * width + cell.col : -1;
    }

    Eigen::Vector2f origin;
    float inv;
    int width;
    int height;
};

void markGround(const PointCloud& cloud, const GroundModel& ground, OccupancyGrid& grid) {
    const CellFinder cellOf(grid);
    grid.free.resize(cloud.size());
    const std::size_t size = cloud.size();
    const std::uint8_t* is_ground = ground.is_ground.data();
    std::int32_t* free = grid.free.data();
    std::int32_t last = -1;
    std::size_t count = 0;
    for (std::size_t i = 0; i < size; ++i) {
        const std::int32_t cell = cellOf(cloud.xyz[i].head<2>());
        const std::int32_t marked = is_ground[i] != 0 && cell >= 0 ? cell : last;
        free[count] = marked;  // written over by the next one if it is the one before again
        count += static_cast<std::size_t>(marked != last);
        last = marked;
    }
    grid.free.resize(count);
}

/// Marks what each ray crossed below the height limit: from where it comes down to it to where it ends.
void carveRays(const PointCloud& cloud, const GroundModel& ground, double max_height, OccupancyGrid& grid) {
    cv::Mat1b carved = cv::Mat1b::zeros(grid.height, grid.width);  // rays cross near cells over and over
    const auto cell = [&](const Eigen::Vector2d& p) {
        return cv::Point(static_cast<int>(std::floor((p.x() - grid.origin.x()) / grid.resolution)),
                         static_cast<int>(std::floor((p.y() - grid.origin.y()) / grid.resolution)));
    };
    const std::vector<SensorRays> sensors = cloud.allSensors();
    std::vector<double> tops;
    tops.reserve(sensors.size());
    for (const SensorRays& s : sensors) tops.push_back(s.origin.z() - ground.heightAt(s.origin.x(), s.origin.y()));
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const double height = ground.height[i];
        if (height > max_height) continue;
        const std::size_t sensor = cloud.sensorOf(static_cast<std::int32_t>(i));
        const Eigen::Vector2d center = sensors[sensor].origin.head<2>().cast<double>();
        const double top = tops[sensor];
        const double skip = top > max_height ? (top - max_height) / (top - height) : 0.0;
        const Eigen::Vector2d end = cloud.xyz[i].head<2>().cast<double>();
        cv::Point from = cell(center + skip * (end - center));
        cv::Point to = cell(end);
        if (!cv::clipLine(carved.size(), from, to)) continue;
        cv::LineIterator it(carved, from, to, 8);
        for (int k = 0; k + 1 < it.count; ++k, ++it) **it = 1;
        if (ground.is_ground[i]) **it = 1;
    }
    for (std::int32_t c = 0; c < static_cast<std::int32_t>(carved.total()); ++c)
        if (carved.data[c] != 0) grid.free.push_back(c);
}

/// Keys 0 .. n-1 in the order of bucketOf(key), equal ones in their order (counting sort).
template <class BucketOf>
std::vector<std::int32_t> sorted(const std::vector<std::int32_t>& keys, int buckets, BucketOf bucketOf) {
    std::vector<std::int32_t> start(static_cast<std::size_t>(buckets) + 1, 0);
    for (const std::int32_t key : keys) ++start[bucketOf(key) + 1];
    for (int b = 0; b < buckets; ++b) start[b + 1] += start[b];
    std::vector<std::int32_t> out(keys.size());
    for (const std::int32_t key : keys) out[start[bucketOf(key)]++] = key;
    return out;
}

/// The cell of each candidate when it is projected along the ground's normal, and the candidates inside the grid in the
/// order of their cells.
struct Projection {
    std::vector<Cell> cell;           ///< means nothing outside
    std::vector<std::int32_t> order;  ///< places in `candidates`
    int width = 0;

    std::int32_t number(std::int32_t k) const { return cell[k].row * width + cell[k].col; }
};

Projection project(const PointCloud& cloud, const std::vector<std::int32_t>& candidates, const GroundModel& ground,
                   const OccupancyGrid& grid) {
    const CellFinder cellOf(grid);
    const Eigen::Vector3f normal = ground.normal.cast<float>();
    Projection p;
    p.width = grid.width;
    p.cell.resize(candidates.size());
    p.order.resize(candidates.size());
    std::size_t count = 0;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const std::int32_t i = candidates[k];
        p.order[count] = static_cast<std::int32_t>(k);  // written over by the next one if it lies outside
        const Eigen::Vector2f on_ground = projectAlongNormal(cloud.xyz[i], ground.height[i], normal);
        count += static_cast<std::size_t>(cellOf.find(on_ground, p.cell[k]));
    }
    p.order.resize(count);
    p.order = sorted(p.order, grid.width, [&](std::int32_t k) { return p.cell[k].col; });
    p.order = sorted(p.order, grid.height, [&](std::int32_t k) { return p.cell[k].row; });
    return p;
}

}  // namespace

std::vector<std::int32_t> cropToRegion(const PointCloud& cloud, const GroundModel& ground, const RegionParams& params) {
    std::vector<std::int32_t> candidates(cloud.size());
    const PlaceOfObstacles place(params);
    const auto max_height = static_cast<float>(params.max_height);
    std::size_t count = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f& p = cloud.xyz[i];
        candidates[count] = static_cast<std::int32_t>(i);  // written over by the next one unless it is kept
        count +=
            static_cast<std::size_t>(ground.is_ground[i] == 0 && !(ground.height[i] > max_height) && place.holds(p));
    }
    candidates.resize(count);
    return candidates;
}

std::vector<std::int32_t> cropAboveRegion(const PointCloud& cloud, const GroundModel& ground,
                                          const RegionParams& params) {
    std::vector<std::int32_t> high;
    const PlaceOfObstacles place(params);
    const auto max_height = static_cast<float>(params.max_height);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (ground.is_ground[i] == 0 && ground.height[i] > max_height && place.holds(cloud.xyz[i]))
            high.push_back(static_cast<std::int32_t>(i));
    return high;
}

OccupancyGrid assignToCells(OccupancyGrid grid, const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                            const GroundModel& ground) {
    const Projection p = project(cloud, candidates, ground, grid);
    grid.place_of_candidate.assign(candidates.size(), -1);
    std::size_t place = 0;
    for (const std::int32_t k : p.order) {
        while (place < grid.occupied.size() && grid.occupied[place] < p.number(k)) ++place;
        if (place < grid.occupied.size() && grid.occupied[place] == p.number(k))
            grid.place_of_candidate[k] = static_cast<std::int32_t>(place);
    }
    return grid;
}

OccupancyGrid buildOccupiedGrid(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                                const GroundModel& ground, const OccupancyGridParams& params) {
    OccupancyGrid grid = emptyGrid(params.region, params.grid.resolution);
    const Projection p = project(cloud, candidates, ground, grid);
    grid.place_of_candidate.assign(candidates.size(), -1);
    // one ring leaves resolution / (range * step) returns on a wall across the cell
    const double expected = params.grid.min_fraction * params.grid.resolution / azimuthStep(cloud);
    for (std::size_t first = 0; first < p.order.size();) {
        const std::int32_t cell = p.number(p.order[first]);
        std::size_t end = first + 1;
        while (end < p.order.size() && p.number(p.order[end]) == cell) ++end;
        const std::int32_t i = candidates[p.order[first]];
        const double range = (cloud.xyz[i] - cloud.originOf(i)).norm();
        const int threshold =
            std::clamp(static_cast<int>(expected / std::max(range, 0.1)), 1, params.grid.max_threshold);
        if (static_cast<int>(end - first) >= threshold) {
            for (std::size_t k = first; k < end; ++k)
                grid.place_of_candidate[p.order[k]] = static_cast<std::int32_t>(grid.occupied.size());
            grid.occupied.push_back(cell);
        }
        first = end;
    }
    return grid;
}

OccupancyGrid buildOccupancyGrid(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                                 const GroundModel& ground, const OccupancyGridParams& params) {
    OccupancyGrid grid = buildOccupiedGrid(cloud, candidates, ground, params);
    if (params.grid.free == FreeSpace::Rays)
        carveRays(cloud, ground, params.region.max_height, grid);
    else
        markGround(cloud, ground, grid);
    return grid;
}

OccupancyGrid buildFineGrid(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                            const GroundModel& ground, const OccupancyGridParams& params) {
    OccupancyGridParams fine = params;
    fine.grid.resolution = params.grid.fine_resolution;
    return buildOccupancyGrid(cloud, candidates, ground, fine);
}

std::vector<Cluster> addCells(std::vector<Cluster> clusters, const PointCloud& cloud, const GroundModel& ground,
                              const OccupancyGrid& grid) {
    const CellFinder cellOf(grid);
    const Eigen::Vector3f normal = ground.normal.cast<float>();
    std::vector<std::int32_t> cells;
    for (Cluster& cluster : clusters) {
        cells.clear();
        for (const std::int32_t i : cluster.points) {
            const std::int32_t cell = cellOf(projectAlongNormal(cloud.xyz[i], ground.height[i], normal));
            if (cell >= 0) cells.push_back(cell);
        }
        std::sort(cells.begin(), cells.end());
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
        cluster.cells.clear();
        cluster.cells.reserve(cells.size());
        for (const std::int32_t cell : cells) cluster.cells.push_back(grid.cellCenter(cell).cast<float>());
    }
    return clusters;
}

}  // namespace lidar_obstacles
