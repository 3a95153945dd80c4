#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "grid/scan_lines.h"
#include "lidar_obstacles/clustering.h"
#include "objects/footprint.h"
#include "scan/floor_to_int.h"
#include "scan/label_sets.h"

namespace lidar_obstacles {
namespace {

constexpr double kLongestVehicle = 14.0;
constexpr double kWallWidth = 1.5;

/// Is the cluster more than one car, by its size? Longer or wider than a car: it may be a bus, or two cars that the
/// cells of the grid could not keep apart.
bool oversized(const Cluster& cluster, const PointCloud& cloud, const ClusteringParams& params) {
    const Eigen::Vector2f sides = boundsOf(cluster.points, cloud).sizes();
    if (surelyWithin(sides, params.join_max_length, params.join_max_width)) return false;
    const SmallestRectangle size = smallestRectangle(footprintOf(cluster.points, cloud));
    if (size.length > kLongestVehicle && size.width < kWallWidth) return false;  // a wall or hedge: no use in pieces
    return size.length > params.join_max_length || size.width > params.join_max_width;
}

/// Connected components of one cluster's returns on a finer grid of its own.
std::vector<Cluster> splitCluster(const Cluster& cluster, const PointCloud& cloud, const ClusteringParams& params,
                                  std::vector<int>& label_of_point) {
    const double range = (cloud.xyz[cluster.points[0]] - cloud.sensor_origin).norm();
    const float inv = static_cast<float>(1.0 / std::max(params.split_resolution, params.split_per_metre * range));
    std::vector<cv::Point> cell_of(cluster.points.size());
    for (std::size_t k = 0; k < cluster.points.size(); ++k) {
        const Eigen::Vector3f& p = cloud.xyz[cluster.points[k]];
        cell_of[k] = {floorToInt(p.x() * inv), floorToInt(p.y() * inv)};
    }
    const cv::Rect area = cv::boundingRect(cell_of);
    cv::Mat1b occupied = cv::Mat1b::zeros(area.size());
    for (const cv::Point& c : cell_of) occupied(c - area.tl()) = 255;
    cv::Mat1i labels;
    const int count = cv::connectedComponents(occupied, labels, 8, CV_32S);
    for (std::size_t k = 0; k < cluster.points.size(); ++k)
        label_of_point[cluster.points[k]] = labels(cell_of[k] - area.tl());
    LabelSets sets(count);
    if (!cloud.view.empty()) joinAlongScanLines(cloud, cluster.points, label_of_point, params, sets);

    std::vector<Cluster> pieces = clustersOfLabels(cluster.points, label_of_point, sets, count);
    for (const std::int32_t i : cluster.points) label_of_point[i] = -1;
    return pieces;
}

}  // namespace

std::vector<Cluster> splitOversized(std::vector<Cluster> components, const PointCloud& cloud,
                                    const ClusteringParams& params) {
    std::vector<int> label_of_point;  // made when the first component is split
    std::vector<Cluster> out;
    out.reserve(components.size());
    for (Cluster& c : components) {
        if (!oversized(c, cloud, params)) {
            out.push_back(std::move(c));
            continue;
        }
        if (label_of_point.empty()) label_of_point.assign(cloud.size(), -1);
        for (Cluster& piece : splitCluster(c, cloud, params, label_of_point)) out.push_back(std::move(piece));
    }
    return out;
}

}  // namespace lidar_obstacles
