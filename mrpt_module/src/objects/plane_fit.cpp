// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/plane_fit.h"

#include "objects/box.h"
#include "objects/face_fit.h"
#include "objects/line_fit.h"

namespace lidar_obstacles {
namespace {

Orientation fitPlane(const CroppedCluster& cropped, const PlaneFitParams& params) {
    if (params.method == BoxMethod::Faces) return fitSeenFaces(cropped, params);
    const std::vector<Eigen::Vector2d>& points = cropped.points;
    const RansacParams search{params.inlier_distance, params.ransac_iterations, params.seed, params.max_facing_deg};
    return orientationOf(fitFacingPlane(points, search), points, params.inlier_distance, HeadingRule::Plane);
}

}  // namespace

Obstacle fitPlaneBox(const Cluster& cluster, const PointCloud& cloud, const GroundModel& ground,
                     const PlaneBoxParams& params) {
    const CroppedCluster cropped(cluster, cloud, ground);
    return boxOf(cropped, fitPlane(cropped, params.fit), params.box);
}

std::vector<Obstacle> fitPlaneBoxes(const PointCloud& cloud, const std::vector<Cluster>& clusters,
                                    const GroundModel& ground, const PlaneBoxParams& params) {
    std::vector<Obstacle> obstacles;
    obstacles.reserve(clusters.size());
    for (const Cluster& c : clusters) obstacles.push_back(fitPlaneBox(c, cloud, ground, params));
    return obstacles;
}

}  // namespace lidar_obstacles
