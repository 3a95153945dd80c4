// SPDX-License-Identifier: BSD-3-Clause
#include "turn_loop.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "lidar_obstacles/live/packet_sequence.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace lidar_obstacles::apps {
namespace {

using Scan = mrpt::obs::CObservationVelodyneScan;
constexpr std::size_t kMaxTurns = 600;  // a minute, 54 MB

std::vector<std::vector<Packet>> readTurns(const std::string& input) {
    const auto source = openScanSource(input);
    std::vector<std::vector<Packet>> turns;
    std::string label;
    while (const auto item = source->next()) {
        const auto scan = std::dynamic_pointer_cast<Scan>(item->observation);
        if (!scan || scan->scan_packets.empty() || turns.size() >= kMaxTurns) continue;
        if (turns.empty()) label = scan->sensorLabel;
        if (scan->sensorLabel == label) turns.push_back(scan->scan_packets);
    }
    if (turns.empty()) {
        const std::string remarks = source->remarks();
        throw std::runtime_error(input + ": no packets of a Velodyne in it" + (remarks.empty() ? "" : ": " + remarks));
    }
    return turns;
}

/// Half of a single return packet with every block twice: the last and the strongest return of a firing.
Packet dualHalf(const Packet& single, int half) {
    Packet dual = single;
    for (int b = 0; b < Scan::BLOCKS_PER_PACKET; ++b)
        std::memcpy(&dual.blocks[b], &single.blocks[half * 6 + b / 2], sizeof dual.blocks[b]);
    dual.laser_return_mode = Scan::RETMODE_DUAL;
    return dual;
}

}  // namespace

TurnLoop::TurnLoop(const std::string& input, bool dual) {
    const auto turns = readTurns(input);
    std::size_t longest = 0;
    for (const auto& turn : turns) longest = std::max(longest, turn.size());
    for (const auto& turn : turns) {
        if (10 * turn.size() < 9 * longest) continue;  // a capture begins and ends within a turn
        for (const Packet& packet : turn) append(packet, dual);
    }
    const Packet& first = packets_.front();
    period_ = 1e-6 * live::packetPeriod(first.velodyne_model_ID, first.laser_return_mode);
}

void TurnLoop::append(const Packet& packet, bool dual) {
    if (!dual || packet.laser_return_mode == Scan::RETMODE_DUAL) {
        packets_.push_back(packet);
    } else {
        packets_.push_back(dualHalf(packet, 0));
        packets_.push_back(dualHalf(packet, 1));
    }
}

Packet TurnLoop::at(std::size_t k) const {
    constexpr double kHour = 3600e6;  // [us]
    Packet packet = packets_[k % packets_.size()];
    const auto clock = static_cast<std::uint32_t>(std::fmod(1e6 * period_ * static_cast<double>(k), kHour));
    constexpr std::size_t kClockAt = 1200;  // the field is private
    std::memcpy(reinterpret_cast<std::uint8_t*>(&packet) + kClockAt, &clock, sizeof clock);
    return packet;
}

}  // namespace lidar_obstacles::apps
