// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A box as a track sees it: its edges along the track's axes, and what they measure.
#pragma once

#include <Eigen/Core>
#include <array>

#include "lidar_obstacles/tracking.h"
#include "sequence/track_filter.h"
#include "sequence/track_shape.h"

namespace lidar_obstacles {

/// A box on the ground plane, world frame.
struct FlatBox {
    Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< [m]
    Eigen::Vector2d half = Eigen::Vector2d::Zero();    ///< half of length and width [m]
    double yaw = 0.0;

    Eigen::Vector2d axis(std::size_t face) const;  ///< outward normal of a face (numbers as in track_shape.h)
    std::array<Eigen::Vector2d, 4> corners() const;
    double area() const { return 4.0 * half.x() * half.y(); }
};

/// What is worked out once for each box of a scan; world frame.
struct PlacedBox {
    FlatBox whole;  ///< completed
    FlatBox seen;   ///< what was hit
    std::array<EdgeGrade, kFaces> grade{};
    double bottom = 0.0;      ///< [m]
    double height = 0.0;      ///< [m]
    double range = 0.0;       ///< from the sensor to its nearest point [m]
    double bearing = 0.0;     ///< of its centre from the sensor [rad]
    double half_angle = 0.0;  ///< half the angle it covers there [rad]
    Eigen::Vector2d sensor = Eigen::Vector2d::Zero();
    double heading_std = 0.0;    ///< [rad]; 0: no heading
    double depth_std = 0.0;      ///< how far along the sight what was hit may slide over the body [m]
    double quality = 1.0;        ///< of the view, 0 .. 1
    std::array<bool, 2> ends{};  ///< of its track's axes: beams went where the body was believed to go on
    const SeenBox* source = nullptr;
};

/// @param sensor  vehicle frame [m]
PlacedBox placeBox(const SeenBox& box, const Eigen::Vector2d& sensor, const TrackingParams& params);

/// Sets `range`, `bearing` and `half_angle` of `whole` as seen from `sensor`.
void lookAt(PlacedBox& box);

/// The edges of a box along the axes nearest to a track's.
struct BoxView {
    std::array<double, kFaces> edge{};     ///< from the body's point along the outward normals [m]
    std::array<double, kFaces> tangent{};  ///< where along that face the middle of what was seen lies [m]
    std::array<EdgeGrade, kFaces> grade{};
    std::array<Eigen::Vector2d, kFaces> normal{};
    bool heading = false;   ///< the box has one
    bool yaw_fits = false;  ///< it is the track's, but for quarter turns and noise
    int quarters = 0;       ///< that the track's yaw is ahead of the box's, about
    double yaw_innovation = 0.0;
    std::array<bool, 2> ends{};  ///< as PlacedBox::ends
};

BoxView viewOf(const PlacedBox& box, const Eigen::Vector2d& position, double yaw);

/// What the errors of a view are.
struct ViewNoise {
    double face_std = 0.05;                              ///< next to the sensor [m]
    double face_std_per_metre = 0.0;                     ///< [m/m]
    Eigen::Matrix2d position = Eigen::Matrix2d::Zero();  ///< covariance of where the body is expected [m2]
};

/// What a view measures of a body of that shape: where its faces are, one number per axis, and its yaw.
Measurements measure(const BoxView& view, const BodyShape& shape, const PlacedBox& box, const ViewNoise& noise);

/// Adds a view to the shape, told from where the body's point is now; with `begin` it is the first.
void learnShape(BodyShape& shape, const BoxView& view, double quality, bool begin = false);

}  // namespace lidar_obstacles
