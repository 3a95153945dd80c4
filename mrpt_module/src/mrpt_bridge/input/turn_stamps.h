// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// When the turns of a capture began.
#pragma once

#include <cstdint>
#include <optional>

#include "lidar_obstacles/mrpt_bridge/turn_assembler.h"

namespace lidar_obstacles {

/// Stamps of turns, by the time of capture; where packets waited on the way (a radio link, a busy machine, a capture
/// without times), by how far the sensor's own clock went since the turn before.
class TurnStamps {
  public:
    /// Stamp of the next turn, seconds since the epoch. @param captured  when its first packet was.
    double next(const TurnAssembler::Scan& turn, double captured);

  private:
    struct Begin {
        double stamp;         ///< that was given [s]
        double captured;      ///< [s]
        std::uint32_t clock;  ///< of its first packet [us]
        int azimuth;          ///< [0.01 deg]
        double rate;          ///< how fast it turned, by the sensor's clock [0.01 deg / s]; 0: not told
    };
    static Begin beginOf(const TurnAssembler::Scan& turn, double captured);
    static double stepTo(const Begin& now, const Begin& before);

    std::optional<Begin> before_;
};

}  // namespace lidar_obstacles
