#include "lidar_obstacles/live/live_detector.h"

#include <utility>

#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles::live {
namespace {

constexpr std::size_t kMaxPoses = 4096;

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

void LiveDetector::addPose(const StampedPose& pose) {
    validate(pose);
    const std::lock_guard lock(mutex_);
    poses_.push_back(pose);
    if (poses_.size() > kMaxPoses) poses_.pop_front();
}

void LiveDetector::fetchPoses() {
    std::deque<StampedPose> poses;
    {
        const std::lock_guard lock(mutex_);
        poses.swap(poses_);
    }
    for (const StampedPose& pose : poses) detector_.addPose(pose);
}

SequenceResult LiveDetector::process(const LiveScan& scan) {
    PointCloud cloud = toPointCloud(*scan.observation, params_.sensor);
    fetchPoses();
    SequenceResult found = detector_.process(std::move(cloud));
    noticeMissingPose(found);
    return found;
}

void LiveDetector::noticeMissingPose(const SequenceResult& found) {
    const bool known = found.pose == PoseFound::At || found.pose == PoseFound::Extrapolated;
    if (known && !detector_.trajectory().rotationOnly()) return;
    if (!told_.insert(found.pose).second) return;
    std::string text = doneWithout(found.pose, params_);
    if (!text.empty()) reports_.push_back(std::move(text));
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
    return text.empty() ? text : reasonOf(pose) + ": " + text;
}

}  // namespace lidar_obstacles::live
