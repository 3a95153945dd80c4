#include "lidar_obstacles/pipelines.h"

#include <chrono>

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

}  // namespace

DetectionResult detect16Plane(const PointCloud& cloud, const DetectorParams& params) {
    validate(params);
    DetectionResult r;
    r.ground = timed("ground", r, [&] { return segmentGround(cloud, params.ground); });
    r.candidates = timed("region", r, [&] { return cropToRegion(cloud, r.ground, params.region); });
    r.grid = timed("grid", r, [&] { return buildOccupancyGrid(cloud, r.candidates, r.ground, params); });
    auto components = timed("clusters", r, [&] { return clusterCells(r.grid, cloud, r.candidates, params.clustering); });
    components = timed("split", r, [&] { return splitOversized(std::move(components), cloud, params.clustering); });
    components = timed("join", r, [&] { return joinFragments(std::move(components), cloud, r.ground, params.clustering); });
    r.clusters = timed("gates", r, [&] { return gateClusters(cloud, r.ground, std::move(components), params.gates); });
    r.obstacles = timed("boxes", r, [&] { return fitPlaneBoxes(cloud, r.clusters.accepted, r.ground, params.plane_fit); });
    for (Obstacle& o : r.obstacles) o.cls = classify(o, params.classes);
    return r;
}

DetectionResult detectOnGrid(const OccupancyGrid& grid, const PointCloud& cloud, const GroundModel& ground,
                             const DetectorParams& params) {
    validate(params);
    DetectionResult r;
    r.ground = ground;
    r.candidates = cropToRegion(cloud, ground, params.region);
    r.grid = assignToCells(grid, cloud, r.candidates, ground);
    auto components = clusterCells(r.grid, cloud, r.candidates, params.clustering);
    components = splitOversized(std::move(components), cloud, params.clustering);
    components = joinFragments(std::move(components), cloud, ground, params.clustering);
    r.clusters = gateClusters(cloud, ground, std::move(components), params.gates);
    r.obstacles = fitPlaneBoxes(cloud, r.clusters.accepted, ground, params.plane_fit);
    for (Obstacle& o : r.obstacles) o.cls = classify(o, params.classes);
    return r;
}

}  // namespace lidar_obstacles
