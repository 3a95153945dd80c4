// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/clustering.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "grid/scan_lines.h"
#include "scan/label_sets.h"
#include "scan/looked_columns.h"

namespace lidar_obstacles {
namespace {

/// Closing and connected components in one (Sec. III.A): a closing that bridges gaps of g cells makes cells neighbours
/// that lie up to g + 1 cells apart. The gap grows with range, as the spacing of the returns does. Work follows the
/// number of occupied cells, not the size of the grid.
///
/// Departs from Sec. III.A: no opening. A face that a single ring hits is one cell wide, and an opening would remove
/// it; lone cells are sorted out by their number of returns instead (GateParams).
class CellConnector {
  public:
    CellConnector(const OccupancyGrid& grid, const PointCloud& cloud, const ClusteringParams& params)
        : grid_(grid),
          sets_(static_cast<int>(grid.occupied.size())),
          first_of_row_(grid.height + 1, 0),
          last_row_(grid.width, -1) {
        col_.reserve(grid.occupied.size());
        reach_.reserve(grid.occupied.size());
        const std::vector<SensorRays> sensors = cloud.allSensors();
        int row = 0;
        for (const std::int32_t cell : grid.occupied) {
            while (cell >= (row + 1) * grid.width) ++row;
            const int col = cell - row * grid.width;
            const double range = distanceTo(sensors, grid.cellCenter(col, row));
            col_.push_back(col);
            reach_.push_back(closingReach(range, grid.resolution, params));
            ++first_of_row_[row + 1];
        }
        for (int r = 0; r < grid.height; ++r) first_of_row_[r + 1] += first_of_row_[r];
    }

    LabelSets connect() {
        first_run_.reserve(grid_.height + 1);
        for (int row = 0; row < grid_.height; ++row) {
            first_run_.push_back(static_cast<int>(runs_.size()));
            const int first = first_of_row_[row];
            const int end = first_of_row_[row + 1];
            if (first == end) continue;
            findRuns(first, end);
            connectToLowerRows(row, *std::max_element(reach_.begin() + first, reach_.begin() + end));
        }
        return std::move(sets_);
    }

  private:
    /// To the nearest sensor [m].
    static double distanceTo(const std::vector<SensorRays>& sensors, const Eigen::Vector2d& place) {
        double nearest = std::numeric_limits<double>::max();
        for (const SensorRays& s : sensors)
            nearest = std::min(nearest, (place - s.origin.head<2>().cast<double>()).norm());
        return nearest;
    }

    /// Cells of one row with the same reach, of which each is within the reach of the next.
    struct Run {
        int first = 0;  ///< column
        int last = 0;
        int cell = 0;   ///< any of them: its place in `occupied`
        int reach = 1;  ///< of the cells
    };

    /// Puts the cells of a row into runs.
    void findRuns(int first, int end) {
        for (int i = first; i < end; ++i) {
            const bool near = i > first && col_[i] - col_[i - 1] <= reach_[i];
            if (near) sets_.join(i, i - 1);
            if (near && reach_[i] == runs_.back().reach)
                runs_.back().last = col_[i];
            else
                runs_.push_back({col_[i], col_[i], i, reach_[i]});
        }
    }

    /// Columns, the last one included.
    struct Columns {
        int first = 0;
        int last = 0;

        bool none() const { return first > last; }
    };

    /// Joins the runs of the last row with those of lower rows that are within their reach. Each row is walked along
    /// once.
    void connectToLowerRows(int row, int farthest) {
        const int lowest = std::max(0, row - farthest);
        next_.assign(first_run_.begin() + lowest, first_run_.end());
        const auto first = static_cast<std::size_t>(first_run_[row]);
        for (std::size_t r = first; r < runs_.size(); ++r) connectDownwards(runs_[r], row, lowest);
        for (std::size_t r = first; r < runs_.size(); ++r)
            std::fill(last_row_.begin() + runs_[r].first, last_row_.begin() + runs_[r].last + 1, row);
    }

    /// Joins a run with those of lower rows, the next one first: in columns that a run there reaches as well, what
    /// lies below that one is joined with it already.
    void connectDownwards(const Run& run, int row, int lowest) {
        const int end = std::max(0, row - run.reach);
        Columns open{std::max(0, run.first - run.reach), std::min(grid_.width - 1, run.last + run.reach)};
        for (int lower = row - 1; lower >= end; --lower) {
            while (!open.none() && last_row_[open.first] < end) ++open.first;
            while (!open.none() && last_row_[open.last] < end) --open.last;
            if (open.none()) return;
            open = connect(run, open, {row, lower}, next_[lower - lowest]);
        }
    }

    struct Rows {
        int own, lower;
    };
    /// Joins a run with those of a lower row in some columns, looking from `next` on, and moves that on. @return the
    /// columns in which there may be more below that row.
    Columns connect(const Run& run, const Columns& open, const Rows& rows, int& next) {
        const int end = first_run_[rows.lower + 1];
        while (next < end && runs_[next].last < run.first - run.reach) ++next;
        Columns rest = open;
        for (int k = next; k < end && runs_[k].first <= open.last; ++k) {
            const Run& other = runs_[k];
            if (other.last < open.first) continue;
            sets_.join(run.cell, other.cell);
            if (other.reach < run.reach - (rows.own - rows.lower)) continue;
            const Columns reached{other.first - other.reach, other.last + other.reach};
            if (reached.first <= rest.first) rest.first = std::max(rest.first, reached.last + 1);
            if (reached.last >= rest.last) rest.last = std::min(rest.last, reached.first - 1);
        }
        return rest;
    }

