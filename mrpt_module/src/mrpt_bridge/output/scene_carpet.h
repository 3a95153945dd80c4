// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A grid's cells laid on the ground: as a textured carpet for windows, as coloured triangles for files.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace mrpt::opengl {
class CSetOfTexturedTriangles;
class CSetOfTriangles;
}  // namespace mrpt::opengl

namespace lidar_obstacles {

/// What a texel shows: the CellStates, and what the morphology makes of them.
enum Texel : std::uint8_t {
    kNothing,
    kFree,      ///< dark green
    kOccupied,  ///< red
    kClosed,    ///< occupied, after morphology: orange
    kFilled     ///< between two occupied cells that closing makes neighbours: yellow
};

/// Cells of a grid per texel of its carpet and direction: a texture has at most `max_side` texels to a side.
int cellsPerTexel(const OccupancyGrid& grid, int max_side);

/// Texels without anything.
cv::Mat1b emptyTexels(const OccupancyGrid& grid, int cells_per_texel);
/// Marks the grid's cells: occupied where one of a texel's cells is, else free where one is.
void markStates(const OccupancyGrid& grid, int cells_per_texel, cv::Mat1b& texels);

/// What the clustering closes with.
struct Closing {
    std::vector<SensorRays> sensors;  ///< ranges are counted from the nearest: the closing grows with them
    const ClusteringParams& params;
};
/// Marks where closing (Sec. III.A) joins occupied cells of a row or column.
void markClosing(const OccupancyGrid& grid, const Closing& closing, int cells_per_texel, cv::Mat1b& texels);

/// Where a carpet lies.
struct Carpet {
    const OccupancyGrid& grid;
    const GroundModel& ground;
    double depth;         ///< below the ground [m]
    int cells_per_texel;  ///< of its texture
};

/// Makes `carpet` show the texels. What it showed before is replaced, its memory on the graphics card used again.
void layCarpet(const Carpet& place, const cv::Mat1b& texels, mrpt::opengl::CSetOfTexturedTriangles& carpet);

/// Makes `cells` show the texels, one for each cell, without a texture: MRPT 2.5.8 saves textured triangles without
/// their texture coordinates. What it showed before is replaced.
void layCells(const Carpet& place, const cv::Mat1b& texels, mrpt::opengl::CSetOfTriangles& cells);

}  // namespace lidar_obstacles
