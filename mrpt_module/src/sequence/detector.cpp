// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/detector.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/completion.h"
#include "lidar_obstacles/joined_cloud.h"
#include "lidar_obstacles/seam.h"
#include "sequence/zone_shape.h"

namespace lidar_obstacles {
namespace {

/// When the last return came [s].
double endOf(const PointCloud& cloud) {
    const auto last = std::max_element(cloud.time_offset.begin(), cloud.time_offset.end());
    return cloud.timestamp + (last == cloud.time_offset.end() ? 0.0 : static_cast<double>(*last));
}

/// Sets which returns are those of structure.
void markStructure(const SequenceResult& r, std::vector<std::uint8_t>& is_structure) {
    is_structure.assign(r.cloud.size(), 0);
    for (const Cluster& c : r.detection.clusters.structure) {
        if (c.cls != ObstacleClass::Structure) continue;
        for (const std::int32_t i : c.points) is_structure[static_cast<std::size_t>(i)] = 1;
    }
}

}  // namespace

bool usesPoses(const DetectorParams& params, bool several_lidars) {
    return several_lidars || params.deskew.enabled || params.octomap.mode != FilterMode::Off || params.grid.scans > 1 ||
           params.tracking.enabled;
}

std::size_t scansRemembered(const DetectorParams& params) {
    const auto filter = params.octomap.mode == FilterMode::Spurious ? params.octomap.history - 1 : 0;
    const int scans = filter + params.grid.scans - 1;  // what a grid remembers was filtered before
    constexpr int kSettles = 10;                       // tracks, and what scans are matched with
    const bool settles = params.tracking.enabled || (matchesScans(params.ego) && usesPoses(params));
    return static_cast<std::size_t>(settles ? std::max(scans, kSettles) : scans);
}

ObstacleDetector::ObstacleDetector(const DetectorParams& params) : params_(params), trajectory_(params.ego) {
    validate(params);
    if (params.octomap.mode == FilterMode::Spurious) voxels_.emplace(params.octomap);
    if (params.octomap.mode == FilterMode::Static) map_.emplace(params.octomap);
    if (params.tracking.enabled) tracker_.emplace(params.tracking);
    if (params.tracking.enabled && params.low.enabled) low_.emplace(params.tracking.max_hidden);
    if (matchesScans(params.ego) && usesPoses(params)) matcher_.emplace(params.ego, params.region.own_body);
}

void ObstacleDetector::forgetScans() {
    if (voxels_) voxels_->clear();
    earlier_.clear();
    if (tracker_) tracker_->forget();
    if (low_) low_->forget();
}

void ObstacleDetector::restart() {
    forgetScans();
    trajectory_ = Trajectory(params_.ego);
    if (matcher_) matcher_->restart();
    last_time_.reset();
    last_pose_.reset();
}

SequenceResult ObstacleDetector::process(PointCloud cloud, double delay) {
    validate(cloud);
    SequenceResult r;
    if (!matcher_ && matchesScans(params_.ego) && !cloud.sensors.empty())
        matcher_.emplace(params_.ego, params_.region.own_body);
    if (matcher_) matchScan(cloud, r);
    const auto pose = locate(cloud, r);
    PointCloud in_place = straighten(cloud, r);
    if (params_.deskew.mend_seam && cloud.sensors.empty()) {  // each sensor has a seam of its own
        const SeamGap seam = findSeamGap(cloud);
        r.mended = seam.rings > 0;
        cloud = mendSeam(std::move(cloud), seam);
    }
    r.cloud = std::move(cloud);
    EarlierScans earlier = recall(pose, r);
    if (r.filtered) earlier.filter = filterOf(in_place, pose);
    if (tracker_ && params_.tracking.grouping) earlier.objects = expectedIn(r, pose);
    r.detection = detect(r.cloud, params_, earlier);
    if (pose) r.filter_voxels = voxels_ ? voxels_->size() : map_ ? map_->size() : 0;
    remember(r, pose);
    if (low_ && pose) low_->update(r.cloud, seenFromAbove(*pose), r.detection);
    if (tracker_) track(r, pose, endOf(r.cloud) + delay);
    if (map_ && pose) dropRemains(r, in_place, *pose);
    const GateParams gates = params_.pipeline.bare_paper ? barePaper(params_).gates : params_.gates;
    for (Obstacle& o : r.detection.obstacles) o.cls = toldClass(o, gates);
    if (matcher_) learnScan(r);
    return r;
}

/// Takes out boxes on what the map only knows in part: structure, and what has stood long enough and is no road user,
/// with most of its returns beside known voxels. Twigs move, and no two passes hit the same ones.
void ObstacleDetector::dropRemains(SequenceResult& r, const PointCloud& in_place, const Eigen::Isometry3d& pose) {
    constexpr double kStood = 1.0;  // [s]
    constexpr double kMost = 0.5;
    const auto remains = [&](const Obstacle& o) {
        const bool stands = o.cls == ObstacleClass::Unknown && o.track && !o.track->moving && o.track->age >= kStood;
        if (o.cls != ObstacleClass::Structure && !stands) return false;
        return map_->shareBeside(in_place, o.points, pose) > kMost;
    };
    std::vector<Obstacle>& all = r.detection.obstacles;
    const auto first = std::stable_partition(all.begin(), all.end(), [&](const Obstacle& o) { return !remains(o); });
    std::vector<std::int32_t>& filtered = r.detection.filtered;
    for (auto it = first; it != all.end(); ++it) filtered.insert(filtered.end(), it->points.begin(), it->points.end());
    std::sort(filtered.begin(), filtered.end());
    all.erase(first, all.end());
}

/// Adds the poses that the scan itself tells; forgets the frame of those before where it could not be matched.
void ObstacleDetector::matchScan(const PointCloud& cloud, SequenceResult& r) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    r.match = matcher_->match(cloud);
    if (r.match->restarted) {
        forgetScans();
        trajectory_ = Trajectory(params_.ego);
    }
    for (const StampedPose& pose : r.match->poses) trajectory_.add(pose);
    match_ms_ = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// What the next scan is matched with: this one without what moves.
void ObstacleDetector::learnScan(SequenceResult& r) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    std::vector<std::int32_t> moving;
    for (const Obstacle& o : r.detection.obstacles)
        if (o.track && o.track->moving) moving.insert(moving.end(), o.points.begin(), o.points.end());
    matcher_->learn(r.detection.ground, moving);
    const double learn_ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    r.detection.timing.push_back({"match", match_ms_ + learn_ms});
}