    const OccupancyGrid& grid_;
    LabelSets sets_;
    std::vector<int> first_of_row_;  ///< places in `occupied`; rows + 1 entries
    std::vector<int> last_row_;      ///< of each column: below the row that is looked at, the last one with a run there
    std::vector<int> col_;
    std::vector<int> reach_;      ///< cells up to this far away are neighbours
    std::vector<Run> runs_;       ///< row by row
    std::vector<int> first_run_;  ///< of each row so far, in `runs_`
    std::vector<int> next_;       ///< of each lower row in reach: the first run that is not yet left behind
};

/// What comes next on a ring.
struct NextReturn {
    std::int32_t index = -1;  ///< -1: nothing within reach
    int blind = 0;            ///< columns in between at which nobody looked
};

/// The rings of a scan, walked along from return to return.
class ScanLines {
  public:
    explicit ScanLines(const PointCloud& cloud) : cloud_(cloud), looked_at_(cloud.view) {}

    /// The next return of the same ring within the given number of columns that were looked at.
    NextReturn after(std::int32_t i, int columns) const {
        const OrganizedView& view = cloud_.view;
        const std::int32_t* row = &view.index[static_cast<std::size_t>(cloud_.ring[i]) * view.columns];
        const int from = view.column_of[i];
        const int place = looked_at_.placeOf(from);
        for (int step = 1; step <= std::min(columns, looked_at_.count() - 1); ++step) {
            const int column = looked_at_.columnAt(place + step);
            if (row[column] >= 0) return {row[column], view.wrap(column - from) - step};
        }
        return {};
    }

    /// Squared distance of two returns [m^2]; across the line of sight without the columns at which nobody looked: a
    /// gap there is no wider than what was looked at.
    float squaredGap(std::int32_t i, const NextReturn& next) const {
        const Eigen::Vector3f way = cloud_.xyz[next.index] - cloud_.xyz[i];
        if (next.blind == 0) return way.squaredNorm();
        constexpr auto kCircle = static_cast<float>(2.0 * M_PI);
        const float turned = kCircle * static_cast<float>(next.blind) / static_cast<float>(cloud_.view.columns);
        const Eigen::Vector3f ray = cloud_.xyz[i] - cloud_.originOf(i);
        const float range = ray.norm();
        const float along = way.dot(ray) / range;
        const float across = std::sqrt(std::max(0.0f, way.squaredNorm() - along * along));
        const float looked_at = std::max(0.0f, across - turned * range);
        return along * along + looked_at * looked_at;
    }

  private:
    const PointCloud& cloud_;
    LookedColumns looked_at_;
};

}  // namespace

// NOLINTNEXTLINE(readability-function-size): the labels and their sets belong together, but the callers own them apart
void joinAlongScanLines(const PointCloud& cloud, const std::vector<std::int32_t>& points,
                        const std::vector<int>& label_of_point, const ClusteringParams& params, LabelSets& sets) {
    const auto farthest = static_cast<float>(params.link_max * params.link_max);
    const auto per_metre = static_cast<float>(params.link_per_metre * params.link_per_metre);
    const ScanLines lines(cloud);
    for (const std::int32_t i : points) {
        const int own = label_of_point[i];
        const NextReturn next = own >= 0 ? lines.after(i, params.link_columns) : NextReturn{};
        const std::int32_t j = next.index;
        const int other = j >= 0 ? label_of_point[j] : -1;
        if (other < 0 || sets.seenJoined(own, other)) continue;
        const float limit = std::min(farthest, per_metre * (cloud.xyz[i] - cloud.originOf(i)).squaredNorm());
        if (lines.squaredGap(i, next) < limit) sets.join(own, other);
    }
}

std::vector<Cluster> clustersOfLabels(const std::vector<std::int32_t>& points, const std::vector<int>& label_of_point,
                                      LabelSets& sets, std::size_t labels) {
    std::vector<int> root(labels);
    for (std::size_t label = 0; label < labels; ++label) root[label] = sets.find(static_cast<int>(label));
    std::vector<int> size(labels, 0);
    for (const std::int32_t i : points)
        if (label_of_point[i] >= 0) ++size[root[label_of_point[i]]];
    std::vector<int> cluster_of(labels, -1);
    std::vector<Cluster> clusters;
    for (const std::int32_t i : points) {
        if (label_of_point[i] < 0) continue;
        int& cluster = cluster_of[root[label_of_point[i]]];
        if (cluster < 0) {
            cluster = static_cast<int>(clusters.size());
            clusters.emplace_back();
            clusters.back().points.reserve(size[root[label_of_point[i]]]);
        }
        clusters[cluster].points.push_back(i);
    }
    return clusters;
}

int closingReach(double range, double resolution, const ClusteringParams& params) {
    return std::max(1, static_cast<int>((params.closing + params.closing_per_metre * range) / resolution));
}

std::vector<Cluster> clusterCells(const OccupancyGrid& grid, const PointCloud& cloud,
                                  const std::vector<std::int32_t>& candidates, const ClusteringParams& params) {
    LabelSets sets = CellConnector(grid, cloud, params).connect();
    std::vector<int> label_of_point(cloud.size(), -1);
    for (std::size_t k = 0; k < candidates.size(); ++k) label_of_point[candidates[k]] = grid.place_of_candidate[k];
    if (!cloud.view.empty()) joinAlongScanLines(cloud, candidates, label_of_point, params, sets);
    return clustersOfLabels(candidates, label_of_point, sets, grid.occupied.size());
}

}  // namespace lidar_obstacles
