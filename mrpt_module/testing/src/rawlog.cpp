#include "lidar_obstacles/testing/rawlog.h"

#include <ostream>
#include <stdexcept>
#include <utility>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"

namespace lidar_obstacles::testing {
namespace {

/// Poses that the caller has brought take the place of the recording's.
EgoSource egoSourceFor(const std::string& path, const RawlogOptions& options) {
    const bool from_recording = options.poses.empty() && usesPoses(options.params);
    return from_recording ? chooseEgoSource(path, options.params.ego.source) : EgoSource{};
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
          detector_(options.params),
          source_(openScanSource(path, options.input)),
          feed_(*source_, egoSourceFor(path, options), [this](const StampedPose& pose) { detector_.addPose(pose); }) {
        for (const StampedPose& pose : options.poses) detector_.addPose(pose);
    }

    RawlogResult all() {
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
        auto cloud = toPointCloud(*item.observation, options_.params.sensor);
        const double timestamp = cloud->timestamp;
        SequenceResult found = detector_.process(std::move(*cloud));
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
