// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The packets of a recording, without end.
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <string>
#include <vector>

namespace lidar_obstacles::apps {

using Packet = mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket;

/// Whole turns of the first lidar of a recording, over and over, with a clock that runs on.
class TurnLoop {
  public:
    /// @param dual  makes two dual return packets of each single one.
    /// @throws std::runtime_error if it cannot be opened or holds no packets.
    TurnLoop(const std::string& input, bool dual);

    /// What of the recording did not become turns, in one line; empty if there is nothing to say.
    const std::string& remarks() const { return remarks_; }
    /// What is missing, in one line: turns within the recording that lack more than a tenth of the packets of the
    /// longest, and what follows a damage. Empty if nothing is.
    const std::string& damage() const { return damage_; }

    /// Packet k = 0, 1, 2 ...
    Packet at(std::size_t k) const;
    double period() const { return period_; }  ///< from packet to packet [s]

  private:
    /// Turns that are whole. @return how many others there are but the first and the last.
    std::size_t addTurns(const std::vector<std::vector<Packet>>& turns, bool dual);
    void append(const Packet& packet, bool dual);

    std::vector<Packet> packets_;
    double period_ = 0.0;
    std::string remarks_, damage_;
};

}  // namespace lidar_obstacles::apps
