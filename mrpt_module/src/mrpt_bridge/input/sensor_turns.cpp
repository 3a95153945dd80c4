// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/sensor_turns.h"

#include <algorithm>
#include <cstring>

#include "mrpt_bridge/input/velodyne_timing.h"

namespace lidar_obstacles {
namespace {

constexpr int kTurn = TurnAssembler::Scan::ROTATION_MAX_UNITS;
constexpr std::size_t kMostWaiting = 1000;  // packets of a sensor that does not turn
constexpr std::size_t kRecent = 64;         // less than a turn: in a loop, or by a dead clock, turns look alike

}  // namespace

void CutFinder::add(const TurnAssembler::Packet& packet) {
    constexpr int kBack = 2000;  // packets overtake each other within less than this
    for (const auto& block : packet.blocks)
        if (isUsable(block)) seen_.set(block.rotation() / 100U);
    if (!isUsable(packet.blocks[0])) return;
    const int azimuth = packet.blocks[0].rotation();
    const int step = newest_ < 0 ? 0 : (azimuth - newest_ + kTurn) % kTurn;
    if (step > kTurn - kBack) return;
    turned_ += step;
    newest_ = azimuth;
}

bool CutFinder::hasSeenEnough() const { return turned_ >= 2 * kTurn; }

int CutFinder::cut() const {
    constexpr int kDegrees = 360, kNarrowest = 15;  // a gap of fewer degrees is a packet that was lost
    if (turned_ < kTurn) return 0;
    int widest = 0, middle = 0, run = 0;
    for (int k = 0; k < 2 * kDegrees; ++k) {  // twice around, for gaps across zero
        run = seen_.test(static_cast<std::size_t>(k % kDegrees)) ? 0 : run + 1;
        if (run <= widest || run > kDegrees) continue;
        widest = run;
        middle = (k - run / 2 + kDegrees) % kDegrees;
    }
    return widest < kNarrowest ? 0 : 100 * middle;
}

bool SensorTurns::isDuplicate(const TurnAssembler::Packet& packet) const {
    return std::any_of(recent_.begin(), recent_.end(), [&packet](const TurnAssembler::Packet& other) {
        return other.gps_timestamp() == packet.gps_timestamp() && std::memcmp(&other, &packet, sizeof packet) == 0;
    });
}

void SensorTurns::add(const TurnAssembler::Packet& packet, double time,
                      std::deque<mrpt::obs::CObservation::Ptr>& complete) {
    recent_.push_back(packet);
    if (recent_.size() > kRecent) recent_.pop_front();
    if (assembler_) return deliver(assembler_->add(packet, time), complete);
    cut_.add(packet);
    waiting_.emplace_back(packet, time);
    if (cut_.hasSeenEnough() || waiting_.size() >= kMostWaiting) assemble(complete);
}

/// Begins with what has been waiting.
void SensorTurns::assemble(std::deque<mrpt::obs::CObservation::Ptr>& complete) {
    assembler_.emplace(label_, cut_.cut(), TurnAssembler::Cut::WithinPackets);
    for (const auto& [packet, time] : waiting_) deliver(assembler_->add(packet, time), complete);
    waiting_ = {};
}

void SensorTurns::deliver(const Scan::Ptr& scan, std::deque<mrpt::obs::CObservation::Ptr>& complete) {
    if (!scan) return;
    ++turns_;
    packets_of_turn_ = scan->scan_packets.size();
    scan->timestamp = mrpt::Clock::fromDouble(stamps_.next(*scan, mrpt::Clock::toDouble(scan->timestamp)));
    complete.push_back(scan);
}

std::size_t SensorTurns::finish(bool keep_all, std::deque<mrpt::obs::CObservation::Ptr>& complete) {
    constexpr std::size_t kKnown = 2;  // the first turn may have begun anywhere, the second was whole
    if (!assembler_) assemble(complete);
    const auto scan = assembler_->flush();
    if (!scan) return 0;
    const std::size_t packets = scan->scan_packets.size();
    const bool limited_view = cut_.cut() != 0;
    const bool is_piece = limited_view ? 3 * packets < 2 * packets_of_turn_ : 12 * packets < packets_of_turn_;
    if (is_piece && !keep_all && turns_ >= kKnown) return packets;
    deliver(scan, complete);
    return 0;
}

}  // namespace lidar_obstacles
