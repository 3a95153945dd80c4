// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/health.h"

#include <cmath>
#include <cstdio>

#include "sequence/health_parts.h"

namespace lidar_obstacles {
namespace {

std::string text(const char* format, double value) {
    char buffer[64];
    std::snprintf(buffer, sizeof buffer, format, value);
    return buffer;
}

std::string degrees(double rad) { return text("%.0f", normalizeAngle(rad) * 180.0 / M_PI); }

}  // namespace

std::string toText(const HealthReport& report) {
    std::string all;
    const auto add = [&all](const std::string& words) { all += (all.empty() ? "" : ", ") + words; };
    for (const AzimuthSpan& s : report.blocked)
        add("blocked " + degrees(s.from) + " to " + degrees(s.to - 1e-9) + " deg");
    for (const int ring : report.silent_rings) add("ring " + std::to_string(ring) + " silent");
    if (report.turned) add("mount turned by " + text("%.1f", report.turned_by * 180.0 / M_PI) + " deg");
    if (report.wrong_rate) add(text("%.1f", report.rate) + " scans/s, not " + text("%.1f", report.usual_rate));
    if (report.poses_lost) add("poses lost");
    return all;
}

struct HealthMonitor::Memory {
    ReturnsWatch returns;
    MountWatch mount;
    RateWatch rate;
    PoseWatch poses;
    HealthReport report;
    std::optional<double> last;  ///< [s]
};

HealthMonitor::HealthMonitor() : memory_(std::make_unique<Memory>()) {}
HealthMonitor::~HealthMonitor() = default;
HealthMonitor::HealthMonitor(HealthMonitor&&) noexcept = default;
HealthMonitor& HealthMonitor::operator=(HealthMonitor&&) noexcept = default;

const HealthReport& HealthMonitor::report() const { return memory_->report; }

const HealthReport& HealthMonitor::update(const SequenceResult& found) {
    constexpr double kLongest = 2.0;  // a longer gap is another recording [s]
    const double time = found.cloud.timestamp;
    if (memory_->last && (time <= *memory_->last || time > *memory_->last + kLongest))
        memory_ = std::make_unique<Memory>();
    Memory& m = *memory_;
    const double dt = m.last ? time - *m.last : 0.0;
    m.last = time;
    m.report.blocked.clear();
    m.report.silent_rings.clear();
    m.returns.update(found.cloud, dt, m.report);
    m.mount.update(found.detection.ground, time, m.report);
    m.rate.update(dt, m.report);
    m.poses.update(found, dt, m.report);
    return m.report;
}

}  // namespace lidar_obstacles
