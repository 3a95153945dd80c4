// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/pipelines.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <iterator>
#include <stdexcept>

#include "grid/notches.h"
#include "ground/checked_ground.h"
#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/clustering.h"
#include "lidar_obstacles/completion.h"
#include "lidar_obstacles/hull_fit.h"
#include "lidar_obstacles/occupancy_grid.h"
#include "lidar_obstacles/plane_fit.h"
#include "lidar_obstacles/recognizer.h"
#include "lidar_obstacles/searched_place.h"
#include "objects/box.h"
#include "objects/expectations.h"
#include "objects/follow_up.h"
#include "objects/gates.h"
#include "objects/groups.h"
#include "objects/hanging.h"
#include "objects/joins.h"
#include "objects/merge_tree.h"
#include "objects/overlap.h"
#include "objects/structure_boxes.h"
#include "scan/organize.h"

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

/// The grid of the candidates, and of earlier scans' returns where there are any. Its cells are those of the algorithm.
OccupancyGrid buildGrid(const Scan& scan, const DetectionResult& r) {
    const auto build = scan.params.pipeline.algorithm == Algorithm::Planes16 ? buildOccupancyGrid : buildFineGrid;
    const OccupancyGridParams params{scan.params.region, scan.params.grid};
    if (scan.earlier.returns.empty()) return build(scan.cloud, r.candidates, r.ground, params);
    PointCloud cloud = scan.cloud;
    GroundModel ground = r.ground;
    std::vector<std::int32_t> candidates = r.candidates;
    const PlaceOfObstacles place(scan.params.region);
    for (const Eigen::Vector3f& p : scan.earlier.returns) {
        if (!place.holds(p)) continue;  // the vehicle has moved since
        candidates.push_back(static_cast<std::int32_t>(cloud.size()));
        cloud.xyz.push_back(p);
        ground.is_ground.push_back(0);
        ground.height.push_back(p.z() - static_cast<float>(ground.heightAt(p.x(), p.y())));
    }
    OccupancyGrid grid = build(cloud, candidates, ground, params);
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

/// What is seen above the region only, and not proven to hang free: facades and crowns behind something nearer.
std::vector<Cluster> highStructure(SurfaceTops& topOf, const DetectorParams& params,
                                   std::vector<RejectedCluster>& overhangs) {
    const PointCloud& cloud = topOf.cloud;
    const std::vector<std::int32_t> high = cropAboveRegion(cloud, topOf.ground, params.region);
    const OccupancyGrid grid = buildOccupiedGrid(cloud, high, topOf.ground, {params.region, params.grid});
    std::vector<Cluster> standing;
    for (Cluster& c :
         withoutOverhangs(clusterCells(grid, cloud, high, params.clustering), topOf, params.gates, overhangs)) {
        if (static_cast<int>(c.points.size()) < params.gates.min_points) continue;
        c.cls = ObstacleClass::Structure;
        c.probability[static_cast<std::size_t>(ObstacleClass::Structure)] = 1.0f;
        standing.push_back(std::move(c));
    }
    return standing;
}

/// The best cut of a tree, and what gains by being joined beside it; then each is judged among the others.
void chooseGroups(MergeTree& tree, FeatureExtractor& featuresOf, const Recognizer& recognizer,
                  const GroupingParams& params) {
    score(tree, featuresOf, recognizer);
    chooseBestCut(tree.hypotheses);
    joinChosen(tree, featuresOf, recognizer, params);
    if (!recognizer.judgesSurroundings()) return;
    judgeChosen(tree, recognizer);
    joinPieces(tree, featuresOf, recognizer, params);
}

/// Pieces, what may be made of them, and the best of it: groups that are one object each.
Clusters bestGroups(SurfaceTops& topOf, const DetectorParams& params, const EarlierScans& earlier, DetectionResult& r) {
    const PointCloud& cloud = topOf.cloud;
    std::vector<RejectedCluster> overhangs;
    r.pieces = timed("pieces", r, [&] {
        std::vector<Cluster> pieces = partedAtExpected(
            partedAtNotches(clusterCells(r.grid, cloud, r.candidates, params.clustering), cloud, r.ground.height),
            cloud, earlier.objects);
        markHanging(pieces, topOf, params.gates);
        return pieces;
    });
    const Beams beams(cloud);
    const auto recognizer = recognizerOf(params.recognizer.model);
    FeatureExtractor featuresOf(beams, r.ground);
    const HangingReturns hanging =
        timed("overhangs", r, [&] { return HangingReturns(topOf, r.candidates, params.gates.max_bottom); });
    timed("hanging", r, [&] {
        HangingParts(topOf, hanging, featuresOf, *recognizer, params.gates).takeOut(r.pieces, overhangs);
        return 0;
    });
    MergeTree tree = timed("tree", r, [&] { return mergeTree(r.pieces, beams, params.grouping); });
    lookForExpected(tree, cloud, earlier.objects);
    timed("score", r, [&] {
        chooseGroups(tree, featuresOf, *recognizer, params.grouping);
        return 0;
    });
    r.hypotheses = std::move(tree.hypotheses);
    Clusters groups = timed("groups", r, [&] {
        Clusters sorted = sortGroups(r.hypotheses, topOf, beams, params.gates);
        partAtHanging(sorted.structure, hanging, r.ground, params.gates);
        return sorted;
    });
    timed("above", r, [&] {
        for (Cluster& c : highStructure(topOf, params, overhangs)) groups.structure.push_back(std::move(c));
        return 0;
    });
    std::move(overhangs.begin(), overhangs.end(), std::back_inserter(groups.rejected));
    return groups;
}

/// The paper by itself: the components of the closed grid, by their size.
Clusters bareClusters(SurfaceTops& topOf, const DetectorParams& params, DetectionResult& r) {
    r.pieces = timed("pieces", r, [&] { return clusterCells(r.grid, topOf.cloud, r.candidates, params.clustering); });
    return timed("groups", r, [&] { return gateBySize(r.pieces, topOf, params.gates, params.hull_fit.person); });
}

/// The fit of the algorithm; `auto`: a plane where enough rings hit the cluster over enough height to tell an upright
/// face, else a hull.
Obstacle fitBox(const Cluster& c, const PointCloud& cloud, const GroundModel& ground, const DetectorParams& params) {
    const PipelineParams& p = params.pipeline;
    const bool upright = c.top - c.bottom >= p.auto_min_height &&
                         (cloud.ring.empty() || countRings(c.points, cloud) >= p.auto_min_planes);
    const bool plane = p.algorithm == Algorithm::Auto ? upright : p.algorithm == Algorithm::Planes16;
    return plane ? fitPlaneBox(c, cloud, ground, {params.plane_fit, params.box})
                 : fitHullBox(c, cloud, ground, {params.hull_fit, params.box});
}

std::vector<Obstacle> fitBoxes(const PointCloud& cloud, const DetectionResult& r, const DetectorParams& params) {
    std::vector<Obstacle> obstacles;
    obstacles.reserve(r.clusters.accepted.size());
    for (const Cluster& c : r.clusters.accepted) {
        obstacles.push_back(fitBox(c, cloud, r.ground, params));
        obstacles.back().cls = c.cls;
        obstacles.back().probability = c.probability;
        applyClass(obstacles.back());
    }
    return obstacles;
}

/// Beside the road users what stands and is none.
std::vector<Obstacle> withStructure(std::vector<Obstacle> obstacles, SurfaceTops& topOf, const Clusters& clusters) {
    addStructureBoxes(clusters.structure, topOf, obstacles);
    return obstacles;
}

/// From the grid on: components -> boxes (Fig. 2), on any grid.
void findObstacles(const Scan& scan, DetectionResult& r) {
    const PointCloud& cloud = scan.cloud;
    const DetectorParams& params = scan.params;
    SurfaceTops topOf(cloud, r.ground);
    const bool bare = params.pipeline.bare_paper;
    r.clusters = bare ? bareClusters(topOf, params, r) : bestGroups(topOf, params, scan.earlier, r);
    if (params.pipeline.algorithm != Algorithm::Planes16)  // hulls are of cells
        r.clusters.accepted = addCells(std::move(r.clusters.accepted), cloud, r.ground, r.grid);
    r.obstacles = timed("boxes", r, [&] { return fitBoxes(cloud, r, params); });
    r.obstacles = timed("completion", r, [&] {
        auto complete = completeBoxes(std::move(r.obstacles), cloud, r.ground, {params.region, params.box});
        return bare ? complete : withoutOverlaps(std::move(complete), r.ground);
    });
    r.obstacles =
        timed("structure", r, [&] { return numbered(withStructure(std::move(r.obstacles), topOf, r.clusters)); });
    for (Obstacle& o : r.obstacles) o.cls = toldClass(o, params.gates);
}

/// @throws std::invalid_argument unless the occupied cells are in rising order and inside.
void checkCells(const OccupancyGrid& grid) {
    const auto& cells = grid.occupied;
    if (std::adjacent_find(cells.begin(), cells.end(), std::greater_equal<>()) != cells.end())
        throw std::invalid_argument("detectOnGrid: the grid's occupied cells are not in rising order");
    if (!cells.empty() && (cells.front() < 0 || cells.back() >= grid.width * grid.height))
        throw std::invalid_argument("detectOnGrid: an occupied cell lies outside the grid");
}

}  // namespace

