// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Obstacles of scans as they happen, with poses from whoever knows them.
#pragma once

#include <mrpt/system/COutputLogger.h>

#include <deque>
#include <mutex>
#include <optional>
#include <set>
#include <string>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/live/scan_stream.h"

namespace lidar_obstacles::live {

/// What decoding the scans of several sensors gives.
struct JoinedDecode {
    std::optional<PointCloud> cloud;       ///< none where no scan can be right
    std::vector<std::string> undecodable;  ///< why scans cannot be right, one line each
};

/// An ObstacleDetector for the scans of a LiveScanner. A lidar knows no poses: whoever does (odometry, a localisation)
/// gives them to addPose, from any thread, stamped by the clock of this machine as the scans are. Without, the detector
/// does with less, as its description says.
///
/// What is done without, and poses that are left out, are warnings of its logger "LiveDetector": one line for each
/// reason, told once, on the thread of process(). They go to the callbacks (logRegisterCallback(), before the first
/// scan), and to the console where `logging_enable_console_output` is set to true.
///
/// addPose() may be called from any thread at any time; all else from one thread at a time.
class LiveDetector : public mrpt::system::COutputLogger {
  public:
    /// @throws as ObstacleDetector.
    explicit LiveDetector(const DetectorParams& params);

    /// A pose of the vehicle, best before the scans end that it belongs to: what comes later serves the next one, and
    /// up to `ego.max_extrapolation` is bridged. Never waits for a scan that is being processed; of poses that no scan
    /// comes for, the newest are kept.
    /// @throws std::invalid_argument if a number is not finite.
    void addPose(const StampedPose& pose);

    /// The returns of a scan, vehicle frame [m]; changes nothing.
    /// @throws std::invalid_argument if the parameters do not fit the sensor, std::runtime_error if the scan cannot be
    ///     right.
    PointCloud decode(const LiveScan& scan) const;
    /// The returns of the scans of several sensors as one cloud (joinedCloud()), without those scans that cannot be
    /// right. @param scans  that of the first sensor, which gives the time, in front.
    /// @throws std::invalid_argument if the parameters do not fit a sensor.
    JoinedDecode decode(const std::vector<LiveScan>& scans) const;

    /// Finds the obstacles of the next scan. Poses stamped more than 1 s after the scan are left out:
    /// they are of another clock. Where stamps of scans run backwards, scans and poses before are forgotten.
    /// @param cloud  vehicle frame [m]; an empty one has no obstacles.
    /// @throws std::invalid_argument if the parameters do not fit the sensor. What is thrown here is no fault of the
    ///     scan, and the detector may have taken in half of it: it is not to be used any more.
    /// @param delay  how long after the scan's last return [s], for `tracking.stamp = now`.
    SequenceResult process(PointCloud cloud, double delay = 0.0);
    /// decode() and process(). @throws as these.
    SequenceResult process(const LiveScan& scan) { return process(decode(scan)); }

    const ObstacleDetector& detector() const { return detector_; }

  private:
    void fetchPoses(double scan_time);
    void noticeMissingPose(const SequenceResult& found);
    void tell(const std::string& text);

    DetectorParams params_;
    ObstacleDetector detector_;
    std::optional<double> last_time_;  ///< of a scan [s]
    std::mutex mutex_;
    std::deque<StampedPose> poses_;  ///< since the last scan; guarded by `mutex_`
    std::set<std::string> told_;
};

/// What the detector does without for a scan whose pose is not known, in one line; empty if nothing would use it.
std::string doneWithout(PoseFound pose, const DetectorParams& params);

/// What a scan whose pose was to be made of it (`[ego] source = matching`) could not tell; empty where it did.
std::string notMatched(MatchState state, const DetectorParams& params);

}  // namespace lidar_obstacles::live
