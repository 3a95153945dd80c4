// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What comes out: boxes with a class, a heading and, where they are followed, a motion.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lidar_obstacles {

/// What an obstacle is. `Structure` stands and is no road user: walls, vegetation, poles, rails. `Unknown` is compact,
/// but not to be told.
enum class ObstacleClass : std::uint8_t { Unknown, Vehicle, Pedestrian, Cyclist, Structure };

/// How probable it is that an object is of each class; sums to 1. Places are those of ObstacleClass.
using ClassProbabilities = std::array<float, 5>;

/// Upright box: `size` = (length along yaw, width, height); length >= width where there is no heading.
struct OrientedBox {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    Eigen::Vector3d size = Eigen::Vector3d::Zero();
    double yaw = 0.0;
};

/// Corners of a box seen from above, counter-clockwise from its front left one [m].
std::array<Eigen::Vector2d, 4> cornersFromAbove(const OrientedBox& box);

/// What gave an obstacle its heading.
enum class HeadingRule : std::uint8_t {
    None,      ///< too small or too few returns
    Plane,     ///< vertical plane(s) through its returns (Sec. III)
    TwoSides,  ///< triangle A, B, C of the convex hull of its cells (Sec. IV)
    Line       ///< RANSAC line through its cells (Sec. IV)
};

/// Faces of a box, as bits.
enum Face : std::uint8_t { kFront = 1, kBack = 2, kLeft = 4, kRight = 8 };

/// What a tracker knows of an obstacle beyond this scan (tracking.h).
struct TrackState {
    double age = 0.0;  ///< since the track began, up to its last sight [s]; 0: seen once, or not yet sure
    bool seen = true;  ///< false: predicted, no box of this scan belongs to it
    std::optional<Eigen::Vector2d> velocity;  ///< over ground, vehicle axes [m/s]; not set where it is not known
    Eigen::Vector2d velocity_std = Eigen::Vector2d::Zero();  ///< [m/s]
    Eigen::Vector2d center_std = Eigen::Vector2d::Zero();    ///< of the box's centre, vehicle axes [m]
    double yaw_std = 0.0;                                    ///< [rad]
    bool moving = false;
    bool direction_known = false;  ///< true: `yaw` is where its front points; false: modulo 180 degrees
    double time_offset = 0.0;      ///< the box is as of this long after the scan's timestamp [s]
};

struct Obstacle {
    int id = 0;
    ObstacleClass cls = ObstacleClass::Unknown;
    ClassProbabilities probability{};  ///< of the classes; all zero where they were told by size
    OrientedBox box;
    OrientedBox seen_box;        ///< without what completion added
    bool heading_valid = false;  ///< false: `box.yaw` only says how the box is drawn
    double heading_std = 0.0;    ///< standard deviation of the heading from the face fit [rad]; 0 if not valid
    int num_points = 0;
    int num_rings = 0;                     ///< rings that hit it; 0 where the source has no rings
    double max_height = 0.0;               ///< box.size.z() is what was hit; it may be as high as this [m]
    HeadingRule rule = HeadingRule::None;  ///< what gave the heading
    std::uint8_t faces = 0;                ///< Face bits: those with returns on them
    std::vector<Eigen::Vector2d> hull;     ///< convex hull of its cells [m], where one was made
    std::vector<Eigen::Vector2d> marks;    ///< TwoSides: A, B, C, D; Line, Plane: both ends of it [m]
    std::vector<std::int32_t> points;      ///< its returns (indices into the cloud)
    std::optional<TrackState> track;       ///< set by a tracker; `id` is the track's then
};

/// "vehicle", "pedestrian", "cyclist", "structure" or "unknown".
const char* toString(ObstacleClass c);
/// "none", "plane", "two_sides" or "line".
const char* toString(HeadingRule r);
/// Letters of the faces: F(ront), B(ack), L(eft), R(ight), in this order; "-" for none.
std::string facesText(std::uint8_t faces);
/// Into [-pi, pi).
double normalizeAngle(double rad);

}  // namespace lidar_obstacles
