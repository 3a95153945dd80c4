// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The detector for a sequence of scans: what needs memory from one scan to the next, around the pipelines.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "lidar_obstacles/deskew.h"
#include "lidar_obstacles/low_memory.h"
#include "lidar_obstacles/motion.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/pipelines.h"
#include "lidar_obstacles/scan_matching.h"
#include "lidar_obstacles/static_map.h"
#include "lidar_obstacles/tracking.h"
#include "lidar_obstacles/types.h"
#include "lidar_obstacles/voxel_filter.h"

namespace lidar_obstacles {

/// With tracks, the number (Obstacle::id) of the first box of a scan that is not followed; the next ones count on:
/// pieces of structure, and what fewer than `gates.min_points` returns hit. They take no numbers of tracks.
constexpr int kFirstUntrackedId = 1000000000;

/// One scan of a sequence and what was found in it.
struct SequenceResult {
    PointCloud cloud;  ///< what was searched: de-skewed where that was done
    /// With tracking on, `obstacles` are tracks (Obstacle::track is set): those seen in this scan, then the hidden
    /// ones.
    DetectionResult detection;
    bool tracked = false;
    PoseFound pose = PoseFound::NoPoses;  ///< of the vehicle at the scan's timestamp
    std::optional<ScanMatch> match;       ///< how its pose was found; set with `[ego] source = matching`
    std::optional<Deskewing> deskewing;   ///< not set where the boxes do not ask for it
    PoseFound deskew_poses = PoseFound::NoPoses;
    bool mended = false;            ///< a surface that the seam tore apart was put together
    bool filtered = false;          ///< the 3D filter was asked
    std::size_t filter_voxels = 0;  ///< that it holds; 0 without a pose, when it looks at this scan alone
    std::size_t earlier_scans = 0;  ///< in the grid beside this one
    bool restarted = false;         ///< poses jumped or were lost: what was remembered is forgotten
};

/// True if something would use poses: de-skewing, the 3D filter, a grid of several scans, tracks; the clouds of several
/// lidars (joinedCloud()), which do not look at a place at the same time.
bool usesPoses(const DetectorParams& params, bool several_lidars = false);

/// How many scans before one decide, together with the poses, what is found in it: 0 where each stands for itself.
/// Tracks remember more, but after so many their velocities, sizes and classes are settled.
std::size_t scansRemembered(const DetectorParams& params);

/// toPointCloud -> [deskew] -> ground -> region -> [3D filter] -> grid of [several scans] -> boxes -> [tracks].
///
/// With the defaults, but `tracking.enabled` off, `process(cloud).detection` is `detect(cloud, params)`, but for a
/// surface that the scan's seam tore apart (`deskew.mend_seam`). Where poses are missing
/// it does with less and says so: no de-skewing, `spurious` by neighbours of the same scan alone, no `static`, this
/// scan's grid, tracks in the vehicle frame without velocities. Nothing is assumed of the motion: for a vehicle that
/// stands still, add the same pose again and again. With `[ego] source = matching` the poses are made of the scans
/// themselves (ScanMatcher), and none is to be added.
///
/// An object is for one thread at a time; objects share nothing that changes. live::LiveDetector takes poses from any.
class ObstacleDetector {
  public:
    /// @throws std::invalid_argument if a parameter is out of range; std::runtime_error if the map cannot be read.
    explicit ObstacleDetector(const DetectorParams& params);

    /// The vehicle's pose; in any order, best before the scans it belongs to and one beyond the end of each.
    /// @return false if there is one of that stamp already, which stays, or if poses are made of the scans.
    /// @throws std::invalid_argument if a number is not finite; nothing is changed then.
    bool addPose(const StampedPose& pose) { return !matcher_ && trajectory_.add(pose); }

    /// The next scan; vehicle frame, time stamps rising.
    /// @param delay  how long after the scan's last return the boxes are given out [s], for `tracking.stamp = now`.
    /// @throws as detect(), and as Tracker::update() where times of returns are not of the scan or a pose is not of
    /// this world.
    SequenceResult process(PointCloud cloud, double delay = 0.0);

    /// Forgets scans and poses, for another place of a recording. Parameters and a loaded map stay.
    void restart();

    const Trajectory& trajectory() const { return trajectory_; }
    /// Centres of the voxels by which the 3D filter keeps or drops returns, in the frame of the last scan [m].
    std::vector<Eigen::Vector3f> filterVoxels() const;
    double filterResolution() const;  ///< edge of those voxels [m]

  private:
    void matchScan(const PointCloud& cloud, SequenceResult& r);
    void learnScan(SequenceResult& r);
    std::optional<Eigen::Isometry3d> locate(const PointCloud& cloud, SequenceResult& r);
    PointCloud straighten(PointCloud& cloud, SequenceResult& r);
    CandidateFilter filterOf(const PointCloud& in_place, const std::optional<Eigen::Isometry3d>& T_world_vehicle);
    EarlierScans recall(const std::optional<Eigen::Isometry3d>& T_world_vehicle, SequenceResult& r);
    void dropRemains(SequenceResult& r, const PointCloud& in_place, const Eigen::Isometry3d& T_world_vehicle);
    void forgetScans();
    void remember(const SequenceResult& r, const std::optional<Eigen::Isometry3d>& T_world_vehicle);
    void track(SequenceResult& r, const std::optional<Eigen::Isometry3d>& T_world_vehicle, double now);
    const std::vector<ExpectedObject>& expectedIn(const SequenceResult& r,
                                                  const std::optional<Eigen::Isometry3d>& T_world_vehicle);
    PoseAtTime frameOfReturns(const SequenceResult& r, const std::optional<Eigen::Isometry3d>& pose) const;
    SeenBox seenAt(const Obstacle& o, const SequenceResult& r) const;

    DetectorParams params_;
    Trajectory trajectory_;
    std::optional<ScanMatcher> matcher_;
    std::optional<VoxelFilter> voxels_;
    std::optional<StaticMap> map_;
    std::optional<Tracker> tracker_;
    std::optional<LowMemory> low_;                      ///< with tracking, for `tracking.max_hidden`
    TrackingScan tracking_scan_;                        ///< kept for its memory
    double match_ms_ = 0.0;                             ///< that matching this scan took [ms]
    std::deque<std::vector<Eigen::Vector3d>> earlier_;  ///< candidates of the last scans, world frame [m]
    std::optional<double> last_time_;
    std::optional<Eigen::Isometry3d> last_pose_;
};

}  // namespace lidar_obstacles
