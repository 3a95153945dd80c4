// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/output/scene_carpet.h"

#include <mrpt/opengl/CSetOfTexturedTriangles.h>
#include <mrpt/opengl/CSetOfTriangles.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "lidar_obstacles/clustering.h"

namespace lidar_obstacles {
namespace {

constexpr std::array<mrpt::img::TColor, 5> kColors = {
    {{0, 0, 0, 0}, {40, 66, 46, 255}, {150, 36, 36, 255}, {235, 120, 30, 255}, {240, 225, 90, 255}}};

uchar& texelOf(const OccupancyGrid& grid, std::int32_t cell, int k, cv::Mat1b& texels) {
    return texels(cell / grid.width / k, cell % grid.width / k);
}

/// The texels of which a tile of cells shows something.
cv::Rect texelsOf(const cv::Rect& cells, int k) {
    const cv::Point last = cells.br() - cv::Point(1, 1);
    return {cv::Point(cells.x / k, cells.y / k), cv::Point(last.x / k + 1, last.y / k + 1)};
}

/// Cells to a side of the tiles that follow the ground.
int tileOf(const OccupancyGrid& grid) {
    constexpr int kTiles = 50;  // along the longer side
    return std::max(1, std::max(grid.width, grid.height) / kTiles);
}

/// The lower left corner of a cell, at the carpet's height.
mrpt::math::TPoint3Df cornerAt(const Carpet& place, int col, int row) {
    const Eigen::Vector2d p = place.grid.origin + place.grid.resolution * Eigen::Vector2d(col, row);
    return mrpt::math::TPoint3D(p.x(), p.y(), place.ground.heightAt(p.x(), p.y()) - place.depth).cast<float>();
}

/// The texels like the one at `from`, from there along its row and then on to the next rows, before `end`.
cv::Rect rectangleOf(const cv::Mat1b& texels, const cv::Point& from, const cv::Point& end) {
    const std::uint8_t kind = texels(from);
    int right = from.x;
    while (right < end.x && texels(from.y, right) == kind) ++right;
    int top = from.y + 1;
    while (top < end.y && cv::countNonZero(texels(cv::Range(top, top + 1), cv::Range(from.x, right)) != kind) == 0)
        ++top;
    return {from, cv::Point(right, top)};
}

/// The carpet's triangles: two for each tile that has something on it, their corners at the ground's height.
void layTriangles(const Carpet& place, const cv::Mat1b& texels, mrpt::opengl::CSetOfTexturedTriangles& carpet) {
    const OccupancyGrid& grid = place.grid;
    const int tile = tileOf(grid);
    const auto corner = [&](int col, int row) {
        mrpt::opengl::TTriangle::Vertex v;
        v.xyzrgba.pt = cornerAt(place, col, row);
        v.uv = {static_cast<float>(col) / static_cast<float>(place.cells_per_texel * texels.cols),
                static_cast<float>(row) / static_cast<float>(place.cells_per_texel * texels.rows)};
        v.normal = {0, 0, 1};
        return v;
    };
    carpet.clearTriangles();
    for (int row = 0; row < grid.height; row += tile) {
        for (int col = 0; col < grid.width; col += tile) {
            const int right = std::min(col + tile, grid.width);
            const int top = std::min(row + tile, grid.height);
            const cv::Rect cells(col, row, right - col, top - row);
            if (cv::countNonZero(texels(texelsOf(cells, place.cells_per_texel))) == 0) continue;
            mrpt::opengl::TTriangle lower;
            mrpt::opengl::TTriangle upper;
            lower.vertices = {corner(col, row), corner(right, row), corner(right, top)};
            upper.vertices = {corner(col, row), corner(right, top), corner(col, top)};
            carpet.insertTriangle(lower);
            carpet.insertTriangle(upper);
        }
    }
}

/// To the nearest sensor, as the clustering counts it [m].
double distanceTo(const std::vector<SensorRays>& sensors, const Eigen::Vector2d& place) {
    double nearest = std::numeric_limits<double>::max();
    for (const SensorRays& s : sensors) nearest = std::min(nearest, (place - s.origin.head<2>().cast<double>()).norm());
    return nearest;
}

}  // namespace

int cellsPerTexel(const OccupancyGrid& grid, int max_side) {
    return std::max(1, (std::max(grid.width, grid.height) + max_side - 1) / max_side);
}

cv::Mat1b emptyTexels(const OccupancyGrid& grid, int k) {
    return cv::Mat1b::zeros((grid.height + k - 1) / k, (grid.width + k - 1) / k);
}

void markStates(const OccupancyGrid& grid, int k, cv::Mat1b& texels) {
    for (const std::int32_t cell : grid.free) texelOf(grid, cell, k, texels) = kFree;
    for (const std::int32_t cell : grid.occupied) texelOf(grid, cell, k, texels) = kOccupied;
}

void markClosing(const OccupancyGrid& grid, const Closing& closing, int k, cv::Mat1b& texels) {
    const auto fill = [&](std::int32_t from, std::int32_t to, std::int32_t step) {
        for (std::int32_t cell = from + step; cell < to; cell += step) texelOf(grid, cell, k, texels) = kFilled;
    };
    std::vector<std::int32_t> below(static_cast<std::size_t>(grid.width), -1);  // the last occupied cell of each column
    for (std::size_t i = 0; i < grid.occupied.size(); ++i) {
        const std::int32_t cell = grid.occupied[i];
        const double range = distanceTo(closing.sensors, grid.cellCenter(cell));
        const int reach = closingReach(range, grid.resolution, closing.params);
        const std::int32_t left = i > 0 ? grid.occupied[i - 1] : -1;
        if (left >= 0 && left / grid.width == cell / grid.width && cell - left <= reach) fill(left, cell, 1);
        std::int32_t& lower = below[static_cast<std::size_t>(cell % grid.width)];
        if (lower >= 0 && (cell - lower) / grid.width <= reach) fill(lower, cell, grid.width);
        lower = cell;
    }
    for (const std::int32_t cell : grid.occupied) texelOf(grid, cell, k, texels) = kClosed;
}

void layCarpet(const Carpet& place, const cv::Mat1b& texels, mrpt::opengl::CSetOfTexturedTriangles& carpet) {
    layTriangles(place, texels, carpet);
    // row 0 is the grid's lowest row; blue, green, red
    mrpt::img::CImage color(static_cast<unsigned>(texels.cols), static_cast<unsigned>(texels.rows), mrpt::img::CH_RGB);
    mrpt::img::CImage alpha(static_cast<unsigned>(texels.cols), static_cast<unsigned>(texels.rows), mrpt::img::CH_GRAY);
    for (int row = 0; row < texels.rows; ++row) {
        auto* pixel = color.ptrLine<std::uint8_t>(static_cast<unsigned>(row));
        auto* opacity = alpha.ptrLine<std::uint8_t>(static_cast<unsigned>(row));
        for (int col = 0; col < texels.cols; ++col, pixel += 3) {
            const mrpt::img::TColor& c = kColors[texels(row, col)];
            pixel[0] = c.B;
            pixel[1] = c.G;
            pixel[2] = c.R;
            opacity[col] = c.A;
        }
    }
    carpet.assignImage(std::move(color), std::move(alpha));
    carpet.enableLight(false);
}

void layCells(const Carpet& place, const cv::Mat1b& texels, mrpt::opengl::CSetOfTriangles& cells) {
    const int tile = tileOf(place.grid);
    cv::Mat1b left = texels.clone();  // to be laid
    std::vector<mrpt::opengl::TTriangle> triangles;
    const auto lay = [&](const cv::Rect& r) {
        const auto a = cornerAt(place, r.x, r.y), b = cornerAt(place, r.x + r.width, r.y);
        const auto c = cornerAt(place, r.x + r.width, r.y + r.height), d = cornerAt(place, r.x, r.y + r.height);
        for (auto triangle : {mrpt::opengl::TTriangle(a, b, c), mrpt::opengl::TTriangle(a, c, d)}) {
            triangle.setColor(kColors[left(r.tl())]);
            triangles.push_back(triangle);
        }
        left(r) = kNothing;
    };
    for (int row = 0; row < left.rows; ++row) {
        for (int col = 0; col < left.cols; ++col) {
            if (left(row, col) == kNothing) continue;
            const cv::Point end(std::min((col / tile + 1) * tile, left.cols),
                                std::min((row / tile + 1) * tile, left.rows));
            lay(rectangleOf(left, {col, row}, end));
        }
    }
    cells.clearTriangles();
    cells.insertTriangles(triangles.begin(), triangles.end());
}

}  // namespace lidar_obstacles
