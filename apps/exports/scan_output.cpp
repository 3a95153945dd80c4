// SPDX-License-Identifier: BSD-3-Clause
#include "exports/scan_output.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles::apps {

const char* toString(ReturnKind kind) {
    static constexpr std::array<const char*, kReturnKinds> kNames = {"none",       "ground",  "unknown",  "vehicle",
                                                                     "pedestrian", "cyclist", "structure"};
    return kNames.at(static_cast<std::size_t>(kind));
}

ReturnKind kindOf(ObstacleClass cls) {
    switch (cls) {
        case ObstacleClass::Vehicle:
            return ReturnKind::Vehicle;
        case ObstacleClass::Pedestrian:
            return ReturnKind::Pedestrian;
        case ObstacleClass::Cyclist:
            return ReturnKind::Cyclist;
        case ObstacleClass::Structure:
            return ReturnKind::Structure;
        case ObstacleClass::Unknown:
            break;
    }
    return ReturnKind::Unknown;
}

std::array<std::uint8_t, 3> colorOf(ReturnKind kind) {
    static constexpr std::array<std::array<std::uint8_t, 3>, kReturnKinds> kColors = {{{90, 100, 120},
                                                                                       {130, 105, 75},
                                                                                       {235, 235, 235},
                                                                                       {255, 140, 0},
                                                                                       {0, 220, 230},
                                                                                       {200, 120, 255},
                                                                                       {140, 140, 140}}};
    return kColors.at(static_cast<std::size_t>(kind));
}

ReturnLabels labelReturns(const SequenceResult& found) {
    const std::size_t returns = found.cloud.size();
    ReturnLabels labels{std::vector<ReturnKind>(returns, ReturnKind::None), std::vector<std::int32_t>(returns, -1)};
    const std::vector<std::uint8_t>& is_ground = found.detection.ground.is_ground;
    for (std::size_t i = 0; i < returns && i < is_ground.size(); ++i)
        if (is_ground[i] != 0) labels.kind[i] = ReturnKind::Ground;
    const std::vector<Obstacle>& obstacles = found.detection.obstacles;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        for (const std::int32_t i : obstacles[k].points) {
            labels.kind[static_cast<std::size_t>(i)] = kindOf(obstacles[k].cls);
            labels.obstacle[static_cast<std::size_t>(i)] = static_cast<std::int32_t>(k);
        }
    }
    return labels;
}

std::array<Eigen::Vector3d, 8> cornersOf(const OrientedBox& box) {
    static constexpr std::array<std::array<double, 2>, 4> kSigns = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
    const double c = std::cos(box.yaw), s = std::sin(box.yaw);
    std::array<Eigen::Vector3d, 8> corners;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const double along = kSigns[k % 4][0] * box.size.x() / 2, across = kSigns[k % 4][1] * box.size.y() / 2;
        corners[k] = box.center + Eigen::Vector3d(c * along - s * across, s * along + c * across,
                                                  (k < 4 ? -0.5 : 0.5) * box.size.z());
    }
    return corners;
}

const std::array<std::array<int, 2>, 12>& boxEdges() {
    static constexpr std::array<std::array<int, 2>, 12> kEdges = {
        {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
    return kEdges;
}

KnownCells knownCells(const OccupancyGrid& grid, double smallest) {
    const int step = grid.empty() ? 1 : std::max(1, static_cast<int>(std::lround(smallest / grid.resolution)));
    const auto columnOf = [&](std::int32_t cell) { return cell % grid.width / step; };
    const auto rowOf = [&](std::int32_t cell) { return cell / grid.width / step; };
    int left = grid.width, right = -1, bottom = grid.height, top = -1;
    for (const auto* cells : {&grid.free, &grid.occupied}) {
        for (const std::int32_t cell : *cells) {
            left = std::min(left, columnOf(cell));
            right = std::max(right, columnOf(cell));
            bottom = std::min(bottom, rowOf(cell));
            top = std::max(top, rowOf(cell));
        }
    }
    if (right < left) return {};
    const double size = grid.resolution * step;
    KnownCells known{grid.origin + size * Eigen::Vector2d(left, bottom), size, right - left + 1, top - bottom + 1, ""};
    known.states.assign(static_cast<std::size_t>(known.columns) * static_cast<std::size_t>(known.rows), '\0');
    const auto mark = [&](const std::vector<std::int32_t>& cells, CellState state) {
        for (const std::int32_t cell : cells) {
            const int place = (rowOf(cell) - bottom) * known.columns + columnOf(cell) - left;
            known.states[static_cast<std::size_t>(place)] = static_cast<char>(state);
        }
    };
    mark(grid.free, CellState::Free);
    mark(grid.occupied, CellState::Occupied);
    return known;
}

}  // namespace lidar_obstacles::apps
