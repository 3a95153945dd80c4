#include "pose_index.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace lidar_obstacles::apps {
namespace {

constexpr double kScan = 0.2;   // a scan takes no longer: 5 turns per second [s]
constexpr double kAhead = 0.4;  // poses that come later do not belong to it [s]

bool earlier(const StampedPose& pose, double time) { return pose.time < time; }
bool isEarlier(const StampedPose& a, const StampedPose& b) { return a.time < b.time; }

}  // namespace

PoseIndex::PoseIndex(const std::string& path, EgoSource source)
    : file_(openScanSource(path)), ego_(std::move(source)), thread_(&PoseIndex::readThrough, this) {}

PoseIndex::~PoseIndex() {
    stop_ = true;
    thread_.join();
}

/// What is damaged or cannot be read is told by who reads the scans: the poses end there.
void PoseIndex::readThrough() {
    try {
        while (!stop_) {
            const auto item = file_->next();
            if (!item) break;
            add(*item);
        }
    } catch (const std::exception&) {
        stop_ = true;
    }
    {
        const std::lock_guard lock(mutex_);
        complete_ = true;
    }
    grown_.notify_all();
}

/// The pose that an item tells, if it is finite.
std::optional<StampedPose> PoseIndex::poseOf(const SourceItem& item) {
    const auto pose = ego_.poseOf(item);
    try {
        if (pose) validate(*pose);
    } catch (const std::invalid_argument&) {
        ++refused_;
        return std::nullopt;
    }
    return pose;
}

void PoseIndex::add(const SourceItem& item) {
    const auto pose = poseOf(item);
    const std::lock_guard lock(mutex_);
    if (item.observation) last_item_ = std::max(last_item_, mrpt::Clock::toDouble(item.observation->timestamp));
    if (pose) poses_.insert(std::upper_bound(poses_.begin(), poses_.end(), *pose, isEarlier), *pose);
    grown_.notify_all();
}

std::vector<StampedPose> PoseIndex::around(double from, double time) const {
    std::unique_lock lock(mutex_);
    grown_.wait(lock, [&] {
        const bool has_pose = !poses_.empty() && poses_.back().time >= time + kScan;
        return complete_ || has_pose || last_item_ >= time + kAhead;
    });
    auto begin = std::lower_bound(poses_.begin(), poses_.end(), from, earlier);
    auto end = std::lower_bound(begin, poses_.end(), time + kScan, earlier);
    if (end != poses_.end() && end->time < time + kAhead) ++end;
    if (begin != poses_.begin()) --begin;
    return {begin, end};
}

}  // namespace lidar_obstacles::apps