/// The tracks in the place of the boxes. Structure and scraps are not followed: they are numbered anew in each scan,
/// above all tracks.
void ObstacleDetector::track(SequenceResult& r, const std::optional<Eigen::Isometry3d>& pose, double now) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point start = Clock::now();
    TrackingScan& scan = tracking_scan_;
    std::vector<Obstacle>& obstacles = r.detection.obstacles;
    scan.time = r.cloud.timestamp;
    scan.poses_known = pose.has_value();
    scan.T_world_vehicle = pose.value_or(Eigen::Isometry3d::Identity());
    scan.pose_at = frameOfReturns(r, pose);
    scan.sensor = r.cloud.sensor_origin.head<2>().cast<double>();
    scan.cloud = &r.cloud;
    scan.boxes.clear();
    markStructure(r, scan.is_structure);
    const auto unfollowed = std::stable_partition(obstacles.begin(), obstacles.end(), [this](const Obstacle& o) {
        return o.cls != ObstacleClass::Structure && o.num_points >= params_.gates.min_points;
    });
    std::vector<Obstacle> rest(std::make_move_iterator(unfollowed), std::make_move_iterator(obstacles.end()));
    obstacles.erase(unfollowed, obstacles.end());
    for (const Obstacle& o : obstacles) {
        scan.boxes.push_back(seenAt(o, r));
        if (!r.cloud.sensors.empty())
            scan.boxes.back().sensor =
                r.cloud.sensors[sensorThatSaw(o.points, r.cloud)].origin.head<2>().cast<double>();
    }
    scan.told_for.reset();
    if (params_.tracking.stamp != TrackStamp::Seen) {
        scan.told_for = params_.tracking.stamp == TrackStamp::Scan ? scan.time : now;
        const auto then = trajectory_.at(*scan.told_for).T_world_vehicle;
        scan.T_world_told = pose && then ? *then : scan.T_world_vehicle;
    }
    obstacles = trackedObstacles(tracker_->update(scan), obstacles);
    if (params_.box.completion != Completion::None && !params_.pipeline.bare_paper) raiseVehicles(obstacles);
    int number = kFirstUntrackedId;
    for (Obstacle& o : rest) {
        o.id = number++;
        obstacles.push_back(std::move(o));
    }
    r.tracked = true;
    r.detection.timing.push_back({"track", std::chrono::duration<double, std::milli>(Clock::now() - start).count()});
}

/// What is followed, where this scan should show it.
const std::vector<ExpectedObject>& ObstacleDetector::expectedIn(const SequenceResult& r,
                                                                const std::optional<Eigen::Isometry3d>& pose) {
    return tracker_->expected(r.cloud.timestamp, pose.has_value(), frameOfReturns(r, pose));
}

