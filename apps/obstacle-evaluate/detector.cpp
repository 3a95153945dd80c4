#include "detector.h"

#include "common/input_choice.h"
#include "common/interrupt.h"
#include "common/message_of.h"
#include "common/obstacles_csv.h"
#include "common/text_file.h"
#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/joined_lidars.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "lidar_obstacles/pipelines.h"

namespace lidar_obstacles::apps {
namespace {

/// The scan as a point cloud, with file and scan number in the message where it cannot be right.
PointCloud namedCloudOf(const LidarInput& input, std::size_t index, const SourceItem& scan,
                        const DetectorParams& params) {
    try {
        return cloudOf(scan, params);
    } catch (const std::invalid_argument&) {
        throw;  // parameters that do not fit the sensor
    } catch (const std::exception& e) {
        throw std::runtime_error(input.rawlog + ": scan " + std::to_string(index) + ": " + messageOf(e));
    }
}

}  // namespace

DetectionResult detectScan(const PointCloud& cloud, const DetectorParams& params) { return detect(cloud, params); }

PointCloud cloudOf(const SourceItem& scan, const DetectorParams& params) { return toPointCloud(scan, params.sensor); }

std::string forEachScan(const LidarInput& input, const ScanVisitor& visit, const PosesOnTheWay& poses) {
    const auto file = openInput(input.rawlog, input.choice);
    const auto source = std::make_unique<PoseFeed>(*file, poses.source, poses.take);
    const std::optional<std::string>& wanted = input.choice.sensor_label;
    std::optional<std::string> label = wanted;
    std::size_t count = 0;
    while (const auto item = source->next()) {
        if (!item->observation || !isLidarScan(*item->observation)) continue;
        const std::string& of_scan = item->lidar;
        if (!label) label = of_scan;
        if (of_scan != *label) {
            if (wanted) continue;
            throw std::runtime_error(input.rawlog + ": several lidars ('" + *label + "', '" + of_scan +
                                     "' ...): choose one with --sensor-label");
        }
        const std::size_t number = count++;
        if (!item->is_gap && !visit(number, *item, source->progress())) return source->remarks();
    }
    if (source->status() == SourceStatus::Damaged) throw std::runtime_error(source->message());
    if (count == 0) {
        if (!wanted) throw std::runtime_error(noScansIn(input.rawlog, *source));
        throw std::runtime_error(input.rawlog + ": no lidar scans of '" + *wanted + "' in it");
    }
    return source->remarks();
}

Progress writeDetections(const LidarInput& input, const DetectorParams& params, const std::string& csv,
                         const std::function<void(double)>& progress) {
    TextFile file(csv);
    file.append(csvHeader());
    ObstacleDetector detector(params);
    Progress done;
    const auto detect = [&](std::size_t index, const SourceItem& scan, double share) {
        done.interrupted = isInterrupted();
        if (done.interrupted) return false;
        const SequenceResult found = detector.process(namedCloudOf(input, index, scan, params));
        file.append(csvRows(found.cloud.timestamp, index, found.detection.obstacles));
        done.scans = index + 1;
        done.last_time = found.cloud.timestamp;
        progress(share);
        return true;
    };
    try {
        const bool poses_are_used = usesPoses(params, input.choice.joins());
        const EgoSource ego = poses_are_used ? chooseEgoSource(input.rawlog, params.ego.source) : EgoSource{};
        done.remarks = forEachScan(input, detect, {ego, [&](const StampedPose& pose) { detector.addPose(pose); }});
    } catch (...) {
        file.discard();
        throw;
    }
    file.close();
    return done;
}

}  // namespace lidar_obstacles::apps
