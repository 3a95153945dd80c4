/// @file
/// The vehicle's poses of a whole file, for scans that are asked for in any order.
#pragma once

#include <atomic>
#include <condition_variable>
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
    /// @throws std::runtime_error naming the file if it cannot be opened.
    PoseIndex(const std::string& path, EgoSource source);
    ~PoseIndex();
    PoseIndex(const PoseIndex&) = delete;
    PoseIndex& operator=(const PoseIndex&) = delete;

    /// The poses that a scan at `time` [s] is to be seen with: one beyond its end, as PoseFeed reads ahead, all those
    /// since `from`, and the last one before. Waits until the file has been read that far.
    std::vector<StampedPose> around(double from, double time) const;
    /// True when the file has been read through: what around() gives does not change any more.
    bool complete() const { return complete_; }
    /// Poses that are not finite, so far: they are left out.
    std::size_t refused() const { return refused_; }
    const EgoSource& source() const { return ego_.source(); }

  private:
    void readThrough();
    std::optional<StampedPose> poseOf(const SourceItem& item);
    void add(const SourceItem& item);

    std::unique_ptr<ScanSource> file_;
    EgoMotion ego_;
    mutable std::mutex mutex_;
    mutable std::condition_variable grown_;
    std::vector<StampedPose> poses_;  ///< stamps rise; of equal ones the first read stands first
    double last_item_ = -1e300;       ///< latest stamp of an observation [s]
    std::atomic<std::size_t> refused_{0};
    std::atomic<bool> complete_{false};
    std::atomic<bool> stop_{false};
    std::thread thread_;
};

}  // namespace lidar_obstacles::apps
