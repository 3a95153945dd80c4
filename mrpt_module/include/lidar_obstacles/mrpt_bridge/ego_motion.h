// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Poses of the vehicle from what a rawlog holds.
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "lidar_obstacles/motion.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace lidar_obstacles {

/// A pose as MRPT tells it, at `time` [seconds since the epoch].
StampedPose toStampedPose(double time, const mrpt::poses::CPose3D& pose);

/// What poses can be made of; the better ones for motion from scan to scan first.
enum class EgoKind : std::uint8_t {
    Pose,      ///< CObservationRobotPose: the robot's pose as it stands there
    Odometry,  ///< CObservationOdometry: x, y, yaw
    Actions,   ///< odometry increments of the sensory-frame format (CActionRobotMovement2D, 3D); they have no label
    Gps,       ///< CObservationGPS with position and heading (NovAtel INSPVAS; GGA or RMC with VTG or RMC's course)
    Imu,       ///< CObservationIMU with rates of turn, summed up: rotation only
    Matching,  ///< none of the recording: the detector makes them from the scans (scan_matching.h)
    None
};

/// "pose", "odometry", "actions", "gps", "imu", "matching" or "none".
const char* toString(EgoKind kind);

/// True if observations of the recording are read for it.
inline bool isRead(EgoKind kind) { return kind != EgoKind::None && kind != EgoKind::Matching; }

/// One source of poses; the label of Actions is "actions".
struct EgoSource {
    EgoKind kind = EgoKind::None;
    std::string label;

    bool operator<(const EgoSource& o) const { return std::pair(kind, label) < std::pair(o.kind, o.label); }
};

/// How many observations of each source are among the first `max_objects` objects of a file; what stands before a
/// damage counts. @throws std::runtime_error naming the file if it cannot be opened.
std::map<EgoSource, std::size_t> egoSources(const std::string& path, std::size_t max_objects);

/// The source that `[ego] source` names: for `none` None, for `matching` Matching, for `auto` the best kind among the
/// first 400 objects (of one kind the label with the most observations) or None, else that of the label.
/// @throws std::invalid_argument if nothing has that label among the first 4000 objects; the message lists what is
///     there. std::runtime_error if the file cannot be opened.
EgoSource chooseEgoSource(const std::string& path, const std::string& source);

/// Turns the items of one source into poses; world frame: that of the source (Odometry and Actions begin at the
/// origin, Gps is east-north-up around the first position).
/// An object is for one thread at a time.
class EgoMotion {
  public:
    explicit EgoMotion(EgoSource source) : source_(std::move(source)) {}

    /// The pose that an item tells; nullopt where it is none of this source, or tells nothing new. Numbers are taken
    /// as they stand: Trajectory::add refuses what is not finite.
    std::optional<StampedPose> poseOf(const SourceItem& item);
    const EgoSource& source() const { return source_; }

  private:
    std::optional<StampedPose> fromActions(const SourceItem& item);
    std::optional<StampedPose> fromGps(const mrpt::obs::CObservation& observation);
    std::optional<StampedPose> fromImu(const mrpt::obs::CObservation& observation);

    EgoSource source_;
    StampedPose sum_;              ///< Actions, Imu: summed up so far
    bool begun_ = false;           ///< Imu: `sum_` has a time
    bool waits_for_time_ = false;  ///< Actions: without a stamp of its own, takes that of the next observation
    std::optional<Eigen::Vector3d> geodetic_origin_;  ///< Gps: latitude, longitude [rad], height [m]
    double altitude_ = 0.0;                           ///< Gps: of the last fix that told one [m]
    double yaw_ = 0.0;                                ///< Gps: of the last heading [rad]
    double yaw_time_ = -1e300;                        ///< Gps: when that was
};

}  // namespace lidar_obstacles
