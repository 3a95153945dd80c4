// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/grid_image.h"

namespace lidar_obstacles {

cv::Mat1b stateImage(const OccupancyGrid& grid) {
    cv::Mat1b states = cv::Mat1b::zeros(grid.height, grid.width);
    for (const std::int32_t cell : grid.free) states.data[cell] = static_cast<std::uint8_t>(CellState::Free);
    for (const std::int32_t cell : grid.occupied) states.data[cell] = static_cast<std::uint8_t>(CellState::Occupied);
    return states;
}

OccupancyGrid gridOf(const cv::Mat1b& states, const Eigen::Vector2d& origin, double resolution) {
    OccupancyGrid grid;
    grid.origin = origin;
    grid.resolution = resolution;
    grid.width = states.cols;
    grid.height = states.rows;
    for (int row = 0; row < states.rows; ++row) {
        for (int col = 0; col < states.cols; ++col) {
            const auto state = static_cast<CellState>(states(row, col));
            if (state == CellState::Occupied) grid.occupied.push_back(row * states.cols + col);
            if (state == CellState::Free) grid.free.push_back(row * states.cols + col);
        }
    }
    return grid;
}

}  // namespace lidar_obstacles
