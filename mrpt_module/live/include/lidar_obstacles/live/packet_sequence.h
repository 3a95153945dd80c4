// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which packets are missing, come twice or late, told by the packets' own clock.
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>

namespace lidar_obstacles::live {

/// Packets of a Velodyne carry no number, but their clock ticks evenly from one to the next: the time between two
/// tells how many are missing.
/// An object is for one thread at a time.
class PacketSequence {
  public:
    enum class Verdict : std::uint8_t {
        Next,       ///< newer than all before
        Late,       ///< one that was missing
        Duplicate,  ///< was there already
        Unclear     ///< its clock fits nothing; three that fit each other are a restart once the clock before is silent
    };

    /// @param clock   of the packet [us], starts anew every hour.
    /// @param period  from packet to packet [us], see packetPeriod().
    /// @param time    of its arrival, by a clock that is never set [s]: tells a long silence from a sensor's clock that
    ///     jumped.
    Verdict add(std::uint32_t clock, double period, double time);
    /// True if a packet of this clock could be the next one, whatever the period.
    bool fitsNext(std::uint32_t clock, double time) const;
    /// Forgets the packets, not the counts: what follows is the first of a new row.
    void restart() { started_ = false; }

    std::size_t lost() const { return lost_; }          ///< missing by now; falls when a late one comes
    std::size_t restarts() const { return restarts_; }  ///< times that the clock jumped

  private:
    static constexpr std::size_t kWindow = 4096;  ///< packets looked back on: 1 s of the fastest sensor

    /// The last of some packets whose clocks fit each other, but not those before.
    struct Candidate {
        std::uint32_t clock = 0;
        double time = 0.0;
        int row = 0;  ///< how many they are; 0: none
    };
    /// How a packet's clock stands to the newest one [us].
    struct Step {
        double clock = 0.0;   ///< what passed by the clocks
        double passed = 0.0;  ///< by the arrivals
        double off = 0.0;     ///< the difference; above 0: it travelled faster than the newest one
    };

    Step stepTo(std::uint32_t clock, double time) const;
    bool fits(const Step& step) const;
    void begin(std::uint32_t clock, double time);
    void advance(std::size_t steps);
    Verdict fallBack(std::size_t steps);
    bool isRestart(std::uint32_t clock, double time);

    bool started_ = false;
    std::uint32_t clock_ = 0;  ///< of the newest packet
    double time_ = 0.0;
    std::bitset<kWindow> seen_;  ///< bit k: the one k before the newest
    std::size_t age_ = 0;        ///< packets between the first and the newest one
    double delay_ = 0.0;         ///< of the newest packet against the fastest of late [us]
    std::array<Candidate, 16> candidates_{};
    std::size_t oldest_candidate_ = 0;
    std::size_t lost_ = 0;
    std::size_t restarts_ = 0;
};

/// Time from one packet to the next [us] (user manuals). @param model,mode  as in the packet.
double packetPeriod(std::uint8_t model, std::uint8_t mode);

}  // namespace lidar_obstacles::live
