#include "lidar_obstacles/clustering.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "label_sets.h"
#include "scan_lines.h"

namespace lidar_obstacles {
namespace {

/// Closing with a square kernel of any size. An even kernel has no centre: the erosion takes the mirrored anchor, or
/// the result would be shifted by a cell.
void closeRegion(const cv::Mat& from, int size, cv::Mat to) {
    const cv::Mat kernel = cv::getStructuringElement(cv::MORPH_RECT, cv::Size(size, size));
    const int anchor = size / 2;
    cv::Mat dilated;
    cv::dilate(from, dilated, kernel, cv::Point(anchor, anchor));
    cv::erode(dilated, to, kernel, cv::Point(size - 1 - anchor, size - 1 - anchor));
}

/// Closing whose kernel grows with range: each square ring around the sensor has its own.
cv::Mat1b closeCells(const OccupancyGrid& grid, const Eigen::Vector2d& center, const ClusteringParams& params) {
    constexpr double kRingWidth = 15.0;
    const cv::Mat1b occupied = grid.state == static_cast<std::uint8_t>(CellState::Occupied);
    cv::Mat1b closed = occupied.clone();
    const double reach = std::max(grid.width(), grid.height()) * grid.resolution;
    const int rings = static_cast<int>(std::ceil(reach / kRingWidth));
    for (int k = rings - 1; k >= 0; --k) {  // outside in: the inner squares overwrite
        const double gap = params.closing + params.closing_per_metre * (k + 0.5) * kRingWidth;
        const int size = 1 + static_cast<int>(gap / grid.resolution);
        const double half = (k + 1) * kRingWidth;
        const auto index = [&](double x, double x0) { return static_cast<int>((x - x0) / grid.resolution); };
        const cv::Rect square(cv::Point(index(center.x() - half, grid.origin.x()), index(center.y() - half, grid.origin.y())),
                              cv::Point(index(center.x() + half, grid.origin.x()), index(center.y() + half, grid.origin.y())));
        const cv::Rect roi = square & cv::Rect(0, 0, grid.width(), grid.height());
        if (roi.empty()) continue;
        if (size <= 1)
            occupied(roi).copyTo(closed(roi));
        else
            closeRegion(occupied(roi), size, closed(roi));
    }
    return closed;
}

}  // namespace

void joinAlongScanLines(const PointCloud& cloud, const std::vector<std::int32_t>& points,
                        const std::vector<int>& label_of_point, const ClusteringParams& params, LabelSets& sets) {
    const OrganizedView& view = cloud.view;
    const Eigen::Vector3f& o = cloud.sensor_origin;
    for (const std::int32_t i : points) {
        if (label_of_point[i] <= 0) continue;
        const std::int32_t* row = &view.index[static_cast<std::size_t>(cloud.ring[i]) * view.columns];
        const int column = view.column_of[i];
        for (int step = 1; step <= params.link_columns; ++step) {
            const int next = column + step;
            const std::int32_t j = row[next < view.columns ? next : next - view.columns];
            if (j < 0) continue;
            if (label_of_point[j] > 0 && label_of_point[j] != label_of_point[i]) {
                const float range = (cloud.xyz[i] - o).norm();
                const double limit = std::min(params.link_max, params.link_per_metre * range);
                if ((cloud.xyz[i] - cloud.xyz[j]).norm() < limit) sets.join(label_of_point[i], label_of_point[j]);
            }
            break;  // what lies behind this return is another surface
        }
    }
}

std::vector<Cluster> clusterCells(const OccupancyGrid& grid, const PointCloud& cloud,
                                  const std::vector<std::int32_t>& candidates, const ClusteringParams& params) {
    if (grid.state.empty()) return {};
    const cv::Mat1b closed = closeCells(grid, cloud.sensor_origin.head<2>().cast<double>(), params);
    cv::Mat1i labels;
    const int count = cv::connectedComponents(closed, labels, 8, CV_32S);
    std::vector<int> label_of_point(cloud.size(), 0);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const std::int32_t cell = grid.cell_of_candidate[k];
        if (cell >= 0) label_of_point[candidates[k]] = labels(cell / grid.width(), cell % grid.width());
    }
    LabelSets sets(count);
    if (!cloud.view.empty()) joinAlongScanLines(cloud, candidates, label_of_point, params, sets);

    std::vector<int> cluster_of_label(count, -1);
    std::vector<Cluster> clusters;
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const int label = label_of_point[candidates[k]];
        if (label <= 0) continue;
        int& cluster = cluster_of_label[sets.find(label)];
        if (cluster < 0) {
            cluster = static_cast<int>(clusters.size());
            clusters.emplace_back();
        }
        clusters[cluster].points.push_back(candidates[k]);
        clusters[cluster].cells.push_back(grid.cell_of_candidate[k]);
    }
    for (Cluster& c : clusters) {
        std::sort(c.cells.begin(), c.cells.end());
        c.cells.erase(std::unique(c.cells.begin(), c.cells.end()), c.cells.end());
    }
    return clusters;
}

}  // namespace lidar_obstacles
