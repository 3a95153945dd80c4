// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The vehicle's own motion: poses with time stamps, and the pose at any time between them.
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "lidar_obstacles/params.h"

namespace lidar_obstacles {

/// Where the vehicle frame is at one time, in a world frame that stays the same from pose to pose.
struct StampedPose {
    double time = 0.0;                                                ///< seconds since the epoch
    Eigen::Vector3d position = Eigen::Vector3d::Zero();               ///< [m]
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();  ///< vehicle to world, unit length
    bool rotation_only = false;  ///< the source tells no translation (rates of turn): `position` means nothing
};

/// @throws std::invalid_argument if a number of the pose is not finite or the orientation has no length.
void validate(const StampedPose& pose);

/// What stands behind a pose, or why there is none.
enum class PoseFound : std::uint8_t {
    At,            ///< a pose of exactly that time, or interpolated between two
    Extrapolated,  ///< beyond the last pose, at constant velocity, by `ego.max_extrapolation` at most
    NoPoses,       ///< there are none
    Outside,       ///< before the first pose, or farther beyond the last than the limit
    Gap,           ///< the poses around that time are farther apart than `ego.max_gap`
    Jump           ///< from one pose to the next the vehicle moves faster than it can
};

/// "at", "extrapolated", "no_poses", "outside", "gap" or "jump".
const char* toString(PoseFound found);

struct PoseAt {
    PoseFound found = PoseFound::NoPoses;
    std::optional<Eigen::Isometry3d> T_world_vehicle;  ///< set for At and Extrapolated only
};

/// Poses in the order of their stamps, whatever the order they come in.
///
/// Between two poses the position runs straight and the orientation turns about one axis (SLERP). Never a guess: where
/// the poses do not tell, the answer is the reason, not the identity.
/// Its const members may be called by several threads at a time.
class Trajectory {
  public:
    explicit Trajectory(const EgoParams& params = {}) : params_(params) {}

    /// Adds a pose at its place in time. False if there is one of that stamp already, which stays.
    /// @throws std::invalid_argument if a number of the pose is not finite or the orientation has no length; the
    ///     trajectory is unchanged then.
    bool add(StampedPose pose);

    /// Drops the poses before `time`, but the last two of them (they are needed to interpolate).
    void forgetBefore(double time);

    /// Drops the poses after `time`: of a clock that was set back since.
    void forgetAfter(double time);

    /// The pose at `time`. A jump or a gap between two poses leaves everything between them unknown.
    PoseAt at(double time) const;

    /// True if the vehicle jumped, or its poses were lost, anywhere between the two times: what was remembered at
    /// `from` has no place in the frame at `to`. Time that runs backwards is such a break.
    bool brokenBetween(double from, double to) const;

    /// True if the last pose tells the rotation only.
    bool rotationOnly() const { return !poses_.empty() && poses_.back().rotation_only; }
    bool empty() const { return poses_.empty(); }
    std::size_t size() const { return poses_.size(); }

  private:
    std::optional<PoseFound> broken(const StampedPose& a, const StampedPose& b) const;
    PoseAt extrapolate(double time) const;

    EgoParams params_;
    std::vector<StampedPose> poses_;  ///< stamps rise
};

}  // namespace lidar_obstacles