/// The vehicle's pose when the laser saw a return: of the frame that it is told in. That at the stamp where the cloud
/// was straightened; the identity where there are no poses.
PoseAtTime ObstacleDetector::frameOfReturns(const SequenceResult& r,
                                            const std::optional<Eigen::Isometry3d>& pose) const {
    const bool straightened = r.deskewing && *r.deskewing == Deskewing::Done;
    const Eigen::Isometry3d at_stamp = pose.value_or(Eigen::Isometry3d::Identity());
    if (!pose || straightened) return [T = at_stamp](double) { return T; };
    return [this, at_stamp](double time) { return trajectory_.at(time).T_world_vehicle.value_or(at_stamp); };
}

/// When the laser saw an obstacle, and where the vehicle was then: the mean time of its returns.
SeenBox ObstacleDetector::seenAt(const Obstacle& o, const SequenceResult& r) const {
    const TrackingScan& scan = tracking_scan_;
    if (r.cloud.time_offset.empty() || o.points.empty()) return seenBox(o, scan.time, scan.T_world_vehicle);
    double sum = 0.0;
    for (const std::int32_t i : o.points) sum += static_cast<double>(r.cloud.time_offset[i]);
    const double time = r.cloud.timestamp + sum / static_cast<double>(o.points.size());
    return seenBox(o, time, scan.pose_at(time));
}

/// De-skews the cloud where that is wanted. What is returned is where the 3D filter looks the returns up: de-skewed in
/// any case, as far as the poses tell; empty without a filter.
PointCloud ObstacleDetector::straighten(PointCloud& cloud, SequenceResult& r) {
    // scans only share a grid in one frame, as do sensors that do not look at a place at the same time
    const bool for_boxes = params_.deskew.enabled || params_.grid.scans > 1 || !cloud.sensors.empty();
    const bool for_filter = params_.octomap.mode != FilterMode::Off;
    if (!for_boxes && !for_filter) return {};
    if (!for_boxes) return deskew(cloud, trajectory_).cloud;
    Deskewed straight = deskew(std::move(cloud), trajectory_);
    r.deskewing = straight.how;
    r.deskew_poses = straight.poses;
    cloud = std::move(straight.cloud);
    return for_filter ? cloud : PointCloud{};
}

/// The pose at the scan; forgets what was seen before the poses broke off.
std::optional<Eigen::Isometry3d> ObstacleDetector::locate(const PointCloud& cloud, SequenceResult& r) {
    constexpr double kKept = 2.0;  // poses older than this are of no use [s]
    const bool set_back = last_time_ && cloud.timestamp < *last_time_ - kKept;  // a recording that begins again
    if (set_back) trajectory_.forgetAfter(cloud.timestamp + kKept);
    const PoseAt now = trajectory_.at(cloud.timestamp);
    r.pose = now.found;
    r.restarted =
        (r.match && r.match->restarted) || (last_time_ && trajectory_.brokenBetween(*last_time_, cloud.timestamp));
    if (r.restarted) forgetScans();
    last_time_ = cloud.timestamp;
    trajectory_.forgetBefore(cloud.timestamp - kKept);
    // where the vehicle is cannot be told from how it turns
    return trajectory_.rotationOnly() ? std::nullopt : now.T_world_vehicle;
}

/// The 3D filter of this scan. @param in_place  the cloud that is looked up instead of the one that is searched.
CandidateFilter ObstacleDetector::filterOf(const PointCloud& in_place, const std::optional<Eigen::Isometry3d>& pose) {
    if (map_)
        return [this, &in_place, pose](const PointCloud&, const std::vector<std::int32_t>& candidates) {
            return map_->filter(in_place, candidates, *pose);
        };
    return [this, &in_place, pose](const PointCloud&, const std::vector<std::int32_t>& candidates) {
        return voxels_->filter(in_place, candidates, pose);
    };
}

EarlierScans ObstacleDetector::recall(const std::optional<Eigen::Isometry3d>& pose, SequenceResult& r) {
    EarlierScans earlier;
    r.filtered = voxels_ || (map_ && pose);
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
    if (voxels_ && last_pose_) return voxels_->supportingVoxels();
    if (map_ && last_pose_) return map_->voxelsAround(*last_pose_);
    return {};
}

double ObstacleDetector::filterResolution() const { return map_ ? map_->resolution() : params_.octomap.resolution; }

}  // namespace lidar_obstacles
