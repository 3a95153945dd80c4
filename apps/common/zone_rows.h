// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Zones and health in the tools: the file of zones, the monitors, and their states as JSON and CSV.
#pragma once

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/health.h"
#include "lidar_obstacles/zones.h"

namespace lidar_obstacles::apps {

/// The zones of a file, none where `file` is empty. @throws UsageError naming file and line
std::optional<ZoneMonitor> openZones(const std::string& file, const RegionParams& region);

/// `[{"name":..,"state":..,"reason":..,...}]`, see docs/zones.md.
nlohmann::ordered_json zonesJson(const ZoneMonitor& zones);
/// `{"ok":..,"blocked":[[from, to]],..}`; angles in degrees.
nlohmann::ordered_json healthJson(const HealthReport& health);

/// A line for the time without scans: `{"timestamp":..,"zones":[..]}` and a line end.
std::string zonesLine(double timestamp, const ZoneMonitor& zones);

/// Header and rows of zones.csv.
std::string zonesCsvHeader();
std::string zonesCsvRows(double timestamp, std::size_t scan_index, const ZoneMonitor& zones);

/// What became of zones and health over a run, for a summary.
class ZonesTally {
  public:
    /// @param zones  null: there are none.
    void add(std::size_t scan_index, const ZoneMonitor* zones, const HealthReport& health);
    /// Per zone: scans by state and by reason, how often it became occupied, and the nearest that came into it [m].
    nlohmann::ordered_json zonesJson() const;
    /// Scans by fault, the first of each, and its text.
    nlohmann::ordered_json healthJson() const;
    /// One line for people; empty if nothing was wrong.
    std::string healthText() const;

  private:
    struct OfZone {
        std::map<std::string, std::size_t> states, reasons;
        std::size_t alarms = 0;
        std::optional<double> nearest;
        ZoneState last = ZoneState::Unknown;
    };
    struct OfFault {
        std::size_t scans = 0, first = 0;
        std::string text;  ///< of the first scan with it
    };
    std::vector<std::string> names_;  ///< of the zones
    std::vector<OfZone> zones_;
    std::map<std::string, OfFault> faults_;
};

}  // namespace lidar_obstacles::apps
