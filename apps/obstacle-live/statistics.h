// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a run counted, for people and as JSON.
#pragma once

#include <string>

#include "client_server.h"
#include "common/zone_rows.h"
#include "lidar_obstacles/live/latency.h"
#include "lidar_obstacles/live/live_scanner.h"

namespace lidar_obstacles::apps {

struct Statistics {
    live::ScannerCounts counts;
    std::size_t detected = 0;        ///< scans
    std::size_t undecodable = 0;     ///< scans that cannot be right
    std::size_t missing_beside = 0;  ///< scans that further sensors did not have
    std::size_t obstacles = 0;
    live::LatencyHistogram latency;    ///< from the arrival of a scan's last packet to its boxes
    live::LatencyHistogram tracking;   ///< of it what the tracker took; empty where tracking is off
    std::size_t poses = 0;             ///< that came to --poses
    std::size_t poses_of_clients = 0;  ///< that clients of --serve gave
    std::size_t poses_refused = 0;     ///< lines that are no pose
    std::size_t matched = 0;           ///< scans, where poses are made of them
    std::size_t match_lost = 0;        ///< those of them that could not be matched
    bool recording = false;
    std::size_t recorded = 0;        ///< scans
    std::size_t record_dropped = 0;  ///< scans that are not in the recording
    std::size_t not_searched = 0;    ///< scans that came while detection was stopped
    ClientCounts clients;            ///< of --serve
    ZonesTally watched;              ///< zones and health
    double seconds = 0.0;            ///< the run took
};

/// One line.
std::string summaryLine(const Statistics& statistics);
std::string toJson(const Statistics& statistics);

}  // namespace lidar_obstacles::apps
