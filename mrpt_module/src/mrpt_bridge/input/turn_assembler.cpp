// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/turn_assembler.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"
#include "mrpt_bridge/input/velodyne_timing.h"

namespace lidar_obstacles {
namespace {

using Scan = TurnAssembler::Scan;

constexpr int kFullTurn = Scan::ROTATION_MAX_UNITS;
constexpr std::size_t kMaxPackets = 1000;  // of a sensor that does not turn
constexpr double kReordered = 0.02;        // [s] packets overtake each other within less than this
constexpr double kSlowestTurn = 0.2;       // [s] what follows after this is a turn of its own
constexpr double kClockIsTrusted = 1.0;    // [s] after a longer step it may fit by chance

int positive(int azimuth) { return (azimuth % kFullTurn + kFullTurn) % kFullTurn; }

bool isBehind(int azimuth, int reference) { return positive(azimuth - reference) > kFullTurn / 2; }

/// How fast the sensor turned during a packet [0.01 deg / s]; 0 if its blocks do not say.
double turningRate(const TurnAssembler::Packet& packet) {
    constexpr int kLast = 10;  // of a pair of the same firing where the return is dual
    const auto &first = packet.blocks[0], &last = packet.blocks[kLast];
    const VelodyneKind* kind = velodyneKind(packet.velodyne_model_ID);
    if (!isUsable(first) || !isUsable(last) || !kind) return 0.0;
    const int turned = positive(last.rotation() - first.rotation());
    const int firings = isDualReturn(packet) ? kLast / 2 : kLast;
    return turned < kFullTurn / 4 ? turned / (1e-6 * kind->times.block_us * firings) : 0.0;
}

}  // namespace

bool TurnAssembler::isKnownModel(const Packet& packet) { return calibrationOf(packet.velodyne_model_ID) != nullptr; }

TurnAssembler::Instant TurnAssembler::instantOf(const Packet& packet, double time) const {
    const bool has_azimuth = isUsable(packet.blocks[0]);
    return {has_azimuth ? positive(packet.blocks[0].rotation() - cut_) : newest_.azimuth, packet.gps_timestamp(), time};
}

/// True if the sensor, as fast as it turns, would look where it does after so much time [s].
bool TurnAssembler::fitsTurn(const Instant& now, double passed) const {
    const double turned = rate_ * passed;
    const double off = std::remainder(now.azimuth - newest_.azimuth - turned, static_cast<double>(kFullTurn));
    return std::abs(off) < 300.0 + std::min(0.05 * std::abs(turned), 3000.0);  // the speed varies by a few per cent
}

/// Time since the newest packet [s]; negative for one that was overtaken.
double TurnAssembler::elapsed(const Instant& now) const {
    const double by_clock = 1e-6 * clockStep(newest_.clock, now.clock), by_capture = now.time - newest_.time;
    if (std::abs(by_clock) > kClockIsTrusted || !fitsTurn(now, by_clock)) return by_capture;
    // A clock that was set by some turns fits as well as the one before.
    const bool was_set = std::abs(by_clock) > kSlowestTurn && std::abs(by_capture) < kSlowestTurn;
    return was_set && fitsTurn(now, by_capture) ? by_capture : by_clock;
}

bool TurnAssembler::isLate(const Instant& now) const {
    return isBehind(now.azimuth, newest_.azimuth) && elapsed(now) < kReordered;
}

bool TurnAssembler::endsTurn(const Instant& now) const {
    const double passed = elapsed(now);
    if (scan_->scan_packets.size() >= kMaxPackets || passed > kSlowestTurn) return true;
    if (isLate(now)) return false;
    const double passes_of_cut = (newest_.azimuth + rate_ * passed - now.azimuth) / kFullTurn;
    return now.azimuth < newest_.azimuth || std::lround(passes_of_cut) > 0;
}

void TurnAssembler::begin(const Packet& packet, double time) {
    scan_ = std::make_shared<Scan>();
    scan_->sensorLabel = label_;
    scan_->timestamp = mrpt::Clock::fromDouble(time);
    scan_->originalReceivedTimestamp = scan_->timestamp;
    scan_->minRange = 0.0;  // left to the user's parameters
    scan_->maxRange = Scan::DISTANCE_MAX;
    if (const auto* calibration = calibrationOf(packet.velodyne_model_ID)) scan_->calibration = *calibration;
}

/// True if a block lies behind the cut that the packet passes.
bool TurnAssembler::isPastCut(const Packet& packet, std::size_t block) const {
    constexpr int kBack = 1000;  // [0.01 deg] azimuths of a packet rise otherwise
    const auto &first = packet.blocks[0], &b = packet.blocks[block];
    return isUsable(first) && isUsable(b) && positive(b.rotation() - cut_) < positive(first.rotation() - cut_) - kBack;
}

/// Gives what the last packet of a turn saw behind the cut to the turn that begins. @param before  of the newest
/// packet.
void TurnAssembler::divide(Scan& ended, const Instant& before) {
    Packet& last = ended.scan_packets.back();
    constexpr std::size_t kBlocks = Scan::BLOCKS_PER_PACKET;
    if (last.gps_timestamp() != before.clock || !isPastCut(last, kBlocks - 1)) return;
    Packet rest = last;
    for (std::size_t k = 0; k < kBlocks; ++k)
        for (auto& ret : (isPastCut(last, k) ? last : rest).blocks[k].laser_returns) ret = {};
    scan_->scan_packets.push_back(rest);
    scan_->timestamp = scan_->originalReceivedTimestamp = mrpt::Clock::fromDouble(before.time);
}

Scan::Ptr TurnAssembler::add(const Packet& packet, double time) {
    const Instant now = instantOf(packet, time);
    Scan::Ptr ended = scan_ && endsTurn(now) ? flush() : nullptr;
    const bool begins = !scan_;
    if (begins) begin(packet, time);
    if (ended && where_ == Cut::WithinPackets && elapsed(now) < kSlowestTurn) divide(*ended, newest_);
    scan_->scan_packets.push_back(packet);
    if (begins || !isLate(now)) newest_ = now;
    const double rate = turningRate(packet);
    if (rate > 0.0) rate_ = rate;
    return ended;
}

void TurnAssembler::setCut(int cut) {
    newest_.azimuth = positive(newest_.azimuth + cut_ - cut);
    cut_ = cut;
}

Scan::Ptr TurnAssembler::flush() { return std::exchange(scan_, nullptr); }

}  // namespace lidar_obstacles
