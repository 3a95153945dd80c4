// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The vehicle's poses of a whole file, for scans that are asked for in any order.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/ego_motion.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace lidar_obstacles::apps {

/// Reads a file through on a thread of its own and keeps its poses, some 70 bytes each.
class PoseIndex {
  public:
    /// @param source  as `[ego] source` names it. What `auto` means is found out by the thread.
    /// @throws std::runtime_error naming the file if it cannot be opened, std::invalid_argument if it has no such
    /// source.
    PoseIndex(const std::string& path, const std::string& source);
    ~PoseIndex();
    PoseIndex(const PoseIndex&) = delete;
    PoseIndex& operator=(const PoseIndex&) = delete;

    /// The poses that a scan at `time` [s] is to be seen with: one beyond its end, as PoseFeed reads ahead, all those
    /// since `from`, and the last one before. As far as they have been read: never waits.
    std::vector<StampedPose> around(double from, double time) const;
    /// True when the file has been read as far as a scan at `time` [s] needs it.
    bool covers(double time) const;
    /// True when the file has been read through: what around() gives does not change any more.
    bool complete() const { return complete_; }
    /// Poses that are not finite, so far: they are left out.
    std::size_t refused() const { return refused_; }
    /// What the poses are made of; None where there are none, or where it is not known yet.
    EgoSource source() const;

  private:
    void readThrough();
    EgoSource choose();
    std::optional<StampedPose> poseOf(const SourceItem& item, EgoMotion& ego);
    void add(const SourceItem& item, EgoMotion& ego);

    std::string path_;
    std::unique_ptr<ScanSource> file_;
    mutable std::mutex mutex_;         ///< guards what follows
    std::optional<EgoSource> source_;  ///< not set: to be found out
    std::vector<StampedPose> poses_;   ///< stamps rise; of equal ones the first read stands first
    double last_item_ = -1e300;        ///< latest stamp of an observation [s]
    std::atomic<std::size_t> refused_{0};
    std::atomic<bool> complete_{false};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace lidar_obstacles::apps
