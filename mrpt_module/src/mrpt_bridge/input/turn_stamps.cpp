// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/turn_stamps.h"

#include <cmath>

#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"

namespace lidar_obstacles {
namespace {

constexpr double kTurnUnits = TurnAssembler::Scan::ROTATION_MAX_UNITS;

}  // namespace

TurnStamps::Begin TurnStamps::beginOf(const TurnAssembler::Scan& turn, double captured) {
    const auto &first = turn.scan_packets.front(), &last = turn.scan_packets.back();
    Begin begin{captured, captured, first.gps_timestamp(), first.blocks[0].rotation(), 0.0};
    const double took = 1e-6 * clockStep(first.gps_timestamp(), last.gps_timestamp());
    const double turned =
        std::remainder(last.blocks[0].rotation() - first.blocks[0].rotation() - kTurnUnits / 2, kTurnUnits) +
        kTurnUnits / 2;  // 0 .. a turn
    if (took > 0.0) begin.rate = turned / took;
    return begin;
}

/// How far the sensor's clock went [s]; 0 where it was set anew, or does not fit how far the sensor turned.
double TurnStamps::stepTo(const Begin& now, const Begin& before) {
    constexpr double kLongest = 1.0;  // [s] after which a clock that was set may fit by chance
    constexpr double kOff = 3000.0;   // [0.01 deg]
    const double step = 1e-6 * clockStep(before.clock, now.clock);
    if (step <= 0.0 || step > kLongest) return 0.0;
    const double off = std::remainder(now.azimuth - before.azimuth - step * before.rate, kTurnUnits);
    return std::abs(off) < kOff ? step : 0.0;
}

double TurnStamps::next(const TurnAssembler::Scan& turn, double captured) {
    constexpr double kJitter = 0.02;       // [s] of any network
    constexpr double kLongestWait = 10.0;  // [s]
    Begin now = beginOf(turn, captured);
    const double step = before_ ? stepTo(now, *before_) : 0.0;
    if (step > 0.0) {
        const double expected = before_->stamp + step, off = std::abs(captured - expected);
        const bool has_times = captured != before_->captured;
        if (off > kJitter && (off < kLongestWait || !has_times)) now.stamp = expected;
    }
    before_ = now;
    return now.stamp;
}

}  // namespace lidar_obstacles
