/// @file
/// A grid's cells as a textured carpet laid on the ground.
#pragma once

#include <mrpt/opengl/CSetOfTexturedTriangles.h>

#include <array>
#include <opencv2/core.hpp>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What a texel of a carpet shows: its colour, alpha 0 where nothing is drawn.
using CarpetPalette = std::array<mrpt::img::TColor, 3>;

/// Of the CellStates: unknown left out, free dark green, occupied red.
inline CarpetPalette gridPalette() { return {{{0, 0, 0, 0}, {40, 66, 46, 255}, {150, 36, 36, 255}}}; }

/// Cells of a grid per texel of its carpet and direction: a texture has at most `max_side` texels to a side.
int cellsPerTexel(const OccupancyGrid& grid, int max_side);

/// The CellState of each texel, rows = y: occupied where one of its cells is, else free where one is.
cv::Mat1b texelStates(const OccupancyGrid& grid, int cells_per_texel);

/// Where closing joins occupied cells (Sec. III.A): 1 occupied, 2 between two occupied cells of a row or column that
/// closing makes neighbours, 0 elsewhere. @param sensor  where ranges are counted from, as the closing grows with them.
cv::Mat1b closedTexels(const OccupancyGrid& grid, const Eigen::Vector2d& sensor, const ClusteringParams& params,
                       int cells_per_texel);

/// Where a carpet lies.
struct Carpet {
    const OccupancyGrid& grid;
    const GroundModel& ground;
    double depth;         ///< below the ground [m]
    int cells_per_texel;  ///< of its texture
};

/// Makes `carpet` show the texels. What it showed before is replaced, its memory on the graphics card used again.
void layCarpet(const Carpet& place, const cv::Mat1b& texels, const CarpetPalette& palette,
               mrpt::opengl::CSetOfTexturedTriangles& carpet);

}  // namespace lidar_obstacles
