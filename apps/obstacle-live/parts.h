// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a line of results is made of; every client chooses for itself.
#pragma once

#include <array>
#include <bitset>
#include <memory>
#include <optional>
#include <string>

#include "common/class_choice.h"
#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/health.h"
#include "lidar_obstacles/zones.h"

namespace lidar_obstacles::apps {

/// In the order in which they stand in a line.
enum class Part : std::uint8_t { Zones, Health, Obstacles, Tracks, Structure, Points, VirtualScan, Grid, Low };
constexpr std::size_t kPartCount = 9;
using Parts = std::bitset<kPartCount>;

/// "zones", "health", "obstacles", "tracks", "structure", "points", "virtual_scan", "grid" or "low".
const char* toString(Part part);
std::optional<Part> partOf(const std::string& name);
inline bool has(const Parts& parts, Part part) { return parts.test(static_cast<std::size_t>(part)); }
inline Parts only(Part part) { return Parts().set(static_cast<std::size_t>(part)); }
/// What is served to those who ask for nothing.
Parts usualParts();

/// A line of results, by its parts. Many clients share one, whatever they chose.
struct Message {
    std::string head;                                         ///< `{"timestamp":..,"scan_index":..`
    std::array<std::optional<std::string>, kPartCount> text;  ///< `,"tracks":[..]`; those that nobody wants are not set
    static constexpr const char* kTail = "}\n";

    /// The line with the parts that are wanted and there.
    std::string line(const Parts& parts) const;
    Parts parts() const;
};

/// A scan that was searched.
struct SearchedScan {
    const SequenceResult& found;
    std::size_t index = 0;
    double latency_ms = 0.0;
    const ZoneMonitor* zones = nullptr;  ///< null: there are none
    const HealthReport& health;
    const ClassChoice& classes;  ///< of `obstacles`, `tracks` and `structure`; what is in the way is told of all
};

/// The parts of a scan that are wanted, vehicle frame, metres and radians, see docs/live.md.
Message messageOf(const SearchedScan& scan, const Parts& wanted);
/// For the time without scans: zones alone.
Message messageOf(double timestamp, const ZoneMonitor& zones);

}  // namespace lidar_obstacles::apps
