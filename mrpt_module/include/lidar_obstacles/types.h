// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The data types of the module: what goes in, what every stage leaves behind, what comes out.
///
/// Frame: everything is told in the **vehicle frame** (MRPT's robot frame): x forward, y left, z up, metres,
/// `sensorPose` already applied. A yaw is counter-clockwise from +x, in [-pi, pi). The yaw of a box from one scan holds
/// modulo 180 degrees: which end is the front is not seen.
///
///          x (forward)                       occupancy grid, seen from above
///          ^                                  y ^  row height-1
///          |   yaw > 0 turns left               |  +--+--+--+--+
///     +----|----+                               |  |  |  |  |  |   cell (col, row) covers
///     |    |    |                               |  +--+--+--+--+   [x0 + col*res, x0 + (col+1)*res) x
///  y <-----o    |                               |  |  |  |  |  |   [y0 + row*res, y0 + (row+1)*res)
///     |         |                               |  +--+--+--+--+
///     +---------+                       origin (x0, y0) --------> x   (x0, y0) = lower-left corner
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "lidar_obstacles/hypothesis.h"
#include "lidar_obstacles/low_things.h"
#include "lidar_obstacles/obstacle.h"
#include "lidar_obstacles/point_cloud.h"

namespace lidar_obstacles {

/// z = offset + slope . (x, y): one patch of ground.
struct GroundPlane {
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    double offset = 0.0;
    int support = 0;  ///< seed returns it was fitted to; 0: none

    double heightAt(double x, double y) const { return offset + slope.x() * x + slope.y() * y; }
};

enum class GroundEvidence : std::uint8_t { None, Weak, Good };

/// The ground under one scan: one continuous surface, heights of nodes on circles around the sensor.
/// `evidence == None`: no plane could be supported; nothing is labelled ground and the surface lies where the
/// vehicle frame has z = 0 (a hint, not a finding).
struct GroundModel {
    GroundEvidence evidence = GroundEvidence::None;
    GroundPlane plane;           ///< of the whole scan; z = 0 without evidence
    int sectors = 0;             ///< directions of the surface's nodes, counter-clockwise from -pi
    std::vector<double> ranges;  ///< horizontal ranges of the nodes [m], rising
    std::vector<double> rise;    ///< of each node above `plane` [m]: sectors x ranges; empty: the plane is all
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< mean normal where ground was seen, unit length
    Eigen::Vector2d center = Eigen::Vector2d::Zero();   ///< directions and ranges are counted from here (the sensor)
    std::vector<std::uint8_t> is_ground;                ///< one label per return
    std::vector<float> height;                          ///< height of each return above the local ground [m]

    /// z of the ground at (x, y) [m]: one surface without steps, linear between the nodes.
    double heightAt(double x, double y) const;
};

enum class CellState : std::uint8_t { Unknown = 0, Free = 1, Occupied = 2 };

/// 2D occupancy grid on the ground plane; cell (col, row) as drawn above has the number row * width + col. Only what
/// was seen is listed, so that work follows the occupied area and not the size of the grid; `stateImage`
/// (grid_image.h) draws all cells.
struct OccupancyGrid {
    Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower-left corner [m]
    double resolution = 0.0;                           ///< cell size [m]
    int width = 0;                                     ///< columns
    int height = 0;                                    ///< rows
    std::vector<std::int32_t> occupied;                ///< numbers of the occupied cells, rising
    std::vector<std::int32_t> free;                    ///< of the free ones, may repeat; occupied wins over free
    std::vector<std::int32_t> place_of_candidate;      ///< place in `occupied` of each candidate's cell; -1: not there

    bool empty() const { return width == 0 || height == 0; }
    /// Cell that holds (x, y), by floor; false where it lies outside.
    bool cellAt(double x, double y, int& col, int& row) const;
    Eigen::Vector2d cellCenter(int col, int row) const {
        return origin + resolution * Eigen::Vector2d(col + 0.5, row + 0.5);
    }
    Eigen::Vector2d cellCenter(std::int32_t cell) const { return cellCenter(cell % width, cell / width); }
};

/// Wall time of one stage of a run [ms].
struct StageTime {
    const char* stage = "";
    double ms = 0.0;
};

/// Every intermediate of one run: nothing is dropped without a trace.
struct DetectionResult {
    GroundModel ground;
    std::vector<LowThing> low;             ///< beside the obstacles: steps, drops, missing ground (low_things.h)
    std::vector<std::int32_t> candidates;  ///< returns that may be obstacles (above ground, inside the region)
    std::vector<std::int32_t> filtered;    ///< those that the 3D filter took out of them
    OccupancyGrid grid;
    std::vector<Cluster> pieces;         ///< connected components of the grid (Fig. 2)
    std::vector<Hypothesis> hypotheses;  ///< pieces and what may be made of them, with their scores
    Clusters clusters;
    std::vector<Obstacle> obstacles;
    std::vector<StageTime> timing;
};

/// "none", "weak" or "good".
const char* toString(GroundEvidence e);

}  // namespace lidar_obstacles
