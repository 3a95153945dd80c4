#include "lidar_obstacles/pipelines.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <stdexcept>

#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/clustering.h"
#include "lidar_obstacles/completion.h"
#include "lidar_obstacles/ground.h"
#include "lidar_obstacles/hull_fit.h"
#include "lidar_obstacles/occupancy_grid.h"
#include "lidar_obstacles/plane_fit.h"
#include "objects/box.h"
#include "objects/follow_up.h"

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

/// The 3D filter, where there is one.
void filterCandidates(const PointCloud& cloud, const EarlierScans& earlier, DetectionResult& r) {
    if (!earlier.filter) return;
    std::vector<std::int32_t> kept = timed("filter", r, [&] { return earlier.filter(cloud, r.candidates); });
    std::set_difference(r.candidates.begin(), r.candidates.end(), kept.begin(), kept.end(),
                        std::back_inserter(r.filtered));
    r.candidates = std::move(kept);
}

struct Scan {
    const PointCloud& cloud;
    const DetectorParams& params;
    const EarlierScans& earlier;
};

/// The grid of the candidates, and of earlier scans' returns where there are any.
template <class Build>
OccupancyGrid buildGrid(Build build, const Scan& scan, const DetectionResult& r) {
    if (scan.earlier.returns.empty()) return build(scan.cloud, r.candidates, r.ground, scan.params);
    PointCloud cloud = scan.cloud;
    GroundModel ground = r.ground;
    std::vector<std::int32_t> candidates = r.candidates;
    for (const Eigen::Vector3f& p : scan.earlier.returns) {
        candidates.push_back(static_cast<std::int32_t>(cloud.size()));
        cloud.xyz.push_back(p);
        ground.is_ground.push_back(0);
        ground.height.push_back(p.z() - static_cast<float>(ground.heightAt(p.x(), p.y())));
    }
    OccupancyGrid grid = build(cloud, candidates, ground, scan.params);
    grid.place_of_candidate.resize(r.candidates.size());  // clusters are made of this scan's returns only
    return grid;
}

/// Centres nearest to the origin first, ids in that order.
std::vector<Obstacle> numbered(std::vector<Obstacle> obstacles) {
    std::sort(obstacles.begin(), obstacles.end(), [](const Obstacle& a, const Obstacle& b) {
        return a.box.center.head<2>().squaredNorm() < b.box.center.head<2>().squaredNorm();
    });
    for (std::size_t k = 0; k < obstacles.size(); ++k) obstacles[k].id = static_cast<int>(k);
    return obstacles;
}

/// Classes by what is seen, then the unseen sides, then ids.
std::vector<Obstacle> complete(std::vector<Obstacle> obstacles, const PointCloud& cloud, const DetectorParams& params,
                               const GroundModel& ground) {
    obstacles = classifyAll(std::move(obstacles), params.classes);
    return numbered(completeBoxes(std::move(obstacles), cloud, ground, params.box));
}

/// Morphology, connected components and gates: the first half of Fig. 2, on any grid.
Clusters findClusters(const PointCloud& cloud, const DetectorParams& params, DetectionResult& r) {
    SurfaceTops topOf(cloud, r.ground);
    auto parts = timed("clusters", r, [&] { return clusterCells(r.grid, cloud, r.candidates, params.clustering); });
    parts = timed("split", r, [&] { return splitOversized(std::move(parts), cloud, params.clustering); });
    parts = timed("join", r, [&] { return joinFragments(std::move(parts), cloud, r.ground, params.clustering); });
    parts = timed("tall", r, [&] { return splitFromTall(std::move(parts), topOf, params); });
    parts = timed("people", r, [&] { return splitPeople(std::move(parts), cloud, r.ground); });
    return timed("gates", r, [&] { return gateClusters(std::move(parts), topOf, params.gates); });
}

