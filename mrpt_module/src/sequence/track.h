// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One object that is followed.
#pragma once

#include "lidar_obstacles/tracking.h"
#include "sequence/track_belief.h"
#include "sequence/track_filter.h"
#include "sequence/track_shape.h"
#include "sequence/track_view.h"

namespace lidar_obstacles {

/// What members of a class can do; cars where it is not known.
MotionNoise motionNoiseOf(ObstacleClass cls);

/// The errors of a view of what moves like that.
ViewNoise viewNoise(const TrackingParams& params, const MotionFilter& motion);

struct Track {
    int id = 0;
    double born = 0.0;         ///< time of its first box [s]
    double time = 0.0;         ///< of `motion` [s]
    double last_seen = 0.0;    ///< [s]
    double last_look = 0.0;    ///< when its class was last told [s]
    double time_offset = 0.0;  ///< when in its scan it was last seen [s]
    Eigen::Vector2d born_at = Eigen::Vector2d::Zero();
    MotionFilter motion;
    BodyShape shape;
    BestViews height;
    double bottom = 0.0;  ///< world frame [m]
    ClassBelief cls;
    DirectionBelief direction;
    double heading_weight = 0.0;  ///< boxes with a heading less those without, -3 .. 3
    double existence = 0.0;       ///< log-odds
    int hits = 0;
    int source = -1;        ///< its box of this scan
    bool absorbed = false;  ///< another track's box covers it in this scan

    /// Begins with a box.
    void begin(int number, const PlacedBox& box);
    /// Its motion at a later time, without changing it.
    MotionFilter predicted(double at) const;
    /// Goes on to the time of a box and takes it in.
    /// @param over_ground  false: nobody knows how the vehicle moves, so how the track moves tells nothing of it.
    void take(const PlacedBox& box, const TrackingParams& params, bool over_ground);
    /// What a scan says of its class, weighed against what earlier ones did.
    void look(const ClassProbabilities& classes, double at, double quality);
    /// Goes on to `at` without one.
    void goOn(double at);
    /// Its box on the ground, as of `position` and `yaw`.
    FlatBox flat(const Eigen::Vector2d& position, double yaw) const;
    bool hasHeading() const { return heading_weight > 0.0; }
    bool confirmed() const { return hits >= 3; }
    double yawStd() const;
    /// It goes, and faster than the error of its speed explains.
    bool moving() const;
    double speedStd() const;  ///< [m/s]

  private:
    void learn(const PlacedBox& box, double wider);
    void learnFromMotion(double dt);
    void proveAxis();
    void turnBy(int quarters, const PlacedBox& box);
};

/// A box in another frame; what is level stays level.
OrientedBox movedBox(OrientedBox box, const Eigen::Isometry3d& T);

/// A box on the ground as high as the track, in the vehicle frame.
OrientedBox uprightOf(const FlatBox& flat, const Track& track, const Eigen::Isometry3d& T_world_vehicle);

/// One row, for the time `at` and the vehicle frame of that time; extrapolated at constant velocity.
TrackedBox rowOf(const Track& track, double at, const Eigen::Isometry3d& T_world_vehicle);

}  // namespace lidar_obstacles
