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

std::vector<std::vector<Packet>> readTurns(ScanSource& source) {
    std::vector<std::vector<Packet>> turns;
    std::string label;
    while (turns.size() < kMaxTurns) {
        const auto item = source.next();
        if (!item) break;
        const auto scan = std::dynamic_pointer_cast<Scan>(item->observation);
        if (!scan || scan->scan_packets.empty()) continue;
        if (turns.empty()) label = scan->sensorLabel;
        if (scan->sensorLabel == label) turns.push_back(scan->scan_packets);
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
    const auto source = openScanSource(input);
    const auto turns = readTurns(*source);
    remarks_ = source->remarks();
    damage_ = source->message();
    if (turns.empty() && !damage_.empty()) throw std::runtime_error(damage_);
    if (turns.empty())
        throw std::runtime_error(input + ": no packets of a Velodyne in it" +
                                 (remarks_.empty() ? "" : ": " + remarks_));
    const std::size_t lacking = addTurns(turns, dual);
    if (lacking > 0)
        damage_ = input + ": " + std::to_string(lacking) + " of " + std::to_string(turns.size()) +
                  " turns lack more than a tenth of their packets and are left out" +
                  (damage_.empty() ? "" : "; " + damage_);
    const Packet& first = packets_.front();
    period_ = 1e-6 * live::packetPeriod(first.velodyne_model_ID, first.laser_return_mode);
}

std::size_t TurnLoop::addTurns(const std::vector<std::vector<Packet>>& turns, bool dual) {
    std::size_t longest = 0, lacking = 0;
    for (const auto& turn : turns) longest = std::max(longest, turn.size());
    for (std::size_t k = 0; k < turns.size(); ++k) {
        if (10 * turns[k].size() >= 9 * longest) {
            for (const Packet& packet : turns[k]) append(packet, dual);
        } else if (k != 0 && k + 1 != turns.size()) {  // a capture begins and ends within a turn
            ++lacking;
        }
    }
    return lacking;
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
