// SPDX-License-Identifier: BSD-3-Clause
#include "reading_report.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles::apps {

void addRemark(std::string& remarks, const std::string& remark) {
    if (!remarks.empty() && !remark.empty()) remarks += "; ";
    remarks += remark;
}

namespace {

/// True if a sensor is tilted by more than 20 degrees, and does not hang upside down either.
bool isTilted(const PointCloud& cloud) {
    constexpr float kCos20 = 0.9397f;
    const auto sensors = cloud.allSensors();
    return std::any_of(sensors.begin(), sensors.end(),
                       [](const SensorRays& s) { return std::abs(s.up.z()) < kCos20 - 1e-3f; });
}

}  // namespace

void ReadingReport::add(const DecodeStats& stats, const PointCloud& cloud) {
    retimed_packets_ += static_cast<std::size_t>(stats.retimed_packets);
    damaged_blocks_ += static_cast<std::size_t>(stats.damaged_blocks);
    scans_without_rings_ += stats.without_rings ? 1 : 0;
    scans_without_times_ += stats.times_left_out ? 1 : 0;
    scans_without_returns_ += cloud.empty() ? 1 : 0;
    tilted_scans_ += isTilted(cloud) ? 1 : 0;
    backwards_ += newest_ && cloud.timestamp <= *newest_ ? 1 : 0;
    newest_ = cloud.timestamp;
}

std::string ReadingReport::text() const {
    std::string text;
    if (retimed_packets_ != 0)
        addRemark(text, "the sensor's clock jumped within a scan (set by GPS?): the times of " +
                            std::to_string(retimed_packets_) + " packets follow from their azimuths");
    if (damaged_blocks_ != 0) addRemark(text, std::to_string(damaged_blocks_) + " damaged blocks of packets left out");
    if (scans_without_rings_ != 0)
        addRemark(text, std::to_string(scans_without_rings_) +
                            " scans name no rings, and their elevations fall on no steps: boxes are less exact");
    if (scans_without_times_ != 0)
        addRemark(text, std::to_string(scans_without_times_) +
                            " scans tell times of no turn (more than a second from their stamp, or a duration below "
                            "0): the times are left out, and motion within the turn is not undone");
    if (scans_without_returns_ != 0)
        addRemark(text, std::to_string(scans_without_returns_) +
                            " scans hold no return between [sensor] min_range and max_range (metres)");
    if (tilted_scans_ != 0)
        addRemark(text,
                  "a sensor is tilted by more than 20 degrees: what its rings cut into strips may be told in "
                  "pieces");
    if (backwards_ != 0)
        addRemark(text, std::to_string(backwards_) +
                            " scans are not stamped after the one before: what was tracked is forgotten there");
    return text;
}

}  // namespace lidar_obstacles::apps
