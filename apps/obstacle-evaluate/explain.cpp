// SPDX-License-Identifier: BSD-3-Clause
#include "explain.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/number_text.h"

namespace lidar_obstacles::apps {
namespace {

std::size_t countIn(const std::vector<std::uint8_t>& inside, const std::vector<std::int32_t>& points) {
    const auto n = std::count_if(points.begin(), points.end(),
                                 [&](std::int32_t i) { return inside[static_cast<std::size_t>(i)] != 0; });
    return static_cast<std::size_t>(n);
}

}  // namespace

std::vector<std::int32_t> returnsIn(const OrientedBox& box, const PointCloud& cloud) {
    constexpr double kMargin = 0.1;  // [m]
    const double c = std::cos(box.yaw);
    const double s = std::sin(box.yaw);
    const Eigen::Vector3d half = 0.5 * box.size + Eigen::Vector3d::Constant(kMargin);
    std::vector<std::int32_t> inside;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3d d = cloud.xyz[i].cast<double>() - box.center;
        const Eigen::Vector3d q(c * d.x() + s * d.y(), -s * d.x() + c * d.y(), d.z());
        if ((q.cwiseAbs() - half).maxCoeff() <= 0.0) inside.push_back(static_cast<std::int32_t>(i));
    }
    return inside;
}

std::vector<std::string> explainReturns(const OrientedBox& box, const PointCloud& cloud,
                                        const DetectionResult& result) {
    std::vector<std::uint8_t> inside(cloud.size(), 0);
    for (const std::int32_t i : returnsIn(box, cloud)) inside[static_cast<std::size_t>(i)] = 1;
    std::size_t ground = 0;
    for (std::size_t i = 0; i < result.ground.is_ground.size(); ++i) ground += inside[i] & result.ground.is_ground[i];
    std::vector<std::string> lines = {std::to_string(std::count(inside.begin(), inside.end(), 1)) +
                                      " returns in its box: " + std::to_string(ground) + " taken for ground, " +
                                      std::to_string(countIn(inside, result.candidates)) + " candidates"};
    for (const Obstacle& o : result.obstacles) {
        const std::size_t n = countIn(inside, o.points);
        if (n == 0) continue;
        lines.push_back(std::to_string(n) + " of them in " + toString(o.cls) + ' ' + std::to_string(o.id) + " (" +
                        fixedText(o.box.size.x(), 2) + " x " + fixedText(o.box.size.y(), 2) + " x " +
                        fixedText(o.box.size.z(), 2) + " m, " + std::to_string(o.num_points) + " returns in all)");
    }
    for (const RejectedCluster& r : result.clusters.rejected) {
        const std::size_t n = countIn(inside, r.cluster.points);
        if (n == 0) continue;
        lines.push_back(std::to_string(n) + " of them in a cluster of " + std::to_string(r.cluster.points.size()) +
                        " that was sorted out as " + toString(r.reason) + " (" + fixedText(r.measured, 2) + ", limit " +
                        fixedText(r.limit, 2) + ")");
    }
    return lines;
}

}  // namespace lidar_obstacles::apps
