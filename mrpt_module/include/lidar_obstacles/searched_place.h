// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where obstacles are looked for: the rectangle of the region, an outline in it, and what is left out of both.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/params.h"

namespace lidar_obstacles {

/// Directions that are not searched, at any distance from the origin of the vehicle frame.
struct Sector {
    double from_deg = 0.0;  ///< azimuths counter-clockwise from ahead: the first belongs to it [deg]
    double to_deg = 0.0;    ///< ... the last does not [deg]
};

/// Places that are left out, written as `region.excluded`: the parts of an own body (own_body.h), and
///
///     sector(150, 210)                                  azimuths from, to: behind the vehicle
///
/// or several of both in a row; `none`.
struct ExcludedPlaces {
    ExcludedPlaces() = default;
    /// @throws std::invalid_argument naming the part that is not right and what was expected.
    explicit ExcludedPlaces(const std::string& text);

    OwnBody parts;
    std::vector<Sector> sectors;
};

/// The text that reads back as the same places: parts first; "none" where there are none.
std::string toText(const ExcludedPlaces& places);

/// The outline that is searched. @param text  of `region.outline`, as that of an own body; `none`: all of the
/// rectangle.
/// @throws std::invalid_argument naming the part that is not right.
OwnBody searchedOutline(const std::string& text);

/// What is searched of the vehicle frame: the rectangle (`region.front`, `rear`, `lateral`), of it what lies in
/// `region.outline` where there is one, without `region.excluded`. Its const members may be called by several threads.
class SearchedPlace {
  public:
    /// @throws std::invalid_argument if the outline or the excluded places are not right.
    explicit SearchedPlace(const RegionParams& params);

    /// Is a point of the vehicle frame searched? The rear and right sides belong to the rectangle, the others do not.
    bool holds(const Eigen::Vector3f& p) const {
        return p.x() < front_ && p.x() >= rear_ && p.y() < side_ && p.y() >= -side_ && (whole_ || holdsCut(p));
    }
    /// Do the outline or the excluded places leave it out, wherever the rectangle ends?
    bool leavesOut(const Eigen::Vector3f& p) const { return !whole_ && !holdsCut(p); }

  private:
    struct Wedge {
        Eigen::Vector2d from, to;  ///< unit length
        bool wide = false;         ///< more than half a turn
        bool holds(const Eigen::Vector2d& p) const;
    };
    bool holdsCut(const Eigen::Vector3f& p) const;

    float front_, rear_, side_;
    OwnBody outline_;   ///< empty: all of the rectangle
    OwnBody excluded_;  ///< without sectors
    std::vector<Wedge> wedges_;
    bool whole_ = true;  ///< nothing is cut off the rectangle
};

/// Where returns may be those of obstacles: what is searched, without the own vehicle. Its const members may be called
/// by several threads.
class PlaceOfObstacles {
  public:
    /// @throws std::invalid_argument if the outline, the excluded places or the own body are not right.
    explicit PlaceOfObstacles(const RegionParams& params);

    bool holds(const Eigen::Vector3f& p) const { return searched_.holds(p) && !own_.holds(p); }

  private:
    SearchedPlace searched_;
    OwnBody own_;
};

}  // namespace lidar_obstacles
