// SPDX-License-Identifier: BSD-3-Clause
#include "pose_index.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "lidar_obstacles/mrpt_bridge/pose_feed.h"

namespace lidar_obstacles::apps {
namespace {

constexpr const char* kAuto = "auto";

bool earlier(const StampedPose& pose, double time) { return pose.time < time; }
bool isEarlier(const StampedPose& a, const StampedPose& b) { return a.time < b.time; }

}  // namespace

PoseIndex::PoseIndex(const std::string& path, const std::string& source) : path_(path) {
    InputOptions without_clouds;
    without_clouds.with_clouds = false;
    file_ = openScanSource(path, without_clouds);
    if (source != kAuto) source_ = chooseEgoSource(path, source);
    thread_ = std::thread(&PoseIndex::readThrough, this);
}

PoseIndex::~PoseIndex() {
    stop_ = true;
    thread_.join();
}

EgoSource PoseIndex::source() const {
    const std::lock_guard lock(mutex_);
    return source_.value_or(EgoSource{});
}

/// Looks into the first part of the file where the source is not known: that takes some time.
EgoSource PoseIndex::choose() {
    const bool known = source_.has_value();  // only this thread changes it
    EgoSource chosen = known ? *source_ : chooseEgoSource(path_, kAuto);
    const std::lock_guard lock(mutex_);
    source_ = chosen;
    return chosen;
}

/// What is damaged or cannot be read is told by who reads the scans: the poses end there.
void PoseIndex::readThrough() {
    try {
        EgoMotion ego(choose());
        while (!stop_ && isRead(ego.source().kind)) {
            const auto item = file_->next();
            if (!item) break;
            add(*item, ego);
        }
    } catch (const std::exception&) {
        stop_ = true;
    }
    complete_ = true;
}

/// The pose that an item tells, if it is finite.
std::optional<StampedPose> PoseIndex::poseOf(const SourceItem& item, EgoMotion& ego) {
    auto pose = ego.poseOf(item);
    try {
        if (pose) validate(*pose);
    } catch (const std::invalid_argument&) {
        ++refused_;
        return std::nullopt;
    }
    return pose;
}

void PoseIndex::add(const SourceItem& item, EgoMotion& ego) {
    const auto pose = poseOf(item, ego);
    const std::lock_guard lock(mutex_);
    if (item.observation) last_item_ = std::max(last_item_, mrpt::Clock::toDouble(item.observation->timestamp));
    if (pose) poses_.insert(std::upper_bound(poses_.begin(), poses_.end(), *pose, isEarlier), *pose);
}

bool PoseIndex::covers(double time) const {
    const std::lock_guard lock(mutex_);
    const bool has_pose = !poses_.empty() && poses_.back().time >= time + kLongestScan;
    return complete_ || has_pose || last_item_ >= time + kPosesBelongTo;
}

std::vector<StampedPose> PoseIndex::around(double from, double time) const {
    const std::lock_guard lock(mutex_);
    auto begin = std::lower_bound(poses_.begin(), poses_.end(), from, earlier);
    auto end = std::lower_bound(begin, poses_.end(), time + kLongestScan, earlier);
    if (end != poses_.end() && end->time < time + kPosesBelongTo) ++end;
    if (begin != poses_.begin()) --begin;
    return {begin, end};
}

}  // namespace lidar_obstacles::apps
