/// @file
/// Obstacles of scans as they happen, with poses from whoever knows them.
#pragma once

#include <deque>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/live/scan_stream.h"

namespace lidar_obstacles::live {

/// An ObstacleDetector for the scans of a LiveScanner. A lidar knows no poses: whoever does (odometry, a localisation)
/// gives them to addPose, from any thread, stamped by the clock of this machine as the scans are. Without, the detector
/// does with less, as its description says, and takeReports() tells what.
class LiveDetector {
  public:
    /// @throws as ObstacleDetector.
    explicit LiveDetector(const DetectorParams& params) : params_(params), detector_(params) {}

    /// A pose of the vehicle, best before the scans end that it belongs to: what comes later serves the next one, and
    /// up to `ego.max_extrapolation` is bridged. Never waits for a scan that is being processed; of poses that no scan
    /// comes for, the newest are kept.
    /// @throws std::invalid_argument if a number is not finite.
    void addPose(const StampedPose& pose);

    /// Decodes the next scan and finds its obstacles; from one thread.
    /// @throws std::invalid_argument if the parameters do not fit the sensor, other exceptions if the scan cannot be
    ///     right.
    SequenceResult process(const LiveScan& scan);

    /// What was done without, as poses were missing: one line for each reason, told once.
    std::vector<std::string> takeReports() { return std::exchange(reports_, {}); }
    const ObstacleDetector& detector() const { return detector_; }

  private:
    void fetchPoses();
    void noticeMissingPose(const SequenceResult& found);

    DetectorParams params_;
    ObstacleDetector detector_;
    std::mutex mutex_;
    std::deque<StampedPose> poses_;  ///< since the last scan
    std::set<PoseFound> told_;
    std::vector<std::string> reports_;
};

/// What the detector does without for a scan whose pose is not known, in one line; empty if nothing would use it.
std::string doneWithout(PoseFound pose, const DetectorParams& params);

}  // namespace lidar_obstacles::live
