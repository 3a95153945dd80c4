// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The command line of velodyne-send.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lidar_obstacles/live/packet_source.h"

namespace lidar_obstacles::apps {

/// What is done to the stream, as shares of its packets, 0 .. 1.
struct Faults {
    double drop = 0.0;
    double duplicate = 0.0;
    double reorder = 0.0;  ///< sent one to four packets later
    double garbage = 0.0;  ///< datagrams that are no data packets, beside the packets

    bool any() const { return drop + duplicate + reorder + garbage > 0.0; }
};

struct Options {
    std::string input;
    live::Endpoint to;
    std::optional<std::uint32_t> from;  ///< address to send from
    double duration = 10.0;             ///< [s]
    bool dual = false;                  ///< make dual return packets, twice as many, out of single ones
    Faults faults;
    std::uint64_t seed = 1;
};

/// Reads the command line; nullopt if it asked for --help or --version, which are printed then.
/// @throws UsageError, std::invalid_argument if it is not right.
std::optional<Options> parseOptions(int argc, char** argv);

}  // namespace lidar_obstacles::apps
