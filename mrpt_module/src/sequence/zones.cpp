// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/zones.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "sequence/zone_things.h"
#include "sequence/zone_view.h"

namespace lidar_obstacles {
namespace {

[[noreturn]] void fail(const Zone& zone, const std::string& message) {
    throw std::invalid_argument("zone '" + zone.name + "': " + message);
}

void validateRule(const Zone& zone, bool has_vehicle) {
    const ZoneRule& r = zone.rule;
    const auto require = [&](double value, const Eigen::Vector2d& range, const char* name) {
        if (!(value >= range[0] && value <= range[1])) fail(zone, std::string(name) + " is out of range");
    };
    if (r.nearest) require(*r.nearest, {0.01, 200.0}, "nearest");
    if (r.time_to_contact) require(*r.time_to_contact, {0.05, 60.0}, "time_to_contact");
    require(r.min_probability, {0.0, 1.0}, "min_probability");
    require(r.min_age, {0.0, 60.0}, "min_age");
    require(r.min_returns, {1.0, 1000.0}, "min_returns");
    require(r.min_height, {0.0, 10.0}, "min_height");
    require(r.max_height, {0.1, 10.0}, "max_height");
    require(r.margin, {0.0, 5.0}, "margin");
    require(r.object_height, {0.1, 10.0}, "object_height");
    require(r.min_seen, {0.0, 1.0}, "min_seen");
    require(r.on_after, {0.0, 10.0}, "on_after");
    require(r.off_after, {0.0, 60.0}, "off_after");
    if (std::none_of(r.classes.begin(), r.classes.end(), [](bool c) { return c; })) fail(zone, "no classes");
    if ((r.nearest || r.time_to_contact) && !has_vehicle)
        fail(zone, "nearest and time_to_contact need the vehicle's outline");
}

/// A verdict on one scan, before it is held.
struct Verdict {
    ZoneState state = ZoneState::Free;
    ZoneReason reason = ZoneReason::None;
};

/// One zone with what it remembers.
struct FollowedZone {
    ZoneView view;
    double last_occupied = -1e18;         ///< a scan had a reason [s]
    double last_unfree = -1e18;           ///< the same, or could not tell [s]
    std::optional<double> occupied_from;  ///< scans have a reason since then [s]

    explicit FollowedZone(const Zone& zone) : view(zone) {}
};

/// The state after a verdict: occupied after `on_after`, free after `off_after`.
Verdict held(const Verdict& now, const ZoneRule& rule, const ZoneReport& before, const FollowedZone& zone) {
    const double time = zone.last_unfree;
    if (now.state == ZoneState::Occupied) {
        if (before.state == ZoneState::Occupied || time - *zone.occupied_from >= rule.on_after) return now;
        return before.state == ZoneState::Free ? Verdict{} : Verdict{ZoneState::Unknown, before.reason};
    }
    if (before.state == ZoneState::Occupied && time - zone.last_occupied < rule.off_after)
        return {ZoneState::Occupied, before.reason};
    return now;
}

}  // namespace

void validate(const ZoneSet& set) {
    std::set<std::string> names;
    if (!set.vehicle.empty() && !faultOf(set.vehicle).empty())
        throw std::invalid_argument("the vehicle's outline: " + faultOf(set.vehicle));
    if (set.max_latency && !(*set.max_latency > 0.0)) throw std::invalid_argument("max_latency must be above 0");
    for (const Zone& zone : set.zones) {
        if (zone.name.empty()) throw std::invalid_argument("a zone has no name");
        if (!names.insert(zone.name).second) fail(zone, "there are two of this name");
        const std::string fault = faultOf(zone.polygon);
        if (!fault.empty()) fail(zone, fault);
        validateRule(zone, !set.vehicle.empty());
    }
}

struct ZoneMonitor::Memory {
    ZoneSet set;
    DetectorView looked_at{SearchedPlace(RegionParams{}), OwnBody()};
    std::vector<FollowedZone> zones;
    std::vector<ZoneReport> reports;
    bool started = false;
    bool map_lost = false;       ///< poses are told in another frame than at first
    std::optional<double> last;  ///< [s]