DetectionResult detect(const PointCloud& cloud, const DetectorParams& given, const EarlierScans& earlier) {
    validate(cloud);
    if (!given.pipeline.bare_paper && !facesUp(cloud)) return detect(facingUp(cloud), given, earlier);
    const DetectorParams params = given.pipeline.bare_paper ? barePaper(given) : given;
    validate(params);
    DetectionResult r;
    r.ground = timed("ground", r, [&] { return segmentCheckedGround(cloud, params.ground); });
    if (params.low.enabled && !params.pipeline.bare_paper)
        r.low = timed("low", r, [&] { return findLowThings(cloud, r.ground, params); });
    r.candidates = timed("region", r, [&] { return cropToRegion(cloud, r.ground, params.region); });
    filterCandidates(cloud, earlier, r);
    r.grid = timed("grid", r, [&] { return buildGrid({cloud, params, earlier}, r); });
    findObstacles({cloud, params, earlier}, r);
    return r;
}

DetectionResult detectOnGrid(const OccupancyGrid& grid, const PointCloud& cloud, const GroundModel& ground,
                             const DetectorParams& given) {
    const DetectorParams params = given.pipeline.bare_paper ? barePaper(given) : given;
    validate(params);
    validate(cloud);
    if (ground.is_ground.size() != cloud.size() || ground.height.size() != cloud.size())
        throw std::invalid_argument("detectOnGrid: the ground is not that of the cloud");
    if (!(grid.resolution > 0.0)) throw std::invalid_argument("detectOnGrid: the grid has no resolution");
    if (!params.pipeline.bare_paper && !facesUp(cloud)) return detectOnGrid(grid, facingUp(cloud), ground, params);
    checkCells(grid);
    DetectionResult r;
    r.ground = ground;
    r.candidates = cropToRegion(cloud, ground, params.region);
    r.grid = assignToCells(grid, cloud, r.candidates, ground);
    findObstacles({cloud, params, {}}, r);
    return r;
}

}  // namespace lidar_obstacles
