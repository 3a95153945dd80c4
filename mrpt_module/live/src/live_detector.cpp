// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/live/live_detector.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "lidar_obstacles/joined_cloud.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles::live {
namespace {

constexpr std::size_t kMaxPoses = 4096;
constexpr double kAhead = 1.0;  // a scan is processed within that, and poses are not of the future [s]

std::string reasonOf(PoseFound pose) {
    switch (pose) {
        case PoseFound::NoPoses:
            return "no poses are known";
        case PoseFound::Outside:
            return "no pose near a scan's time is known";
        case PoseFound::Gap:
            return "the poses have a gap";
        case PoseFound::Jump:
            return "the poses jump";
        default:
            return "the poses tell the rotation only";
    }
}

}  // namespace

LiveDetector::LiveDetector(const DetectorParams& params)
    : COutputLogger("LiveDetector"), params_(params), detector_(params) {
    logging_enable_console_output = false;
}

void LiveDetector::addPose(const StampedPose& pose) {
    validate(pose);
    const std::lock_guard lock(mutex_);
    poses_.push_back(pose);
    if (poses_.size() > kMaxPoses) poses_.pop_front();
}

void LiveDetector::fetchPoses(double scan_time) {
    std::deque<StampedPose> poses;
    {
        const std::lock_guard lock(mutex_);
        poses.swap(poses_);
    }
    for (const StampedPose& pose : poses) {
        if (pose.time <= scan_time + kAhead)
            detector_.addPose(pose);
        else
            tell("poses are stamped more than 1 s after the scan and left out: are their clocks the same?");
    }
}

PointCloud LiveDetector::decode(const LiveScan& scan) const { return toPointCloud(*scan.observation, params_.sensor); }

JoinedDecode LiveDetector::decode(const std::vector<LiveScan>& scans) const {
    JoinedDecode decoded;
    std::vector<PointCloud> clouds;
    clouds.reserve(scans.size());
    for (const LiveScan& scan : scans) {
        try {
            clouds.push_back(decode(scan));
        } catch (const std::runtime_error& e) {
            decoded.undecodable.emplace_back(e.what());
        }
    }
    if (!clouds.empty()) decoded.cloud = joinedCloud(std::move(clouds));
    return decoded;
}

SequenceResult LiveDetector::process(PointCloud cloud, double delay) {
    // poses of before the clock was put back would stand ahead of all that come
    const bool backwards = last_time_ && cloud.timestamp < *last_time_;
    if (backwards) detector_.restart();
    last_time_ = cloud.timestamp;
    fetchPoses(cloud.timestamp);
    SequenceResult found = detector_.process(std::move(cloud), delay);
    found.restarted = found.restarted || backwards;
    noticeMissingPose(found);
    return found;
}

void LiveDetector::tell(const std::string& text) {
    if (!text.empty() && told_.insert(text).second) logStr(mrpt::system::LVL_WARN, text);
}

void LiveDetector::noticeMissingPose(const SequenceResult& found) {
    if (found.match) {
        tell(notMatched(found.match->state, params_));
        return;
    }
    const bool known = found.pose == PoseFound::At || found.pose == PoseFound::Extrapolated;
    if (!known || detector_.trajectory().rotationOnly()) tell(doneWithout(found.pose, params_));
    if (known && found.deskewing == Deskewing::NoMotion)
        tell("the poses do not tell the motion during a whole scan (" + std::string(toString(found.deskew_poses)) +
             "): it is not de-skewed");
}

std::string notMatched(MatchState state, const DetectorParams& params) {
    if (state == MatchState::Bridged)
        return "the surfaces around do not tell how far the vehicle goes along them: it is taken to go on as before, "
               "for " +
               std::to_string(params.ego.max_gap).substr(0, 4) + " s at most";
    if (state != MatchState::Lost) return "";
    const std::string without = doneWithout(PoseFound::Outside, params);
    return "a scan cannot be matched with those before" + without.substr(std::min(without.find(':'), without.size()));
}

std::string doneWithout(PoseFound pose, const DetectorParams& params) {
    const bool turns = pose == PoseFound::At || pose == PoseFound::Extrapolated;
    std::string text;
    const auto add = [&text](bool wanted, const char* what) {
        if (wanted) text += (text.empty() ? "" : ", ") + std::string(what);
    };
    add(!turns && (params.deskew.enabled || params.grid.scans > 1), "scans are not de-skewed");
    add(params.grid.scans > 1, "a grid holds one scan");
    add(params.octomap.mode == FilterMode::Static, "the map of what stands still is not used");
    add(params.octomap.mode == FilterMode::Spurious, "the 3D filter looks at each scan alone");
    add(params.tracking.enabled, "tracks have no velocities");
    return text.empty() ? text : reasonOf(pose) + ": " + text;
}

}  // namespace lidar_obstacles::live