    void notice(const SequenceResult& found);
    Verdict judge(std::size_t k, const ZoneInput& input, const ZoneScene& scene);
    Verdict judgeSight(const ZoneInput& input, const ZoneRule& rule, const ZoneSight& sight) const;
    std::optional<Eigen::Isometry2d> placeOf(const Zone& zone, const ZoneInput& input) const;
    void take(std::size_t k, const Verdict& now, double time);
};

/// Time that runs backwards is another recording; poses made of scans that begin anew are of another frame.
void ZoneMonitor::Memory::notice(const SequenceResult& found) {
    const double time = found.cloud.timestamp;
    map_lost = map_lost || (started && found.match && found.match->restarted);
    started = true;
    if (last && time < *last) {
        for (FollowedZone& zone : zones) {
            zone.last_occupied = zone.last_unfree = -1e18;
            zone.occupied_from.reset();
        }
        for (ZoneReport& r : reports) r = ZoneReport{};
    }
    last = time;
}

/// T_zone_vehicle; none where the zone is of the map and its pose is not known.
std::optional<Eigen::Isometry2d> ZoneMonitor::Memory::placeOf(const Zone& zone, const ZoneInput& input) const {
    if (zone.frame == ZoneFrame::Vehicle) return Eigen::Isometry2d::Identity();
    if (map_lost || input.trajectory.rotationOnly()) return std::nullopt;
    const auto pose = input.trajectory.at(input.found.cloud.timestamp).T_world_vehicle;
    if (!pose) return std::nullopt;
    return seenFromAbove(*pose);
}

/// Whether nothing in it means that nothing is there.
Verdict ZoneMonitor::Memory::judgeSight(const ZoneInput& input, const ZoneRule& rule, const ZoneSight& sight) const {
    if (sight.blocked) return {ZoneState::Unknown, ZoneReason::Blocked};
    if (sight.seen < rule.min_seen) return {ZoneState::Unknown, ZoneReason::NotSeen};
    if (input.health != nullptr && input.health->turned) return {ZoneState::Unknown, ZoneReason::Turned};
    if (set.max_latency && input.latency && *input.latency > *set.max_latency)
        return {ZoneState::Unknown, ZoneReason::Late};
    return {};
}

Verdict ZoneMonitor::Memory::judge(std::size_t k, const ZoneInput& input, const ZoneScene& scene) {
    const Zone& zone = set.zones[k];
    ZoneReport& report = reports[k];
    report = {report.state, report.reason, report.since, 0.0, 0, {}, {}, -1, ObstacleClass::Unknown};
    const auto T_zone_vehicle = placeOf(zone, input);
    if (!T_zone_vehicle) return {ZoneState::Unknown, ZoneReason::NoPose};
    const DetectionResult& detection = input.found.detection;
    if (detection.ground.evidence == GroundEvidence::None) return {ZoneState::Unknown, ZoneReason::NoGround};
    const ZoneSight sight = zones[k].view.look(input.found, *T_zone_vehicle, looked_at, input.health);
    const PlacedZone placed{zone.rule, toPolygon(moved(zone.polygon, T_zone_vehicle->inverse())), zones[k].view,
                            *T_zone_vehicle};
    const ZoneContent content = contentOf(placed, scene);
    report.seen = sight.seen;
    report.returns = content.returns;
    report.nearest = content.nearest;
    report.time_to_contact = content.time_to_contact;
    if (content.reason) {
        report.id = content.id;
        report.cls = content.cls;
        return {ZoneState::Occupied, *content.reason};
    }
    if (content.speed_missing) return {ZoneState::Unknown, ZoneReason::NoPose};
    if (content.ground_missing) return {ZoneState::Unknown, ZoneReason::NoGround};
    return judgeSight(input, zone.rule, sight);
}

void ZoneMonitor::Memory::take(std::size_t k, const Verdict& now, double time) {
    FollowedZone& zone = zones[k];
    ZoneReport& report = reports[k];
    const ZoneRule& rule = set.zones[k].rule;
    Verdict next = now;
    if (now.state == ZoneState::Free) {
        zone.occupied_from.reset();
        if (report.state != ZoneState::Free && report.reason != ZoneReason::Starting &&
            time - zone.last_unfree < rule.off_after)
            next = {report.state, report.reason};
    } else {
        zone.last_unfree = time;
        if (now.state != ZoneState::Occupied) {
            zone.occupied_from.reset();
        } else {
            zone.last_occupied = time;
            if (!zone.occupied_from) zone.occupied_from = time;
        }
        next = held(now, rule, report, zone);
    }
    if (next.state != report.state || report.since == 0.0) report.since = time;
    report.state = next.state;
    report.reason = next.reason;
}

ZoneMonitor::ZoneMonitor(ZoneSet set, const RegionParams& region) : memory_(std::make_unique<Memory>()) {
    validate(set);
    memory_->set = std::move(set);
    memory_->looked_at = {SearchedPlace(region), OwnBody(region.own_body)};
    memory_->zones.reserve(memory_->set.zones.size());
    for (const Zone& zone : memory_->set.zones) memory_->zones.emplace_back(zone);
    memory_->reports.resize(memory_->set.zones.size());
}

ZoneMonitor::~ZoneMonitor() = default;
ZoneMonitor::ZoneMonitor(ZoneMonitor&&) noexcept = default;
ZoneMonitor& ZoneMonitor::operator=(ZoneMonitor&&) noexcept = default;

const std::vector<ZoneReport>& ZoneMonitor::update(const ZoneInput& input) {
    Memory& m = *memory_;
    m.notice(input.found);
    const ZoneScene scene = zoneScene(input.found, m.set.vehicle, input.trajectory);
    for (std::size_t k = 0; k < m.zones.size(); ++k) m.take(k, m.judge(k, input, scene), input.found.cloud.timestamp);
    return m.reports;
}

const std::vector<ZoneReport>& ZoneMonitor::missScan(double time) {
    Memory& m = *memory_;
    for (std::size_t k = 0; k < m.zones.size(); ++k) {
        ZoneReport& r = m.reports[k];
        r = {r.state, r.reason, r.since, 0.0, 0, {}, {}, -1, ObstacleClass::Unknown};
        m.take(k, {ZoneState::Unknown, ZoneReason::NoScan}, time);
    }
    return m.reports;
}

const ZoneSet& ZoneMonitor::set() const { return memory_->set; }
const std::vector<ZoneReport>& ZoneMonitor::reports() const { return memory_->reports; }

const char* toString(ZoneFrame frame) { return frame == ZoneFrame::Map ? "map" : "vehicle"; }

const char* toString(ZoneState state) {
    constexpr std::array<const char*, 3> kNames{"unknown", "free", "occupied"};
    return kNames[static_cast<std::size_t>(state)];
}

const char* toString(ZoneReason reason) {
    constexpr std::array<const char*, kZoneReasons> kNames{"",         "returns", "box",       "hidden",   "contact",
                                                           "starting", "no_scan", "no_ground", "not_seen", "blocked",
                                                           "turned",   "no_pose", "late",      "step",     "drop"};
    return kNames[static_cast<std::size_t>(reason)];
}

}  // namespace lidar_obstacles
