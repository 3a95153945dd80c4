// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The turns of one sensor of a capture.
#pragma once

#include <bitset>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/turn_assembler.h"
#include "mrpt_bridge/input/turn_stamps.h"

namespace lidar_obstacles {

/// Finds where turns are best cut: at azimuth zero, or in the middle of what the sensor never looks at, where its
/// field of view is limited.
class CutFinder {
  public:
    void add(const TurnAssembler::Packet& packet);
    /// True once two turns were seen.
    bool hasSeenEnough() const;
    /// Azimuth [0.01 deg]; 0 if no whole turn was seen.
    int cut() const;

  private:
    std::bitset<360> seen_;  ///< azimuths [deg]
    int newest_ = -1;        ///< azimuth [0.01 deg]; -1: none yet
    long turned_ = 0;        ///< [0.01 deg]
};

/// Drops packets that come twice, finds out where to cut, and puts the others together to turns.
class SensorTurns {
  public:
    using Scan = TurnAssembler::Scan;

    /// @param label  sensorLabel of the scans.
    explicit SensorTurns(std::string label) : label_(std::move(label)) {}

    /// True if the packet is, byte for byte, one of the last 64.
    bool isDuplicate(const TurnAssembler::Packet& packet) const;
    /// Adds a packet; turns that ended go to `complete`. @param time  of its capture, seconds since the epoch.
    void add(const TurnAssembler::Packet& packet, double time, std::deque<mrpt::obs::CObservation::Ptr>& complete);
    /// No packets follow: what has been collected is a turn, too, unless it has less than a twelfth of the packets of
    /// the turn before, 30 degrees, in which the ground is not found; or less than two thirds where the field of view
    /// is limited: what stands ahead would be cut in two.
    /// @param keep_all  it is a turn however little it has.
    /// @return packets that were left out.
    std::size_t finish(bool keep_all, std::deque<mrpt::obs::CObservation::Ptr>& complete);

  private:
    void deliver(const Scan::Ptr& scan, std::deque<mrpt::obs::CObservation::Ptr>& complete);
    void assemble(std::deque<mrpt::obs::CObservation::Ptr>& complete);

    std::string label_;
    CutFinder cut_;
    std::optional<TurnAssembler> assembler_;                         ///< once it is known where to cut
    std::vector<std::pair<TurnAssembler::Packet, double>> waiting_;  ///< for that
    std::deque<TurnAssembler::Packet> recent_;
    TurnStamps stamps_;
    std::size_t turns_ = 0;            ///< delivered
    std::size_t packets_of_turn_ = 0;  ///< of the last one delivered
};

}  // namespace lidar_obstacles
