#include "lidar_obstacles/pipelines.h"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include "lidar_obstacles/clustering.h"
#include "lidar_obstacles/ground.h"
#include "lidar_obstacles/occupancy_grid.h"
#include "lidar_obstacles/plane_fit.h"

namespace lidar_obstacles {
namespace {

/// Runs one stage and notes its wall time.
template <class Stage>
auto timed(const char* name, DetectionResult& r, Stage&& stage) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    auto value = stage();
    r.timing.push_back({name, std::chrono::duration<double, std::milli>(Clock::now() - start).count()});
    return value;
}

/// Centres nearest to the origin first, ids in that order, classes by size; a pedestrian gets no heading.
void finish(std::vector<Obstacle>& obstacles, const ClassParams& params) {
    std::sort(obstacles.begin(), obstacles.end(), [](const Obstacle& a, const Obstacle& b) {
        return a.box.center.head<2>().squaredNorm() < b.box.center.head<2>().squaredNorm();
    });
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        obstacles[k].id = static_cast<int>(k);
        obstacles[k].cls = classify(obstacles[k], params);
        if (obstacles[k].cls != ObstacleClass::Pedestrian) continue;
        obstacles[k].heading_valid = false;  // the sides of a person tell nothing of where it goes (Sec. IV)
        obstacles[k].heading_std = 0.0;
    }
}

/// Everything behind the grid: the part of Fig. 2 that works on any grid. Expects ground, candidates and grid.
void detectBehindGrid(const PointCloud& cloud, const DetectorParams& params, DetectionResult& r) {
    auto parts = timed("clusters", r, [&] { return clusterCells(r.grid, cloud, r.candidates, params.clustering); });
    parts = timed("split", r, [&] { return splitOversized(std::move(parts), cloud, params.clustering); });
    parts = timed("join", r, [&] { return joinFragments(std::move(parts), cloud, r.ground, params.clustering); });
    r.clusters = timed("gates", r, [&] { return gateClusters(cloud, r.ground, std::move(parts), params.gates); });
    r.obstacles =
        timed("boxes", r, [&] { return fitPlaneBoxes(cloud, r.clusters.accepted, r.ground, params.plane_fit); });
    finish(r.obstacles, params.classes);
}

}  // namespace

DetectionResult detect16Plane(const PointCloud& cloud, const DetectorParams& params) {
    validate(params);
    DetectionResult r;
    r.ground = timed("ground", r, [&] { return segmentGround(cloud, params.ground); });
    r.candidates = timed("region", r, [&] { return cropToRegion(cloud, r.ground, params.region); });
    r.grid = timed("grid", r, [&] { return buildOccupancyGrid(cloud, r.candidates, r.ground, params); });
    detectBehindGrid(cloud, params, r);
    return r;
}

DetectionResult detectOnGrid(const OccupancyGrid& grid, const PointCloud& cloud, const GroundModel& ground,
                             const DetectorParams& params) {
    validate(params);
    validate(cloud);
    if (ground.is_ground.size() != cloud.size() || ground.height.size() != cloud.size())
        throw std::invalid_argument("detectOnGrid: the ground is not that of the cloud");
    if (!(grid.resolution > 0.0)) throw std::invalid_argument("detectOnGrid: the grid has no resolution");
    DetectionResult r;
    r.ground = ground;
    r.candidates = cropToRegion(cloud, ground, params.region);
    r.grid = assignToCells(grid, cloud, r.candidates, ground);
    detectBehindGrid(cloud, params, r);
    return r;
}

}  // namespace lidar_obstacles
