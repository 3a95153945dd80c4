// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/velodyne_timing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "scan/median.h"

namespace lidar_obstacles {
namespace {

using Scan = mrpt::obs::CObservationVelodyneScan;

constexpr int kMaxStep = 1000;  // 10 deg: more is a gap, not a step
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// How often each azimuth step occurs between neighbouring firings.
std::array<int, kMaxStep + 1> stepHistogram(const Scan& scan) {
    std::array<int, kMaxStep + 1> histogram{};
    for (const auto& packet : scan.scan_packets) {
        const int stride = isDualReturn(packet) ? 2 : 1;
        for (int b = stride; b < Scan::BLOCKS_PER_PACKET; b += stride) {
            const auto &before = packet.blocks[b - stride], &block = packet.blocks[b];
            if (!isUsable(before) || !isUsable(block)) continue;
            const int step =
                (block.rotation() - before.rotation() + Scan::ROTATION_MAX_UNITS) % Scan::ROTATION_MAX_UNITS;
            if (step > 0 && step <= kMaxStep) ++histogram[static_cast<std::size_t>(step)];
        }
    }
    return histogram;
}

/// Packet times after the scan's first packet by their own clocks, [-half an hour, half an hour) [us].
std::vector<double> sinceFirst(const Scan& scan) {
    const std::uint32_t first = scan.scan_packets.front().gps_timestamp();
    std::vector<double> delta;
    delta.reserve(scan.scan_packets.size());
    for (const auto& packet : scan.scan_packets) delta.push_back(clockStep(first, packet.gps_timestamp()));
    return delta;
}

/// Azimuth from where one packet begins to where another does, [-180, 180) deg [0.01 deg]; 0 if one is damaged.
int turnBetween(const Scan::TVelodyneRawPacket& from, const Scan::TVelodyneRawPacket& to) {
    constexpr int kTurn = Scan::ROTATION_MAX_UNITS;
    if (!isUsable(from.blocks[0]) || !isUsable(to.blocks[0])) return 0;
    return (to.blocks[0].rotation() - from.blocks[0].rotation() + kTurn + kTurn / 2) % kTurn - kTurn / 2;
}

/// Fills the unknown times from those of the packets before, and what is left from those behind.
void placeByAzimuth(const Scan& scan, double s_per_unit, std::vector<double>& offset) {
    const auto place = [&](std::size_t i, std::size_t neighbour) {
        if (std::isnan(offset[i]))
            offset[i] =
                offset[neighbour] + s_per_unit * turnBetween(scan.scan_packets[neighbour], scan.scan_packets[i]);
    };
    for (std::size_t i = 1; i < offset.size(); ++i) place(i, i - 1);
    for (std::size_t i = offset.size() - 1; i-- > 0;) place(i, i + 1);
}

}  // namespace

FiringTimes firingTimes(const Scan& scan, std::size_t lasers) {
    constexpr std::uint8_t kVlp16 = 0x22, kHdl32 = 0x21, kVlp32c = 0x28;
    if (lasers == 16) return velodyneKind(kVlp16)->times;
    const bool vlp32c = !scan.scan_packets.empty() && scan.scan_packets.front().velodyne_model_ID == kVlp32c;
    return velodyneKind(vlp32c ? kVlp32c : kHdl32)->times;
}

bool isDualReturn(const Scan::TVelodyneRawPacket& packet) { return packet.laser_return_mode == Scan::RETMODE_DUAL; }

PacketClock packetClock(const Scan& scan, double us_per_unit) {
    PacketClock clock;
    if (scan.scan_packets.empty()) return clock;
    const std::vector<double> delta = sinceFirst(scan);
    std::vector<double> sorted = delta;
    const double median = medianOf(sorted);
    constexpr double kLongest = 0.5e6;  // [us] more than two of the slowest turns
    for (const double d : delta) clock.offset.push_back(std::abs(d - median) <= kLongest ? 1e-6 * d : kUnknown);
    clock.set_anew = static_cast<int>(
        std::count_if(clock.offset.begin(), clock.offset.end(), [](double offset) { return std::isnan(offset); }));
    placeByAzimuth(scan, 1e-6 * us_per_unit, clock.offset);
    const double earliest = *std::min_element(clock.offset.begin(), clock.offset.end());
    for (double& offset : clock.offset) offset -= earliest;
    clock.first = clock.offset.front();
    return clock;
}

double azimuthStep(const Scan& scan) {
    const auto histogram = stepHistogram(scan);
    std::int64_t total = 0, below = 0;
    for (int n : histogram) total += n;
    if (total == 0) return 40.0;
    int median = 0;
    while (2 * below < total) below += histogram[static_cast<std::size_t>(++median)];
    double sum = 0.0, weight = 0.0;
    for (int step = median - median / 4; step <= std::min(kMaxStep, median + median / 4); ++step) {
        sum += static_cast<double>(step) * histogram[static_cast<std::size_t>(step)];
        weight += histogram[static_cast<std::size_t>(step)];
    }
    return sum / weight;
}

}  // namespace lidar_obstacles
