#include "stages.h"

#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "lidar_obstacles/clustering.h"
#include "lidar_obstacles/ground.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/occupancy_grid.h"
#include "lidar_obstacles/pipelines.h"
#include "lidar_obstacles/plane_fit.h"
#include "motion_stages.h"
#include "timed_work.h"

namespace lidar_obstacles::bench {
namespace {

/// What each stage is given: the results of the stages before it.
struct Inputs {
    const PointCloud& cloud;
    DetectorParams params;
    DetectionResult result;
    std::vector<Cluster> components;
    std::vector<Cluster> pieces;
    std::vector<Cluster> joined;

    explicit Inputs(const PointCloud& c) : cloud(c), result(detect16Plane(c, params)) {
        components = clusterCells(result.grid, cloud, result.candidates, params.clustering);
        pieces = splitOversized(components, cloud, params.clustering);
        joined = joinFragments(pieces, cloud, result.ground, params.clustering);
    }
};

void addStages(const DataSet& set) {
    const auto in = std::make_shared<const Inputs>(set.cloud);
    add("ground", set, [in] { return segmentGround(in->cloud, in->params.ground); });
    add("region", set, [in] { return cropToRegion(in->cloud, in->result.ground, in->params.region); });
    add("grid", set,
        [in] { return buildOccupancyGrid(in->cloud, in->result.candidates, in->result.ground, in->params); });
    add("clusters", set,
        [in] { return clusterCells(in->result.grid, in->cloud, in->result.candidates, in->params.clustering); });
    // these three take over what they are given; the copy is theirs to pay in the pipeline only once
    add("split", set, [in] { return splitOversized(in->components, in->cloud, in->params.clustering); });
    add("join", set, [in] { return joinFragments(in->pieces, in->cloud, in->result.ground, in->params.clustering); });
    add("gates", set, [in] { return gateClusters(in->cloud, in->result.ground, in->joined, in->params.gates); });
    add("boxes", set,
        [in] { return fitPlaneBoxes(in->cloud, in->result.clusters.accepted, in->result.ground, in->params); });
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

int floorOfGridMethods(const PointCloud& cloud) {
    constexpr int kCells = 400;
    constexpr float kResolution = 0.2f;
    constexpr float kHalf = 0.5f * kCells * kResolution;
    constexpr float kMinDifference = 0.3f;
    cv::Mat1f lowest(kCells, kCells, 1e9f);  // made anew for each scan, as the pipeline makes all it returns
    cv::Mat1f highest(kCells, kCells, -1e9f);
    cv::Mat1b occupied(kCells, kCells);
    cv::Mat1i labels;
    for (const Eigen::Vector3f& p : cloud.xyz) {
        const int col = static_cast<int>((p.x() + kHalf) * (1.0f / kResolution));
        const int row = static_cast<int>((p.y() + kHalf) * (1.0f / kResolution));
        if (col < 0 || row < 0 || col >= kCells || row >= kCells) continue;
        float& low = lowest(row, col);
        float& high = highest(row, col);
        low = std::min(low, p.z());
        high = std::max(high, p.z());
    }
    for (int row = 0; row < kCells; ++row)
        for (int col = 0; col < kCells; ++col)
            occupied(row, col) = highest(row, col) - lowest(row, col) > kMinDifference ? 255 : 0;
    return cv::connectedComponents(occupied, labels, 8, CV_32S) - 1;
}

void registerBenchmarks(const DataSet& set) {
    add(kFloor, set, [&set] { return floorOfGridMethods(set.cloud); });
    add("pipeline", set, [&set] { return detect16Plane(set.cloud, DetectorParams{}); });
    addStages(set);
    addMotionStages(set);
    if (set.packets) addDecoding(set);
}

}  // namespace lidar_obstacles::bench
