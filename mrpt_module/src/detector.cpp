#include "lidar_obstacles/detector.h"

#include <algorithm>
#include <utility>

namespace lidar_obstacles {

ObstacleDetector::ObstacleDetector(const DetectorParams& params) : params_(params), trajectory_(params.ego) {
    validate(params);
    if (params.octomap.mode == FilterMode::Spurious) voxels_.emplace(params.octomap);
    if (params.octomap.mode == FilterMode::Static) map_.emplace(params.octomap);
}

SequenceResult ObstacleDetector::process(PointCloud cloud) {
    SequenceResult r;
    const auto pose = locate(cloud, r);
    if (params_.deskew.enabled) {
        Deskewed straight = deskew(std::move(cloud), trajectory_);
        r.deskewing = straight.how;
        r.deskew_poses = straight.poses;
        cloud = std::move(straight.cloud);
    }
    r.cloud = std::move(cloud);
    const EarlierScans earlier = recall(pose, r);
    r.detection = detect(r.cloud, params_, earlier);
    r.filter_voxels = voxels_ ? voxels_->size() : map_ ? map_->size() : 0;
    remember(r, pose);
    return r;
}

/// The pose at the scan; forgets what was seen before the poses broke off.
std::optional<Eigen::Isometry3d> ObstacleDetector::locate(const PointCloud& cloud, SequenceResult& r) {
    constexpr double kKept = 2.0;  // poses older than this are of no use [s]
    const PoseAt now = trajectory_.at(cloud.timestamp);
    r.pose = now.found;
    r.restarted = last_time_ && trajectory_.brokenBetween(*last_time_, cloud.timestamp);
    if (r.restarted) {
        if (voxels_) voxels_->clear();
        earlier_.clear();
    }
    last_time_ = cloud.timestamp;
    trajectory_.forgetBefore(cloud.timestamp - kKept);
    // where the vehicle is cannot be told from how it turns
    return trajectory_.rotationOnly() ? std::nullopt : now.T_world_vehicle;
}

EarlierScans ObstacleDetector::recall(const std::optional<Eigen::Isometry3d>& pose, SequenceResult& r) {
    EarlierScans earlier;
    if (voxels_) {
        const auto assumed = trajectory_.empty() ? Eigen::Isometry3d::Identity() : pose;
        earlier.filter = [this, assumed](const PointCloud& cloud, const std::vector<std::int32_t>& candidates) {
            return voxels_->filter(cloud, candidates, assumed);
        };
    }
    if (map_ && pose) {
        earlier.filter = [this, pose](const PointCloud& cloud, const std::vector<std::int32_t>& candidates) {
            return map_->filter(cloud, candidates, *pose);
        };
    }
    r.filtered = static_cast<bool>(earlier.filter);
    last_pose_ = pose;
    if (!pose || earlier_.empty()) return earlier;
    const Eigen::Isometry3d T_vehicle_world = pose->inverse();
    for (const auto& scan : earlier_)
        for (const Eigen::Vector3d& p : scan) earlier.returns.emplace_back((T_vehicle_world * p).cast<float>());
    r.earlier_scans = earlier_.size();
    return earlier;
}

void ObstacleDetector::remember(const SequenceResult& r, const std::optional<Eigen::Isometry3d>& pose) {
    if (params_.grid.scans < 2 || !pose) return;
    std::vector<Eigen::Vector3d> returns;
    returns.reserve(r.detection.candidates.size());
    for (const std::int32_t i : r.detection.candidates) returns.emplace_back(*pose * r.cloud.xyz[i].cast<double>());
    earlier_.push_back(std::move(returns));
    while (earlier_.size() >= static_cast<std::size_t>(params_.grid.scans)) earlier_.pop_front();
}

std::vector<Eigen::Vector3f> ObstacleDetector::filterVoxels() const {
    if (voxels_) return voxels_->supportingVoxels();
    if (map_ && last_pose_) return map_->voxelsAround(*last_pose_);
    return {};
}

double ObstacleDetector::filterResolution() const { return map_ ? map_->resolution() : params_.octomap.resolution; }

}  // namespace lidar_obstacles
