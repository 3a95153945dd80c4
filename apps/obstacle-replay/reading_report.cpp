// SPDX-License-Identifier: BSD-3-Clause
#include "reading_report.h"

namespace lidar_obstacles::apps {

void addRemark(std::string& remarks, const std::string& remark) {
    if (!remarks.empty() && !remark.empty()) remarks += "; ";
    remarks += remark;
}

void ReadingReport::add(const DecodeStats& stats, double timestamp) {
    retimed_packets_ += static_cast<std::size_t>(stats.retimed_packets);
    damaged_blocks_ += static_cast<std::size_t>(stats.damaged_blocks);
    scans_without_rings_ += stats.without_rings ? 1 : 0;
    backwards_ += newest_ && timestamp <= *newest_ ? 1 : 0;
    newest_ = timestamp;
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
    if (backwards_ != 0)
        addRemark(text, std::to_string(backwards_) +
                            " scans are not stamped after the one before: what was tracked is forgotten there");
    return text;
}

}  // namespace lidar_obstacles::apps
