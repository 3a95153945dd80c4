// SPDX-License-Identifier: BSD-3-Clause
#include "common/lidar_scans.h"

#include <stdexcept>

#include "common/message_of.h"
#include "lidar_obstacles/mrpt_bridge/joined_lidars.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles::apps {

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

PointCloud namedCloudOf(const LidarInput& input, std::size_t number, const SourceItem& scan,
                        const DetectorParams& params) {
    try {
        return toPointCloud(scan, params.sensor);
    } catch (const std::invalid_argument&) {
        throw;  // parameters that do not fit the sensor
    } catch (const std::exception& e) {
        throw std::runtime_error(input.rawlog + ": object " + std::to_string(scan.object) + " (scan " +
                                 std::to_string(number) + "): " + messageOf(e));
    }
}

}  // namespace lidar_obstacles::apps
