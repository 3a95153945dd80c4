// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Zones: polygons around the vehicle or in the map that are free, occupied, or unknown, by a rule of their own.
///
/// What a robot brakes by. A zone is never free where nobody could have seen what stands in it: without ground, behind
/// something, in a blocked sector, without the pose that it needs, it is unknown.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/health.h"

namespace lidar_obstacles {

/// Corners seen from above [m], either way round; the last is joined to the first.
using Outline = std::vector<Eigen::Vector2d>;

enum class ZoneFrame : std::uint8_t { Vehicle, Map };  ///< Map: the world frame of the vehicle's poses
enum class ZoneState : std::uint8_t { Unknown, Free, Occupied };

/// Why a zone is not free.
enum class ZoneReason : std::uint8_t {
    None,      ///< it is free
    Returns,   ///< occupied: returns lie in it
    Box,       ///< occupied: a box reaches into it
    Hidden,    ///< occupied: a track does that something hides
    Contact,   ///< occupied: what is in it will touch the vehicle before `time_to_contact`
    Starting,  ///< unknown: no scan yet, or it is occupied since the start for less than `on_after`
    NoScan,    ///< unknown: scans stay away
    NoGround,  ///< unknown: no ground was found, or it is missing in a part of the zone
    NotSeen,   ///< unknown: too much of it is hidden, outside the region or below the lowest beams
    Blocked,   ///< unknown: part of it lies in a blocked sector
    Turned,    ///< unknown: the sensor's mount turned
    NoPose,    ///< unknown: the pose of the vehicle is not known, or not its speed
    Late,      ///< unknown: the scan was older than `max_latency` when it was done with
    Step,      ///< occupied: a kerb or a low thing in it is no obstacle and higher than `min_height`
    Drop       ///< occupied: the ground ends in it, deeper than `min_height`
};
inline constexpr int kZoneReasons = 15;

/// What makes a zone occupied. A thing counts if it is of one of the classes, likely and old enough, and not above
/// `max_height`. Without `nearest` and `time_to_contact` it is enough to be in the zone; with one of them, or both, a
/// thing in the zone must be as near, or touch the vehicle as soon.
struct ZoneRule {
    std::optional<double> nearest;                              ///< from the vehicle's outline [m]
    std::optional<double> time_to_contact;                      ///< [s]
    std::array<bool, 5> classes{true, true, true, true, true};  ///< places of ObstacleClass; loose returns are Unknown
    double min_probability = 0.0;                               ///< of these classes together
    double min_age = 0.0;        ///< of a track [s]; above 0, structure and loose returns do not count
    int min_returns = 3;         ///< of a thing in this scan
    double min_height = 0.15;    ///< kerbs, low things and drops of less do not count [m]
    double max_height = 2.0;     ///< what begins higher above the ground can be passed under [m]
    double margin = 0.1;         ///< what is this near to the polygon is in it [m]
    double object_height = 1.0;  ///< free means: nothing so high or higher stands there [m]
    double min_seen = 0.9;       ///< share of its area that must be seen down to `object_height`
    double on_after = 0.0;       ///< occupied only after so long [s]
    double off_after = 0.5;      ///< free only after so long without anything in it [s]
};

struct Zone {
    std::string name;
    ZoneFrame frame = ZoneFrame::Vehicle;
    Outline polygon;
    ZoneRule rule;
};

struct ZoneSet {
    std::vector<Zone> zones;
    Outline vehicle;                    ///< its outline, vehicle frame; empty: not told
    std::optional<double> max_latency;  ///< from the last return of a scan to the state of the zones [s]
};

/// What is wrong with a polygon: fewer than three corners, no area, sides that cross; "" if it is right.
std::string faultOf(const Outline& polygon);

/// @throws std::invalid_argument naming the zone: a polygon that is not right, two of a name, a rule that asks for the
///     vehicle's outline where there is none, a number out of range.
void validate(const ZoneSet& set);

/// One zone after a scan.
struct ZoneReport {
    ZoneState state = ZoneState::Unknown;
    ZoneReason reason = ZoneReason::Starting;
    double since = 0.0;                          ///< the state is what it is since then [s since the epoch]
    double seen = 0.0;                           ///< share of its area that was seen in this scan
    int returns = 0;                             ///< of things that count in it
    std::optional<double> nearest;               ///< from the vehicle's outline to what counts in it [m]
    std::optional<double> time_to_contact;       ///< of what touches the vehicle first, up to the rule's [s]
    int id = -1;                                 ///< of the obstacle that makes it occupied; -1: none, or loose returns
    ObstacleClass cls = ObstacleClass::Unknown;  ///< of that obstacle
};

/// What a monitor has to know beside the scan.
struct ZoneInput {
    const SequenceResult& found;
    const Trajectory& trajectory;          ///< the detector's, after this scan
    const HealthReport* health = nullptr;  ///< null: nobody watches
    std::optional<double> latency;         ///< since the scan's last return [s]; not set: not known
};

/// Follows the zones from scan to scan.
///
/// Occupied at once (or after `on_after`), free after `off_after` without a reason. With poses made of the scans, a
/// zone of the map is unknown from where their frame was lost. An object is for one thread at a time.
class ZoneMonitor {
  public:
    /// @param region  of the detector: what lies outside is not searched, and never free.
    /// @throws std::invalid_argument as validate().
    ZoneMonitor(ZoneSet set, const RegionParams& region);
    ~ZoneMonitor();
    ZoneMonitor(ZoneMonitor&&) noexcept;
    ZoneMonitor& operator=(ZoneMonitor&&) noexcept;

    /// Takes in one scan. @return one report per zone, in their order; valid until the next call.
    const std::vector<ZoneReport>& update(const ZoneInput& input);
    /// No scan came up to `time` [s]: all zones are unknown.
    const std::vector<ZoneReport>& missScan(double time);

    const ZoneSet& set() const;
    const std::vector<ZoneReport>& reports() const;

  private:
    struct Memory;
    std::unique_ptr<Memory> memory_;
};

/// "vehicle" or "map"; "unknown", "free" or "occupied"; "", "returns", "box", "hidden", "contact", "starting",
/// "no_scan", "no_ground", "not_seen", "blocked", "turned", "no_pose", "late", "step" or "drop".
const char* toString(ZoneFrame frame);
const char* toString(ZoneState state);
const char* toString(ZoneReason reason);

}  // namespace lidar_obstacles
