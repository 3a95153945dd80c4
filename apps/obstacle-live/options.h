// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The command line of obstacle-live.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "client_server.h"
#include "common/class_choice.h"
#include "common/run_app.h"
#include "lidar_obstacles/live/pcap_source.h"
#include "lidar_obstacles/live/scan_stream.h"
#include "lidar_obstacles/motion.h"
#include "look.h"

namespace lidar_obstacles::apps {

/// A further sensor.
struct SensorBeside {
    live::Endpoint listen;
    mrpt::poses::CPose3D pose;  ///< on the vehicle
};

struct Options {
    std::string capture;     ///< empty: the network
    std::uint16_t port = 0;  ///< to which the packets of the capture were sent; 0: that of the first one
    live::Pace pace = live::Pace::Real;
    live::Endpoint listen;
    live::StreamOptions stream;
    std::vector<SensorBeside> beside;  ///< whose scans join those of the first
    int queue = 2;
    std::optional<live::Endpoint> poses;     ///< poses of the vehicle come here; none: they do not
    std::optional<StampedPose> standing_at;  ///< the vehicle does not move; none: nothing is known of its motion
    std::string config;                      ///< empty: the built-in defaults
    std::vector<std::string> set;
    std::optional<int> planes;
    ClassChoice classes;
    bool to_stdout = true;
    std::optional<ServeOptions> serve;  ///< results to whoever connects here
    std::string zones;                  ///< file of zones; empty: none
    std::string record;                 ///< empty: nothing is recorded
    std::string statistics;             ///< file; empty: none
    double report_every = 10.0;         ///< [s]; 0: at the end only
    double duration = 0.0;              ///< [s]; 0: until interrupted
    Look look;                          ///< of the window
    bool window = false;
};

/// Reads the command line; nullopt if it asked for --help or --version, which are printed then.
/// @throws UsageError
std::optional<Options> parseOptions(int argc, char** argv);

}  // namespace lidar_obstacles::apps
