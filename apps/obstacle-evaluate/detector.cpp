// SPDX-License-Identifier: BSD-3-Clause
#include "detector.h"

#include "common/interrupt.h"
#include "common/obstacles_csv.h"
#include "common/text_file.h"
#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/joined_lidars.h"
#include "lidar_obstacles/pipelines.h"

namespace lidar_obstacles::apps {

DetectionResult detectScan(const PointCloud& cloud, const DetectorParams& params) { return detect(cloud, params); }

PointCloud cloudOf(const SourceItem& scan, const DetectorParams& params) { return toPointCloud(scan, params.sensor); }

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
