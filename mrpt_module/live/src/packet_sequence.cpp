// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/live/packet_sequence.h"

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"

namespace lidar_obstacles::live {
namespace {

constexpr double kJump = 1e6;          // [us] a clock that is off by more was set anew
constexpr double kLongestWait = 10e6;  // [us] between sensor and reader: a radio link or a busy machine holds packets
constexpr double kEarly = 20e3;        // [us] that a packet may come sooner than the fastest before it
constexpr double kForgets = 10e6;      // [us] after which the fastest packet says little of today's network
constexpr double kNeighbours = 0.1;    // [s] between packets that prove a restart
constexpr int kProof = 3;              // such packets
constexpr double kQuiet = 0.03;        // [s] a sensor that restarts does not go on by its old clock

}  // namespace

PacketSequence::Verdict PacketSequence::add(std::uint32_t clock, double period, double time) {
    if (!started_) {
        begin(clock, time);
        return Verdict::Next;
    }
    const Step step = stepTo(clock, time);
    if (!fits(step)) {
        if (!isRestart(clock, time)) return Verdict::Unclear;
        ++restarts_;
        begin(clock, time);
        return Verdict::Next;
    }
    const double steps = std::round((step.passed + step.off) / period);
    if (steps <= 0.0) return fallBack(static_cast<std::size_t>(-steps));
    advance(static_cast<std::size_t>(steps));
    delay_ = std::max(0.0, delay_ - step.off) * std::exp(-std::max(0.0, step.passed) / kForgets);
    clock_ = clock;
    time_ = time;
    return Verdict::Next;
}

PacketSequence::Step PacketSequence::stepTo(std::uint32_t clock, double time) const {
    Step step;
    step.clock = clockStep(clock_, clock);
    step.passed = 1e6 * (time - time_);
    step.off = withinHalfHour(step.clock - step.passed);
    return step;
}

/// A packet may have waited on the way, but none comes before it was sent: whoever forges clocks that run ahead is
/// not followed.
bool PacketSequence::fits(const Step& step) const {
    const bool waited = step.clock > 0.0 && step.off < 0.0 && step.off > -kLongestWait;
    return waited || (step.off >= -kJump && step.off <= delay_ + kEarly);
}

bool PacketSequence::fitsNext(std::uint32_t clock, double time) const {
    const Step step = stepTo(clock, time);
    return !started_ || (fits(step) && step.passed + step.off > 0.0);
}

void PacketSequence::begin(std::uint32_t clock, double time) {
    started_ = true;
    clock_ = clock;
    time_ = time;
    seen_.reset();
    seen_.set(0);
    age_ = 0;
    delay_ = 0.0;
    candidates_.fill({});
}

void PacketSequence::advance(std::size_t steps) {
    seen_ <<= std::min(steps, kWindow);
    seen_.set(0);
    age_ += steps;
    lost_ += steps - 1;
}

PacketSequence::Verdict PacketSequence::fallBack(std::size_t steps) {
    if (steps > age_ || steps >= kWindow) return Verdict::Late;  // from before the first: nobody missed it
    if (seen_.test(steps)) return Verdict::Duplicate;
    seen_.set(steps);
    --lost_;
    return Verdict::Late;
}

bool PacketSequence::isRestart(std::uint32_t clock, double time) {
    const auto follows = [&](const Candidate& c) {
        const double step = clockStep(c.clock, clock);
        return c.row > 0 && time - c.time < kNeighbours && step > 0.0 && step < 1e6 * kNeighbours;
    };
    auto candidate = std::find_if(candidates_.begin(), candidates_.end(), follows);
    if (candidate == candidates_.end()) {  // several clocks may be forged at a time: rows between each other
        candidate = candidates_.begin() + static_cast<std::ptrdiff_t>(oldest_candidate_);
        oldest_candidate_ = (oldest_candidate_ + 1) % candidates_.size();
        candidate->row = 0;
    }
    *candidate = {clock, time, candidate->row + 1};
    return candidate->row >= kProof && time - time_ > kQuiet;
}

double packetPeriod(std::uint8_t model, std::uint8_t mode) {
    constexpr std::uint8_t kVlp16 = 0x22, kDual = 0x39;
    const VelodyneKind* kind = velodyneKind(model);
    const bool decoded = kind && kind->times.block_us > 0.0;
    const double single = 12.0 * (decoded ? kind : velodyneKind(kVlp16))->times.block_us;
    return mode == kDual ? single / 2 : single;
}

}  // namespace lidar_obstacles::live
