// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One scan as the writers of files for other programs see it.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/detector.h"

namespace lidar_obstacles::apps {

/// A scan with what was found in it. Vehicle frame, metres.
struct ScanOutput {
    std::size_t scan_index;       ///< number of the scan in the input
    const SequenceResult& found;  ///< outlives this
    /// Of the vehicle at the scan's timestamp; not set where the poses do not tell.
    std::optional<Eigen::Isometry3d> T_world_vehicle;
};

/// What a return belongs to: the codes that files for other programs use.
enum class ReturnKind : std::uint8_t { None, Ground, Unknown, Vehicle, Pedestrian, Cyclist, Structure, Count };
constexpr std::size_t kReturnKinds = static_cast<std::size_t>(ReturnKind::Count);

/// "none", "ground", "unknown", "vehicle", "pedestrian", "cyclist" or "structure".
const char* toString(ReturnKind kind);
ReturnKind kindOf(ObstacleClass cls);

/// Red, green, blue of what is drawn for a kind: the colours of the pictures.
std::array<std::uint8_t, 3> colorOf(ReturnKind kind);

/// What each return of a scan belongs to.
struct ReturnLabels {
    std::vector<ReturnKind> kind;        ///< one per return
    std::vector<std::int32_t> obstacle;  ///< place in the scan's obstacles; -1: in none
};

/// Labels of all returns; empty for a scan without any. A return of no obstacle that is not ground is `None`: too high,
/// outside the region, or sorted out with its cluster.
ReturnLabels labelReturns(const SequenceResult& found);

/// The eight corners of a box: 0 to 3 around the bottom, counter-clockwise from the rear right one, 4 to 7 above them.
std::array<Eigen::Vector3d, 8> cornersOf(const OrientedBox& box);
/// Its twelve edges, as pairs of corners.
const std::array<std::array<int, 2>, 12>& boxEdges();

/// The part of a grid in which something is known, whole rows.
struct KnownCells {
    Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower-left corner [m]
    double resolution = 0.0;                           ///< [m]
    int columns = 0;                                   ///< 0: nothing is known
    int rows = 0;
    std::string states;  ///< a CellState per cell, row by row
};

/// @param smallest  cells that are smaller are put together, as many as make one of this size [m]; what is occupied
///     in part is occupied.
KnownCells knownCells(const OccupancyGrid& grid, double smallest = 0.2);

}  // namespace lidar_obstacles::apps
