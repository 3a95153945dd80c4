// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The vehicle's own body as the sensor sees it: returns on it are no obstacles.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

namespace lidar_obstacles {

/// A part of the body: an outline seen from above, over a range of heights. Vehicle frame [m].
struct OwnPart {
    std::vector<Eigen::Vector2d> outline;  ///< corners, at least three; convex or not, either way round
    bool is_box = false;                   ///< four corners along the axes, the first is the lowest in x and y
    double z_min = -std::numeric_limits<double>::infinity();
    double z_max = std::numeric_limits<double>::infinity();
};

/// Parts of the body, written as `region.own_body`:
///
///     none
///     box(-1.2, 3.1, -0.9, 0.9)                         x from, to, y from, to: at any height
///     box(-1.2, 3.1, -0.9, 0.9, -0.5, 1.4)              z from, to as well
///     polygon(3.1 -0.6, 3.1 0.6, -1.2 0.9, -1.2 -0.9)   x y of each corner: at any height
///
/// and several of them in a row. Commas and blanks between numbers mean the same.
/// Its const members may be called by several threads at a time.
class OwnBody {
  public:
    OwnBody() = default;
    /// @throws std::invalid_argument naming the part that is not right.
    explicit OwnBody(const std::string& text);
    explicit OwnBody(std::vector<OwnPart> parts);

    /// True if a point of the vehicle frame lies in a part; the lower bounds belong to it, the upper ones do not.
    bool holds(const Eigen::Vector3f& p) const {
        return all_.hold(p) && inAPart(p);  // nearly all returns of a scan are outside of all of them
    }
    const std::vector<OwnPart>& parts() const { return parts_; }
    bool empty() const { return parts_.empty(); }

  private:
    struct Bounds {
        Eigen::Vector3f low, high;

        bool hold(const Eigen::Vector3f& p) const {
            return p.x() >= low.x() && p.x() < high.x() && p.y() >= low.y() && p.y() < high.y() && p.z() >= low.z() &&
                   p.z() < high.z();
        }
    };
    static Bounds boundsOf(const OwnPart& part);
    bool inAPart(const Eigen::Vector3f& p) const;

    std::vector<OwnPart> parts_;
    std::vector<Bounds> bounds_;                                                     ///< of each part
    Bounds all_{Eigen::Vector3f::Constant(1.0f), Eigen::Vector3f::Constant(-1.0f)};  ///< of all of them
};

/// The text that reads back as the same body; "none" for an empty one.
std::string toText(const OwnBody& body);

}  // namespace lidar_obstacles
