#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "lidar_obstacles/clustering.h"
#include "objects/follow_up.h"
#include "objects/footprint.h"

namespace lidar_obstacles {
namespace {

/// Finds the returns from which the component's surfaces lead up beyond a person's height; none if none is too tall for
/// a vehicle.
/// @param tall  is written over, and keeps its memory so.
void findTall(const Cluster& component, const GateParams& gates, SurfaceTops& topOf, std::vector<std::int32_t>& tall) {
    constexpr float kFollowFrom = 1.0f;
    tall.clear();
    float top = 0.0f;
    for (const std::int32_t i : component.points) {
        if (topOf.ground.height[i] < kFollowFrom) continue;
        const float reached = topOf(i);
        top = std::max(top, reached);
        if (reached > gates.pole_top) tall.push_back(i);
    }
    if (top < gates.max_top) tall.clear();
}

/// Splits the returns into those within 0.6 m of one of the tall ones, to a cell of 0.2 m, and the others.
std::pair<Cluster, Cluster> splitAround(const std::vector<std::int32_t>& tall, const Cluster& component,
                                        const PointCloud& cloud) {
    constexpr float kCell = 0.2f;
    constexpr int kReach = 3;  // cells
    const Eigen::Vector2f origin = boundsOf(component.points, cloud).min();
    const auto cellOf = [&](const Eigen::Vector2f& p) {
        return cv::Point(static_cast<int>((p.x() - origin.x()) / kCell),
                         static_cast<int>((p.y() - origin.y()) / kCell));
    };
    const cv::Point last = cellOf(boundsOf(component.points, cloud).max());
    cv::Mat1b near = cv::Mat1b::zeros(last.y + 1, last.x + 1);
    for (const std::int32_t i : tall) near(cellOf(cloud.xyz[i].head<2>())) = 1;
    const int side = 2 * kReach + 1;
    cv::dilate(near, near, cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side}));
    std::pair<Cluster, Cluster> parts;
    parts.first.points.reserve(component.points.size());
    parts.second.points.reserve(component.points.size());
    for (const std::int32_t i : component.points)
        (near(cellOf(cloud.xyz[i].head<2>())) != 0 ? parts.first : parts.second).points.push_back(i);
    return parts;
}

/// Could it be what is seen of a vehicle?
bool likeVehicle(const Cluster& part, const PointCloud& cloud, const ClusteringParams& params) {
    constexpr std::size_t kMinReturns = 8;
    constexpr double kMinLength = 1.3;
    if (part.points.size() < kMinReturns) return false;
    const SmallestRectangle size = smallestRectangle(footprintOf(part.points, cloud));
    return size.length >= kMinLength && size.length <= params.join_max_length && size.width <= params.join_max_width;
}

}  // namespace

std::vector<Cluster> splitFromTall(std::vector<Cluster> components, const PointCloud& cloud, const GroundModel& ground,
                                   const DetectorParams& params) {
    SurfaceTops topOf(cloud, ground);
    return splitFromTall(std::move(components), topOf, params);
}

std::vector<Cluster> splitFromTall(std::vector<Cluster> components, SurfaceTops& topOf, const DetectorParams& params) {
    const PointCloud& cloud = topOf.cloud;
    if (cloud.view.empty()) return components;
    std::vector<std::int32_t> tall_returns;
    const std::size_t count = components.size();
    for (std::size_t c = 0; c < count; ++c) {
        findTall(components[c], params.gates, topOf, tall_returns);
        if (tall_returns.empty()) continue;
        auto [tall, rest] = splitAround(tall_returns, components[c], cloud);
        if (!likeVehicle(rest, cloud, params.clustering)) continue;
        components[c] = std::move(tall);
        components.push_back(std::move(rest));
    }
    return components;
}

}  // namespace lidar_obstacles
