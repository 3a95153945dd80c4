// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/output/region_lines.h"

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/searched_place.h"
#include "mrpt_bridge/output/zone_lines.h"

namespace lidar_obstacles {
namespace {

/// Where a direction leaves the rectangle of the region.
Eigen::Vector2d onRectangle(double azimuth_deg, const RegionParams& region) {
    const double azimuth = azimuth_deg * M_PI / 180.0;
    const Eigen::Vector2d way(std::cos(azimuth), std::sin(azimuth));
    const double along = (way.x() > 0.0 ? region.front : region.rear) / std::max(std::abs(way.x()), 1e-9);
    return std::min(along, region.lateral / std::max(std::abs(way.y()), 1e-9)) * way;
}

/// The triangle-like outline of a sector: origin, and its end on the rectangle by steps of a few degrees.
Outline outlineOf(const Sector& sector, const RegionParams& region) {
    constexpr double kStep_deg = 2.0;
    const double turn = std::fmod(sector.to_deg - sector.from_deg + 720.0, 360.0);
    const int steps = static_cast<int>(std::ceil(turn / kStep_deg));
    Outline outline{Eigen::Vector2d::Zero()};
    for (int k = 0; k <= steps; ++k) outline.push_back(onRectangle(sector.from_deg + turn * k / steps, region));
    return outline;
}

}  // namespace

void drawSearched(const RegionParams& region, const GroundModel& ground, mrpt::opengl::CSetOfLines& lines) {
    const OwnBody outline = searchedOutline(region.outline);
    for (const OwnPart& part : outline.parts()) drawOutline(part.outline, ground, lines);
    if (!outline.empty()) return;
    const RegionParams& r = region;
    drawOutline({{-r.rear, -r.lateral}, {r.front, -r.lateral}, {r.front, r.lateral}, {-r.rear, r.lateral}}, ground,
                lines);
}

void drawExcluded(const RegionParams& region, const GroundModel& ground, mrpt::opengl::CSetOfLines& lines) {
    const ExcludedPlaces places(region.excluded);
    for (const OwnPart& part : places.parts.parts()) drawOutline(part.outline, ground, lines);
    for (const Sector& sector : places.sectors) drawOutline(outlineOf(sector, region), ground, lines);
}

}  // namespace lidar_obstacles
