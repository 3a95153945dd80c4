// SPDX-License-Identifier: BSD-3-Clause
#include "stages.h"

#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "lidar_obstacles/clustering.h"
#include "lidar_obstacles/completion.h"
#include "lidar_obstacles/ground.h"
#include "lidar_obstacles/hull_fit.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/occupancy_grid.h"
#include "lidar_obstacles/pipelines.h"
#include "lidar_obstacles/plane_fit.h"
#include "lidar_obstacles/recognizer.h"
#include "motion_stages.h"
#include "objects/gates.h"
#include "objects/groups.h"
#include "objects/merge_tree.h"
#include "objects/structure_boxes.h"
#include "timed_work.h"

namespace lidar_obstacles::bench {
namespace {

/// What each stage is given: the results of the stages before it. Stays where it was made: its members refer to each
/// other.
struct Inputs {
    const PointCloud& cloud;
    DetectorParams params;
    DetectionResult result;
    Beams beams;
    std::shared_ptr<const Recognizer> recognizer;
    MergeTree tree;                    ///< without scores
    MergeTree cut;                     ///< with scores, the best of them chosen
    std::vector<Obstacle> seen_boxes;  ///< before completion

    explicit Inputs(const PointCloud& c)
        : cloud(c),
          result(detect(c, withAlgorithm(Algorithm::Auto, params))),
          beams(c),
          recognizer(recognizerOf(params.recognizer.model)),
          tree(mergeTree(result.pieces, beams, params.grouping)),
          cut(scored()),
          seen_boxes(fitPlaneBoxes(cloud, result.clusters.accepted, result.ground, {params.plane_fit, params.box})) {
        chooseBestCut(cut.hypotheses);
        for (std::size_t k = 0; k < seen_boxes.size(); ++k) seen_boxes[k].cls = result.clusters.accepted[k].cls;
    }

    /// The tree with scores: a copy that the pipeline does not make.
    MergeTree scored() const {
        MergeTree copy = tree;
        FeatureExtractor featuresOf(beams, result.ground);
        score(copy, featuresOf, *recognizer);
        return copy;
    }
    Clusters groups() const {
        SurfaceTops topOf(cloud, result.ground);
        return sortGroups(cut.hypotheses, topOf, beams, params.gates);
    }
    std::vector<Obstacle> structure() const {
        SurfaceTops topOf(cloud, result.ground);
        std::vector<Obstacle> boxes;
        for (const Cluster& c : result.clusters.structure)
            for (Obstacle& o : structureBoxes(c, topOf)) boxes.push_back(std::move(o));
        return boxes;
    }
};

void addStages(const DataSet& set) {
    const auto in = std::make_shared<const Inputs>(set.cloud);
    add("ground", set, [in] { return segmentGround(in->cloud, in->params.ground); });
    add("region", set, [in] { return cropToRegion(in->cloud, in->result.ground, in->params.region); });
    add("grid", set, [in] {
        return buildOccupancyGrid(in->cloud, in->result.candidates, in->result.ground,
                                  {in->params.region, in->params.grid});
    });
    add("fine_grid", set, [in] {
        return buildFineGrid(in->cloud, in->result.candidates, in->result.ground, {in->params.region, in->params.grid});
    });
    add("pieces", set,
        [in] { return clusterCells(in->result.grid, in->cloud, in->result.candidates, in->params.clustering); });
    add("beams", set, [in] { return Beams(in->cloud).noise(); });
    add("tree", set, [in] { return mergeTree(in->result.pieces, in->beams, in->params.grouping); });
    add("score", set, [in] { return in->scored(); });
    add("groups", set, [in] { return in->groups(); });
    add("plane_boxes", set, [in] {
        return fitPlaneBoxes(in->cloud, in->result.clusters.accepted, in->result.ground,
                             {in->params.plane_fit, in->params.box});
    });
    add("hull_boxes", set, [in] {
        return fitHullBoxes(in->cloud, in->result.clusters.accepted, in->result.ground,
                            {in->params.hull_fit, in->params.box});
    });
    add("completion", set, [in] {
        return completeBoxes(in->seen_boxes, in->cloud, in->result.ground, {in->params.region, in->params.box});
    });
    add("structure", set, [in] { return in->structure(); });
}

void addDecoding(const DataSet& set) {
    const auto scan = set.packets;
    add("decode", set, [scan] { return toPointCloud(*scan, SensorParams{}); });
    add("mrpt_decode", set, [scan] {
        scan->generatePointCloud();
        return scan->point_cloud.size();
    });
}

}  // namespace

int floorOfGridMethods(const PointCloud& cloud, FloorMemory& m) {
    constexpr int kCells = 400;
    constexpr float kResolution = 0.2f;
    constexpr float kHalf = 0.5f * kCells * kResolution;
    constexpr float kMinDifference = 0.3f;
    m.lowest.create(kCells, kCells);
    m.highest.create(kCells, kCells);
    m.occupied.create(kCells, kCells);
    m.lowest = 1e9f;
    m.highest = -1e9f;
    for (const Eigen::Vector3f& p : cloud.xyz) {
        const int col = static_cast<int>((p.x() + kHalf) * (1.0f / kResolution));
        const int row = static_cast<int>((p.y() + kHalf) * (1.0f / kResolution));
        if (col < 0 || row < 0 || col >= kCells || row >= kCells) continue;
        float& low = m.lowest(row, col);
        float& high = m.highest(row, col);
        low = std::min(low, p.z());
        high = std::max(high, p.z());
    }
    for (int row = 0; row < kCells; ++row)
        for (int col = 0; col < kCells; ++col)
            m.occupied(row, col) = m.highest(row, col) - m.lowest(row, col) > kMinDifference ? 255 : 0;
    return cv::connectedComponents(m.occupied, m.labels, 8, CV_32S) - 1;
}

void registerBenchmarks(const DataSet& set) {
    add(kFloor, set,
        [&set, memory = std::make_shared<FloorMemory>()] { return floorOfGridMethods(set.cloud, *memory); });
    add("16-plane", set, [&set] { return detect(set.cloud, withAlgorithm(Algorithm::Planes16)); });
    add("8-plane", set, [&set] { return detect(set.cloud, withAlgorithm(Algorithm::Planes8)); });
    add("auto", set, [&set] { return detect(set.cloud, withAlgorithm(Algorithm::Auto)); });
    addStages(set);
    addMotionStages(set);
    if (set.packets) addDecoding(set);
}

}  // namespace lidar_obstacles::bench
