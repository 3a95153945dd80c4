// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is kept of each scan and each track of a recording besides the obstacles: scans.csv, tracks.csv, timings.csv.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::fleet {

constexpr std::size_t kClassCount = 5;

/// One scan in numbers.
struct ScanRow {
    std::size_t scan_index = 0;
    double timestamp = 0.0;  ///< [s]
    std::size_t returns = 0;
    double ground_percent = 0.0;                       ///< share of the returns that are ground
    std::array<std::size_t, kClassCount> obstacles{};  ///< by ObstacleClass
    std::size_t rejected = 0;                          ///< clusters that became none
    double fastest = 0.0;                              ///< of what moves [m/s]
    double strangeness = 0.0;                          ///< see findStrange()
    std::string strange_by;                            ///< by which of the numbers; empty: it is not strange
};

struct ScanTimes {
    std::size_t scan_index = 0;
    double read_ms = 0.0;    ///< from the end of the scan before: the file, poses
    double decode_ms = 0.0;  ///< observation to cloud
    double detect_ms = 0.0;  ///< cloud to obstacles
    std::string slowest_stage;
    double slowest_stage_ms = 0.0;
};

/// One track over a recording.
struct TrackRow {
    std::array<std::size_t, kClassCount> classes{};  ///< scans by class; the most frequent is its own
    std::size_t first_scan = 0, last_scan = 0;
    double first_time = 0.0, last_time = 0.0;  ///< [s]
    std::size_t scans_seen = 0;                ///< with returns
    double nearest = 0.0;                      ///< distance of the box from the vehicle's origin [m]
    double fastest = 0.0;                      ///< while it moves [m/s]
    double probability = 0.0;                  ///< sum over the scans
};

ScanRow toRow(std::size_t scan_index, const SequenceResult& found);
ScanTimes toTimes(std::size_t scan_index, const DetectionResult& found);
void addTracks(const ScanRow& scan, const std::vector<Obstacle>& obstacles, std::map<int, TrackRow>& tracks);

/// Sets `strangeness`: how far a number of a scan is from the recording's median, in robust standard deviations (1.4826
/// times the median distance from it, at least what is usual between any two scans), the most of all numbers.
/// Recordings of fewer than five scans have nothing strange.
void findStrange(std::vector<ScanRow>& scans);

std::string scansCsv(const std::vector<ScanRow>& scans);
std::string tracksCsv(const std::map<int, TrackRow>& tracks);
std::string timingsCsv(const std::vector<ScanTimes>& times);

}  // namespace lidar_obstacles::fleet
