#include "mrpt_bridge/input/velodyne_timing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lidar_obstacles {
namespace {

using Scan = mrpt::obs::CObservationVelodyneScan;

constexpr int kMaxStep = 1000;  // 10 deg: more is a gap, not a step

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

}  // namespace

FiringTimes firingTimes(int lasers) {
    if (lasers == 32) return {32, 1.152, 46.08, 46.08};
    return {16, 2.304, 55.296, 110.592};
}

bool isDualReturn(const Scan::TVelodyneRawPacket& packet) { return packet.laser_return_mode == Scan::RETMODE_DUAL; }

bool isUsable(const Scan::raw_block_t& block) {
    return block.header() == Scan::UPPER_BANK && block.rotation() < Scan::ROTATION_MAX_UNITS;
}

PacketClock packetClock(const Scan& scan) {
    constexpr std::int64_t kHour = 3'600'000'000, kLongest = 2'000'000;  // [us]
    PacketClock clock;
    if (scan.scan_packets.empty()) return clock;
    const auto first = static_cast<std::int64_t>(scan.scan_packets.front().gps_timestamp());
    std::vector<std::int64_t> delta;
    delta.reserve(scan.scan_packets.size());
    for (const auto& packet : scan.scan_packets) {
        const std::int64_t since_first = (static_cast<std::int64_t>(packet.gps_timestamp()) - first) % kHour;
        // Into [-half an hour, half an hour): across the full hour, or before the first packet.
        delta.push_back((since_first + kHour + kHour / 2) % kHour - kHour / 2);
    }
    std::vector<std::int64_t> sorted = delta;
    const auto median = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), median, sorted.end());
    const auto plausible = [&](std::int64_t d) { return std::abs(d - *median) <= kLongest; };
    std::int64_t earliest = *median;
    for (std::int64_t d : delta) earliest = plausible(d) ? std::min(earliest, d) : earliest;
    for (std::int64_t d : delta)
        clock.offset.push_back(plausible(d) ? 1e-6 * static_cast<double>(d - earliest)
                                            : std::numeric_limits<double>::quiet_NaN());
    // Where the first packet's own clock is damaged the earliest believable one stands for it.
    clock.first = plausible(0) ? -1e-6 * static_cast<double>(earliest) : 0.0;
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
