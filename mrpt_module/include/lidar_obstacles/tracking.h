// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Tracks: which box of this scan is which of the last, how fast it goes, where its front is, how large it really is.
///
/// Works on boxes of any detector. World frame: any frame fixed to the ground, z up; where the vehicle's poses are not
/// known, the vehicle frame takes its place and no velocity is told.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What a label and its probability say of all classes: what else it may be nobody said, so it is as likely one of the
/// other classes as none of them.
ClassProbabilities classesOfLabel(ObstacleClass label, double probability);

/// One box of a scan with the evidence behind it.
struct SeenBox {
    OrientedBox box;         ///< vehicle frame [m], sizes above 0
    OrientedBox seen_box;    ///< without what was added to complete it; `box` where nothing was
    std::uint8_t faces = 0;  ///< Face bits: those with returns on them; 0: not told
    bool heading_valid = false;
    double heading_std = 0.0;  ///< [rad]; 0: not told
    int num_points = 0;        ///< returns
    int num_rings = 0;         ///< that hit it; 0: not told
    ClassProbabilities classes{};
    double time = 0.0;  ///< when the laser saw it [s]
    /// Of the frame the box is in, at that time; the identity where there are no poses.
    Eigen::Isometry3d T_world_vehicle = Eigen::Isometry3d::Identity();
    std::optional<Eigen::Vector2d> sensor;  ///< of several, where the one is that saw it, vehicle frame [m]
};

/// The evidence of a detector's obstacle. Where its classes were told by size alone (`probability` all zero) its label
/// is taken for right more often than not: the scans that follow decide.
SeenBox seenBox(const Obstacle& obstacle, double time, const Eigen::Isometry3d& T_world_vehicle);

/// The vehicle's pose in the world at a time [s].
using PoseAtTime = std::function<Eigen::Isometry3d(double)>;

/// One scan, as a tracker wants it.
struct TrackingScan {
    double time = 0.0;  ///< the scan's timestamp [s]
    std::vector<SeenBox> boxes;
    Eigen::Isometry3d T_world_vehicle = Eigen::Isometry3d::Identity();  ///< at `time`
    bool poses_known = true;  ///< false: T_world_vehicle is no pose, velocities are relative and not told
    Eigen::Vector2d sensor = Eigen::Vector2d::Zero();  ///< where the rays start, vehicle frame [m]; of several: between
    /// The instant that boxes are told for [s], and the vehicle's pose then. Not set: each as of when it was seen,
    /// hidden ones as of `time`.
    std::optional<double> told_for;
    Eigen::Isometry3d T_world_told = Eigen::Isometry3d::Identity();
    /// One label per return of the cloud: not 0 for structure, which is in no box. Empty: nobody said.
    std::vector<std::uint8_t> is_structure;
    /// The vehicle's pose when the laser saw a return; empty: all returns are told in the frame of `time`.
    PoseAtTime pose_at;
    const PointCloud* cloud = nullptr;  ///< vehicle frame; tells where a beam should have hit a track that no box fits
};

/// One row of what is known after a scan.
struct TrackedBox {
    int id = 0;       ///< of the track, never used again
    int source = -1;  ///< which of the scan's boxes it took in; -1: none, it is predicted
    ObstacleClass cls = ObstacleClass::Unknown;
    ClassProbabilities classes{};
    OrientedBox box;  ///< vehicle frame of the time it is told for
    bool heading_valid = false;
    TrackState state;
};

/// A row as an obstacle: its box of this scan with what is known of the track in the place of what the scan alone told.
/// @param boxes  the scan's; those that rows name are moved out of it.
std::vector<Obstacle> trackedObstacles(const std::vector<TrackedBox>& rows, std::vector<Obstacle>& boxes);

/// Follows boxes from scan to scan.
///
/// Deterministic; takes no memory from the heap once it has seen as many boxes and tracks as there will be. What it
/// does, in this order: predict (standing, straight and turning as an interacting multiple model), associate (one cost,
/// optimal assignment), update by what was seen (faces, not centres), keep sizes, class, direction and existence as
/// beliefs of their own.
/// An object is for one thread at a time.
class Tracker {
  public:
    explicit Tracker(const TrackingParams& params);
    ~Tracker();
    Tracker(Tracker&&) noexcept;
    Tracker& operator=(Tracker&&) noexcept;

    /// Takes in one scan. Time that does not rise, a gap longer than `max_gap`, and poses that come or go, end
    /// all tracks.
    /// @return one row per box that is not part of a larger track (in the order of `scan.boxes`), then the hidden
    ///     tracks that are still believed in; valid until the next call.
    /// @throws std::invalid_argument if a number is not finite, a size not above 0, a place or size beyond 1e8 m, or a
    ///     box seen more than 10 s from the time of its scan; nothing is changed then.
    const std::vector<TrackedBox>& update(const TrackingScan& scan);

    /// Where the road users that are followed should be in a scan at `time` [s], as its laser sees them; empty where
    /// update() would begin anew. Valid until the next call.
    /// @param T_world_vehicle  the vehicle's pose at a time; the frame of the boxes. Identity where there are no poses.
    const std::vector<ExpectedObject>& expected(double time, bool poses_known, const PoseAtTime& T_world_vehicle);

    /// Ends all tracks (another place of a recording, poses that jumped); their numbers are not used again.
    void forget();

    std::size_t size() const;  ///< tracks that are followed, hidden ones with them

  private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

}  // namespace lidar_obstacles
