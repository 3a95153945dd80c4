// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/ground.h"
#include "ground/checked_ground.h"
#include "ground/ground_runs.h"
#include "ground/ground_surface.h"
#include "scan/organize.h"

namespace lidar_obstacles {
namespace {

void labelReturns(const PointCloud& cloud, const GroundParams& params, GroundModel& model) {
    const Eigen::Vector2f center = model.center.cast<float>();
    const auto threshold = static_cast<float>(params.threshold);
    const auto growth = static_cast<float>(params.threshold_per_metre);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const float range = growth == 0.0f ? 0.0f : (cloud.xyz[i].head<2>() - center).norm();
        model.is_ground[i] = static_cast<std::uint8_t>(model.height[i] < threshold + growth * range);
    }
}

}  // namespace

GroundModel segmentGround(const PointCloud& cloud, const GroundParams& params) {
    DetectorParams all;
    all.ground = params;
    validate(all);
    validate(cloud);
    if (!cloud.empty() && !standsUpright(cloud)) return segmentCheckedGround(facingUp(cloud), params);
    return segmentCheckedGround(cloud, params);
}

GroundModel segmentCheckedGround(const PointCloud& cloud, const GroundParams& params) {
    GroundModel model;
    model.center = cloud.sensor_origin.head<2>().cast<double>();
    model.is_ground.assign(cloud.size(), 0);
    model.height.resize(cloud.size());
    const std::vector<std::uint8_t> bins = azimuthBins(cloud);
    std::vector<GroundSeed> seeds = groundSeeds(cloud, bins);
    const GroundPlane scan = fitScanPlane(seeds, cloud.sensor_origin, params);
    if (scan.support == 0) {
        for (std::size_t i = 0; i < cloud.size(); ++i) model.height[i] = cloud.xyz[i].z();
        return model;
    }
    model.evidence = scan.support >= 3 * params.min_seeds ? GroundEvidence::Good : GroundEvidence::Weak;
    followGround(scan, seeds);
    fitSurface(seeds, scan, params, model);
    measureHeights(cloud, model);
    labelReturns(cloud, params, model);
    if (params.standing_runs) keepStandingRuns(cloud, model);
    keepFeetOfObstacles(cloud, model);
    return model;
}

}  // namespace lidar_obstacles
