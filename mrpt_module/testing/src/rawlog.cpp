// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/testing/rawlog.h"

#include <ostream>
#include <stdexcept>
#include <utility>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/joined_lidars.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"

namespace lidar_obstacles::testing {
namespace {

bool joins(const RawlogOptions& options) { return JoinedLidars::joins(options.sensor_label); }

/// Poses that the caller has brought take the place of the recording's and of those made of the scans.
DetectorParams paramsFor(const RawlogOptions& options) {
    DetectorParams params = options.params;
    if (!options.poses.empty()) params.ego.source = "none";
    return params;
}

EgoSource egoSourceFor(const std::string& path, const RawlogOptions& options) {
    const DetectorParams params = paramsFor(options);
    return usesPoses(params, joins(options)) ? chooseEgoSource(path, params.ego.source) : EgoSource{};
}

std::unique_ptr<ScanSource> sourceFor(const std::string& path, const RawlogOptions& options) {
    auto source = openScanSource(path, options.input);
    if (joins(options)) source = std::make_unique<JoinedLidars>(std::move(source), options.sensor_label);
    return source;
}

std::string namesOf(const std::string& path, const RawlogOptions& options) {
    std::string names;
    for (const auto& [name, scans] : lidarLabels(path, std::numeric_limits<std::size_t>::max(), options.input)) {
        names += (names.empty() ? "'" : ", '") + name + "'";
    }
    return names.empty() ? "none" : names;
}

class Run {
  public:
    Run(const std::string& path, const RawlogOptions& options)
        : path_(path),
          options_(options),
          detector_(paramsFor(options)),
          source_(sourceFor(path, options)),
          feed_(*source_, egoSourceFor(path, options), [this](const StampedPose& pose) { detector_.addPose(pose); }) {
        for (const StampedPose& pose : options.poses) detector_.addPose(pose);
    }

    RawlogResult all() {
        requireJoined();
        while (count_ <= options_.to) {
            const auto item = feed_.next();
            if (!item) break;
            if (isWanted(*item)) take(*item);
        }
        if (feed_.status() == SourceStatus::Damaged) throw std::runtime_error(feed_.message());
        if (result_.empty()) {
            throw std::runtime_error(path_ + ": none of its " + std::to_string(count_) +
                                     " scans was asked for; lidars: " + namesOf(path_, options_));
        }
        return std::move(result_);
    }

  private:
    /// @throws std::runtime_error if a lidar that is to be joined is not there.
    void requireJoined() const {
        if (!joins(options_)) return;
        const auto there = lidarLabels(path_, std::numeric_limits<std::size_t>::max(), options_.input);
        for (const std::string& name : JoinedLidars::namesIn(options_.sensor_label))
            if (there.count(name) == 0)
                throw std::runtime_error(path_ + ": no lidar '" + name + "'; lidars: " + namesOf(path_, options_));
    }

    bool isWanted(const SourceItem& item) {
        if (!item.observation || !isLidarScan(*item.observation)) return false;
        if (!options_.sensor_label.empty()) return item.lidar == options_.sensor_label;
        if (count_ == 0) lidar_ = item.lidar;
        if (item.lidar == lidar_) return true;
        throw std::invalid_argument(path_ +
                                    ": several lidars, choose one with sensor_label: " + namesOf(path_, options_));
    }

    void take(const SourceItem& item) {
        const std::size_t scan = count_++;
        if (scan < options_.from) return;
        if (item.is_gap) throw std::runtime_error(path_ + ": scan " + std::to_string(scan) + ": " + feed_.remarks());
        PointCloud cloud = toPointCloud(item, options_.params.sensor);
        const double timestamp = cloud.timestamp;
        SequenceResult found = detector_.process(std::move(cloud));
        result_.push_back({scan, timestamp, std::move(found.detection.obstacles)});
    }

    const std::string& path_;
    const RawlogOptions& options_;
    ObstacleDetector detector_;
    std::unique_ptr<ScanSource> source_;
    PoseFeed feed_;
    std::string lidar_;
    std::size_t count_ = 0;
    RawlogResult result_;
};

}  // namespace

RawlogResult detectRawlog(const std::string& path, const RawlogOptions& options) { return Run(path, options).all(); }

void PrintTo(const ScanObstacles& scan, std::ostream* os) {
    *os << "scan " << scan.scan << ", " << scan.obstacles.size() << " obstacles";
}

}  // namespace lidar_obstacles::testing
