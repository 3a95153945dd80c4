// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles {
namespace {

constexpr std::size_t kItems = 400;  // of an input whose stamps do not rise

/// When the last of a scan and those beside it began [s].
double latestOf(const SourceItem& item) {
    double latest = mrpt::Clock::toDouble(item.observation->timestamp);
    for (const auto& other : item.beside) latest = std::max(latest, mrpt::Clock::toDouble(other->timestamp));
    return latest;
}

}  // namespace

PoseFeed::PoseFeed(ScanSource& source, EgoSource ego, Sink sink)
    : ScanSourceFilter(source), ego_(std::move(ego)), sink_(std::move(sink)) {}

bool PoseFeed::readOne() {
    auto item = source_.next();
    if (!item) return false;
    if (item->observation) last_item_ = mrpt::Clock::toDouble(item->observation->timestamp);
    if (const auto pose = ego_.poseOf(*item)) {
        try {
            sink_(*pose);
            ++poses_;
            last_pose_ = pose->time;
        } catch (const std::invalid_argument& e) {
            if (refused_++ == 0) why_refused_ = e.what();
        }
    }
    ahead_.push_back(std::move(*item));
    return true;
}

/// Is what was read last a scan of the same lidar from long before?
bool PoseFeed::isSetBack(const SourceItem& scan) const {
    if (ahead_.empty()) return false;
    const SourceItem& last = ahead_.back();
    return last.observation && last.lidar == scan.lidar && isLidarScan(*last.observation) &&
           latestOf(last) < latestOf(scan) - kPosesBelongTo;
}

void PoseFeed::readAheadOf(const SourceItem& scan) {
    const double time = latestOf(scan);
    while (last_pose_ < time + kLongestScan && last_item_ < time + kPosesBelongTo && ahead_.size() < kItems &&
           !isSetBack(scan))
        if (!readOne()) return;
}

std::optional<SourceItem> PoseFeed::next() {
    if (ahead_.empty() && !readOne()) return std::nullopt;
    SourceItem item = std::move(ahead_.front());
    ahead_.pop_front();
    if (isRead(ego_.source().kind) && item.observation && isLidarScan(*item.observation)) readAheadOf(item);
    objects_ = item.object + 1;
    return item;
}

std::string PoseFeed::remarks() const {
    std::string text = source_.remarks();
    if (refused_ == 0) return text;
    if (!text.empty()) text += "; ";
    return text + std::to_string(refused_) + " poses of '" + ego_.source().label +
           "' refused, the first: " + why_refused_;
}

}  // namespace lidar_obstacles