/// A plane where enough planes of the sensor hit the cluster over enough height to tell an upright face, else a hull.
std::vector<Obstacle> fitEither(const PointCloud& cloud, const std::vector<Cluster>& clusters,
                                const GroundModel& ground, const DetectorParams& params) {
    std::vector<Obstacle> obstacles;
    for (const Cluster& c : clusters) {
        const bool upright = c.top - c.bottom >= params.pipeline.auto_min_height &&
                             (cloud.ring.empty() || countPlanes(c, cloud) >= params.pipeline.auto_min_planes);
        obstacles.push_back(upright ? fitPlaneBox(c, cloud, ground, params) : fitHullBox(c, cloud, ground, params));
    }
    return obstacles;
}

}  // namespace

DetectionResult detect16Plane(const PointCloud& cloud, const DetectorParams& params, const EarlierScans& earlier) {
    validate(params);
    DetectionResult r;
    r.ground = timed("ground", r, [&] { return segmentGround(cloud, params.ground); });
    r.candidates = timed("region", r, [&] { return cropToRegion(cloud, r.ground, params.region); });
    filterCandidates(cloud, earlier, r);
    r.grid = timed("grid", r, [&] { return buildGrid(buildOccupancyGrid, {cloud, params, earlier}, r); });
    r.clusters = findClusters(cloud, params, r);
    r.obstacles = timed("boxes", r, [&] { return fitPlaneBoxes(cloud, r.clusters.accepted, r.ground, params); });
    r.obstacles = timed("completion", r, [&] { return complete(std::move(r.obstacles), cloud, params, r.ground); });
    return r;
}

DetectionResult detect8Plane(const PointCloud& cloud, const DetectorParams& params, const EarlierScans& earlier) {
    validate(params);
    DetectionResult r;
    r.ground = timed("ground", r, [&] { return segmentGround(cloud, params.ground); });
    r.candidates = timed("region", r, [&] { return cropToRegion(cloud, r.ground, params.region); });
    filterCandidates(cloud, earlier, r);
    r.grid = timed("grid", r, [&] { return buildGrid(buildFineGrid, {cloud, params, earlier}, r); });
    r.clusters = findClusters(cloud, params, r);
    r.clusters.accepted = addCells(std::move(r.clusters.accepted), cloud, r.ground, r.grid);
    r.obstacles = timed("boxes", r, [&] { return fitHullBoxes(cloud, r.clusters.accepted, r.ground, params); });
    r.obstacles = timed("completion", r, [&] { return complete(std::move(r.obstacles), cloud, params, r.ground); });
    return r;
}

DetectionResult detectAuto(const PointCloud& cloud, const DetectorParams& params, const EarlierScans& earlier) {
    validate(params);
    DetectionResult r;
    r.ground = timed("ground", r, [&] { return segmentGround(cloud, params.ground); });
    r.candidates = timed("region", r, [&] { return cropToRegion(cloud, r.ground, params.region); });
    filterCandidates(cloud, earlier, r);
    r.grid = timed("grid", r, [&] { return buildGrid(buildFineGrid, {cloud, params, earlier}, r); });
    r.clusters = findClusters(cloud, params, r);
    r.clusters.accepted = addCells(std::move(r.clusters.accepted), cloud, r.ground, r.grid);
    r.obstacles = timed("boxes", r, [&] { return fitEither(cloud, r.clusters.accepted, r.ground, params); });
    r.obstacles = timed("completion", r, [&] { return complete(std::move(r.obstacles), cloud, params, r.ground); });
    return r;
}

DetectionResult detect(const PointCloud& cloud, const DetectorParams& params, const EarlierScans& earlier) {
    switch (params.pipeline.algorithm) {
        case Algorithm::Planes16:
            return detect16Plane(cloud, params, earlier);
        case Algorithm::Planes8:
            return detect8Plane(cloud, params, earlier);
        case Algorithm::Auto:
            break;
    }
    return detectAuto(cloud, params, earlier);
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
    r.clusters = findClusters(cloud, params, r);
    r.obstacles = timed("boxes", r, [&] { return fitPlaneBoxes(cloud, r.clusters.accepted, r.ground, params); });
    r.obstacles = timed("completion", r, [&] { return complete(std::move(r.obstacles), cloud, params, r.ground); });
    return r;
}

}  // namespace lidar_obstacles
