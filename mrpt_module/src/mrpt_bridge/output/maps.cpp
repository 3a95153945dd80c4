// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/maps.h"
#include "lidar_obstacles/grid_image.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "lidar_obstacles/ground.h"
#include "lidar_obstacles/pipelines.h"

namespace lidar_obstacles {
namespace {

using Map = mrpt::maps::COccupancyGridMap2D;
using Cell = Map::cellType;

/// A map whose corner lies exactly where it is asked for.
class PlacedMap : public Map {
  public:
    explicit PlacedMap(const OccupancyGrid& grid) {
        if (grid.empty()) {
            m_map.clear();
            m_size_x = m_size_y = 0;
            m_xMin = m_xMax = m_yMin = m_yMax = 0;
            return;
        }
        const auto res = static_cast<float>(grid.resolution);
        setSize(0, res * static_cast<float>(grid.width), 0, res * static_cast<float>(grid.height), res, 0.5F);
        const Eigen::Vector2d extent = grid.resolution * Eigen::Vector2d(grid.width, grid.height);
        m_xMin = static_cast<float>(grid.origin.x());
        m_yMin = static_cast<float>(grid.origin.y());
        m_xMax = static_cast<float>(grid.origin.x() + extent.x());
        m_yMax = static_cast<float>(grid.origin.y() + extent.y());
        m_is_empty = false;
    }
};

/// State of a cell for each of the values MRPT can store, beginning with the smallest.
std::array<std::uint8_t, 256> stateOfCell(const OccupancyThresholds& thresholds) {
    std::array<std::uint8_t, 256> table{};
    for (int value = -127; value <= 127; ++value) {
        const double p_occupied = 1.0 - static_cast<double>(Map::l2p(static_cast<Cell>(value)));
        const CellState state = p_occupied >= thresholds.occupied ? CellState::Occupied
                                : p_occupied <= thresholds.free   ? CellState::Free
                                                                  : CellState::Unknown;
        table[static_cast<std::size_t>(value + 128)] = static_cast<std::uint8_t>(state);
    }
    table[0] = table[1];
    return table;
}

}  // namespace

mrpt::maps::COccupancyGridMap2D toOccupancyGridMap(const OccupancyGrid& grid) {
    static_assert(sizeof(Cell) == 1, "the tables here are for MRPT's 8-bit cells");
    Map map = PlacedMap(grid);
    std::array<Cell, 3> cell_of{};
    cell_of[static_cast<std::size_t>(CellState::Unknown)] = Map::p2l(0.5F);
    cell_of[static_cast<std::size_t>(CellState::Free)] = Map::p2l(1.F);
    cell_of[static_cast<std::size_t>(CellState::Occupied)] = Map::p2l(0.F);
    const cv::Mat1b states = stateImage(grid);
    for (int row = 0; row < grid.height; ++row) {
        const std::uint8_t* from = states[row];
        std::transform(from, from + grid.width, map.getRow(row), [&](std::uint8_t s) { return cell_of.at(s); });
    }
    return map;
}

OccupancyGrid fromOccupancyGridMap(const mrpt::maps::COccupancyGridMap2D& map, const OccupancyThresholds& thresholds) {
    if (!(0.0 <= thresholds.free && thresholds.free < thresholds.occupied && thresholds.occupied <= 1.0)) {
        throw std::invalid_argument("fromOccupancyGridMap: thresholds must satisfy 0 <= free < occupied <= 1");
    }
    const auto width = static_cast<int>(map.getSizeX());
    const auto height = static_cast<int>(map.getSizeY());
    cv::Mat1b states(height, width);
    const auto table = stateOfCell(thresholds);
    for (int row = 0; row < height; ++row) {
        const Cell* from = map.getRow(row);
        std::transform(from, from + width, states[row],
                       [&](Cell c) { return table[static_cast<std::size_t>(c + 128)]; });
    }
    return gridOf(states, {map.getXMin(), map.getYMin()}, map.getResolution());
}

DetectionResult detectOnGrid(const mrpt::maps::COccupancyGridMap2D& map, const PointCloud& cloud,
                             const std::optional<GroundModel>& ground, const DetectorParams& params) {
    return detectOnGrid(fromOccupancyGridMap(map), cloud, ground ? *ground : segmentGround(cloud, params.ground),
                        params);
}

}  // namespace lidar_obstacles
