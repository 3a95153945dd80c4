#include "lidar_obstacles/live/packet_sequence.h"

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"

namespace lidar_obstacles::live {
namespace {

constexpr double kHour = 3600e6;       // [us]
constexpr double kJump = 1e6;          // [us] a clock that is off by more was set anew
constexpr double kLongestWait = 10e6;  // [us] between sensor and reader: a radio link or a busy machine holds packets
constexpr double kNeighbours = 0.1;    // [s] between packets that prove a restart
constexpr int kProof = 3;              // such packets

/// Into [-half an hour, half an hour) [us].
double wrapped(double us) { return us - kHour * std::floor(us / kHour + 0.5); }

double since(std::uint32_t from, std::uint32_t to) {
    return wrapped(static_cast<double>(to) - static_cast<double>(from));
}

}  // namespace

PacketSequence::Verdict PacketSequence::add(std::uint32_t clock, double period, double time) {
    if (!started_) {
        begin(clock, time);
        return Verdict::Next;
    }
    const double passed = 1e6 * (time - time_);
    const double step = since(clock_, clock);
    const double off = wrapped(step - passed);
    const bool waited = step > 0.0 && off < 0.0 && off > -kLongestWait;
    if (std::abs(off) > kJump && !waited) {
        if (!isRestart(clock, time)) return Verdict::Unclear;
        ++restarts_;
        begin(clock, time);
        return Verdict::Next;
    }
    candidates_ = 0;
    const double steps = std::round((passed + off) / period);
    if (steps <= 0.0) return fallBack(static_cast<std::size_t>(-steps));
    advance(static_cast<std::size_t>(steps));
    clock_ = clock;
    time_ = time;
    return Verdict::Next;
}

void PacketSequence::begin(std::uint32_t clock, double time) {
    started_ = true;
    clock_ = clock;
    time_ = time;
    seen_.reset();
    seen_.set(0);
    age_ = 0;
    candidates_ = 0;
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
    const double step = since(candidate_clock_, clock);
    const bool follows =
        candidates_ > 0 && time - candidate_time_ < kNeighbours && step > 0.0 && step < 1e6 * kNeighbours;
    candidates_ = follows ? candidates_ + 1 : 1;
    candidate_clock_ = clock;
    candidate_time_ = time;
    return candidates_ >= kProof;
}

double packetPeriod(std::uint8_t model, std::uint8_t mode) {
    constexpr std::uint8_t kVlp16 = 0x22, kDual = 0x39;
    const VelodyneKind* kind = velodyneKind(model);
    const bool decoded = kind && kind->times.block_us > 0.0;
    const double single = 12.0 * (decoded ? kind : velodyneKind(kVlp16))->times.block_us;
    return mode == kDual ? single / 2 : single;
}

}  // namespace lidar_obstacles::live
