// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Polygons seen from above: inside, apart, how far. Metres.
#pragma once

#include <Eigen/Geometry>
#include <boost/geometry.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/geometries/polygon.hpp>
#include <boost/geometry/geometries/segment.hpp>

#include "lidar_obstacles/types.h"
#include "lidar_obstacles/zones.h"

namespace lidar_obstacles {

using ZonePoint = boost::geometry::model::d2::point_xy<double>;
using ZoneSegment = boost::geometry::model::segment<ZonePoint>;
using ZonePolygon = boost::geometry::model::polygon<ZonePoint>;

/// An outline as a polygon, closed and the right way round.
ZonePolygon toPolygon(const Outline& outline);
/// The outline as another frame has it.
Outline moved(const Outline& outline, const Eigen::Isometry2d& T);
/// The four corners of a box.
Outline cornersOf(const OrientedBox& box);

/// 0 where they meet.
inline double distance(const ZonePolygon& polygon, const ZonePolygon& other) {
    return boost::geometry::distance(polygon, other);
}
/// 0 for a point inside.
inline double distance(const ZonePolygon& polygon, const Eigen::Vector2d& p) {
    return boost::geometry::distance(ZonePoint(p.x(), p.y()), polygon);
}
/// 0 where they meet.
inline double distance(const ZonePolygon& polygon, const ZoneSegment& segment) {
    return boost::geometry::distance(segment, polygon);
}

/// What of three dimensions is left seen from above: the place, and the turn of the x axis.
Eigen::Isometry2d seenFromAbove(const Eigen::Isometry3d& T);

}  // namespace lidar_obstacles
