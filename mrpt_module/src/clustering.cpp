#include "lidar_obstacles/clustering.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include "label_sets.h"
#include "scan_lines.h"

namespace lidar_obstacles {
namespace {

/// The occupied cells of a grid, row by row: all work below follows their number, not the size of the grid.
struct OccupiedCells {
    std::vector<int> col;
    std::vector<int> first_of_row;          ///< rows + 1 entries
    std::unique_ptr<std::int32_t[]> place;  ///< of each occupied cell in the list; other entries are not set

    /// Joins cell `i` with the occupied cells of a row whose columns lie in [columns.first, columns.second].
    void joinWithin(int row, std::pair<int, int> columns, int i, LabelSets& sets) const {
        const auto end = col.begin() + first_of_row[row + 1];
        auto at = std::lower_bound(col.begin() + first_of_row[row], end, columns.first);
        for (; at != end && *at <= columns.second; ++at) sets.join(i, static_cast<int>(at - col.begin()));
    }
};

OccupiedCells occupiedCells(const OccupancyGrid& grid) {
    constexpr int kOccupied = static_cast<int>(CellState::Occupied);
    OccupiedCells cells;
    cells.place.reset(new std::int32_t[grid.state.total()]);
    for (int row = 0; row < grid.height(); ++row) {
        cells.first_of_row.push_back(static_cast<int>(cells.col.size()));
        const std::uint8_t* begin = grid.state[row];
        const std::uint8_t* end = begin + grid.width();
        const std::uint8_t* at = begin;
        while (at < end && (at = static_cast<const std::uint8_t*>(std::memchr(at, kOccupied, end - at))) != nullptr) {
            cells.place[row * grid.width() + (at - begin)] = static_cast<std::int32_t>(cells.col.size());
            cells.col.push_back(static_cast<int>(at - begin));
            ++at;
        }
    }
    cells.first_of_row.push_back(static_cast<int>(cells.col.size()));
    return cells;
}

/// Closing and connected components in one (Sec. III.A): a closing that bridges gaps of g cells makes cells neighbours
/// that lie up to g + 1 cells apart. The gap grows with range, as the spacing of the returns does.
///
/// Departs from Sec. III.A: no opening. A face that a single plane hits is one cell wide, and an opening would remove
/// it; lone cells are sorted out by their number of returns instead (GateParams).
LabelSets closeAndConnect(const OccupancyGrid& grid, const OccupiedCells& cells, const Eigen::Vector2d& sensor,
                          const ClusteringParams& params) {
    LabelSets sets(static_cast<int>(cells.col.size()));
    for (int row = 0; row < grid.height(); ++row) {
        for (int i = cells.first_of_row[row]; i < cells.first_of_row[row + 1]; ++i) {
            const int col = cells.col[i];
            const double range = (grid.cellCenter(col, row) - sensor).norm();
            const int reach =
                1 + static_cast<int>((params.closing + params.closing_per_metre * range) / grid.resolution);
            if (i > cells.first_of_row[row] && col - cells.col[i - 1] <= reach) sets.join(i, i - 1);
            for (int other = std::max(0, row - reach); other < row; ++other)
                cells.joinWithin(other, {col - reach, col + reach}, i, sets);
        }
    }
    return sets;
}

/// Puts the candidates of each set of labels into one cluster.
std::vector<Cluster> collect(const std::vector<std::int32_t>& candidates, const std::vector<int>& label_of_point,
                             LabelSets& sets, std::size_t labels) {
    std::vector<int> size(labels, 0);
    for (const std::int32_t i : candidates)
        if (label_of_point[i] >= 0) ++size[sets.find(label_of_point[i])];
    std::vector<int> cluster_of(labels, -1);
    std::vector<Cluster> clusters;
    for (const std::int32_t i : candidates) {
        if (label_of_point[i] < 0) continue;
        const int root = sets.find(label_of_point[i]);
        if (cluster_of[root] < 0) {
            cluster_of[root] = static_cast<int>(clusters.size());
            clusters.emplace_back();
            clusters.back().points.reserve(size[root]);
        }
        clusters[cluster_of[root]].points.push_back(i);
    }
    return clusters;
}

/// The next return of the same plane within the given number of columns, -1 if there is none.
std::int32_t nextOnScanLine(const PointCloud& cloud, std::int32_t i, int columns) {
    const OrganizedView& view = cloud.view;
    const std::int32_t* row = &view.index[static_cast<std::size_t>(cloud.ring[i]) * view.columns];
    for (int step = 1; step <= std::min(columns, view.columns - 1); ++step) {
        const int next = view.column_of[i] + step;
        const std::int32_t j = row[next < view.columns ? next : next - view.columns];
        if (j >= 0) return j;
    }
    return -1;
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): the labels and their sets belong together, but the callers own them apart
void joinAlongScanLines(const PointCloud& cloud, const std::vector<std::int32_t>& points,
                        const std::vector<int>& label_of_point, const ClusteringParams& params, LabelSets& sets) {
    for (const std::int32_t i : points) {
        if (label_of_point[i] < 0) continue;
        const std::int32_t j = nextOnScanLine(cloud, i, params.link_columns);
        if (j < 0 || label_of_point[j] < 0 || label_of_point[j] == label_of_point[i]) continue;
        const float range = (cloud.xyz[i] - cloud.sensor_origin).norm();
        const double limit = std::min(params.link_max, params.link_per_metre * range);
        if ((cloud.xyz[i] - cloud.xyz[j]).norm() < limit) sets.join(label_of_point[i], label_of_point[j]);
    }
}

std::vector<Cluster> clusterCells(const OccupancyGrid& grid, const PointCloud& cloud,
                                  const std::vector<std::int32_t>& candidates, const ClusteringParams& params) {
    const OccupiedCells cells = occupiedCells(grid);
    LabelSets sets = closeAndConnect(grid, cells, cloud.sensor_origin.head<2>().cast<double>(), params);
    std::vector<int> label_of_point(cloud.size(), -1);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const std::int32_t cell = grid.cell_of_candidate[k];
        if (cell >= 0 && grid.state.data[cell] == static_cast<std::uint8_t>(CellState::Occupied))
            label_of_point[candidates[k]] = cells.place[cell];
    }
    if (!cloud.view.empty()) joinAlongScanLines(cloud, candidates, label_of_point, params, sets);
    return collect(candidates, label_of_point, sets, cells.col.size());
}

}  // namespace lidar_obstacles
