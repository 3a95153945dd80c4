// SPDX-License-Identifier: BSD-3-Clause
// Zones against the simulator's truth: zones_truth ZONES.yaml SCENES [FIRST_SEED]. Random streets and sidewalks, 40
// scans each; prints what was missed and what was a false alarm, as a line of JSON. Exit code 1 if anything was missed.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/health.h"
#include "lidar_obstacles/mrpt_bridge/ego_motion.h"
#include "lidar_obstacles/mrpt_bridge/zones_file.h"
#include "lidar_obstacles/simulation/random_scene.h"
#include "lidar_obstacles/simulation/recording.h"
#include "lidar_obstacles/zones.h"
#include "sequence/zone_shape.h"
#include "support/true_steps.h"

namespace {

using namespace lidar_obstacles;
namespace sim = lidar_obstacles::simulation;

constexpr int kFewest = 10;       ///< returns of an object that must not be missed
constexpr double kNearby = 0.3;   ///< what is this near to a zone is no false alarm [m]
constexpr double kLeft = 0.7;     ///< nor what left it so shortly before: zones are held for half a second [s]
constexpr double kCeiling = 2.3;  ///< nothing above is in a zone [m]

struct Counts {
    std::size_t scans = 0, zone_scans = 0, free = 0, unknown = 0, occupied = 0;
    std::size_t intrusions = 0, missed = 0, unsure = 0;  ///< zones and scans with an object in them
    std::size_t false_alarms = 0, false_scans = 0, faults = 0;
    std::map<std::string, std::size_t> false_by_reason, unknown_by_reason, faults_by_text;
};

/// A cast scan with what is true about it.
struct TrueScan {
    sim::LidarScan lidar;
    sim::TurnPoses poses;
    sim::ScanCloud cloud;
};

/// The box of an object as the vehicle saw it at time t, seen from above.
OrientedBox boxOf(const TrueScan& scan, const sim::WorldObject& object, std::size_t k, double t) {
    const auto isometry = [](const sim::Pose6& p) {
        Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
        T.translate(p.position);
        T.rotate(Eigen::AngleAxisd(p.yaw, Eigen::Vector3d::UnitZ()) *
                 Eigen::AngleAxisd(p.pitch, Eigen::Vector3d::UnitY()) *
                 Eigen::AngleAxisd(p.roll, Eigen::Vector3d::UnitX()));
        return T;
    };
    const Eigen::Isometry3d T = isometry(scan.poses.ego.at(t)).inverse() * isometry(scan.poses.objects[k]->at(t));
    const Eigen::Vector3d ahead = T.linear().col(0);
    return {T * Eigen::Vector3d(0, 0, 0.5 * object.model->size.z()), object.model->size,
            std::atan2(ahead.y(), ahead.x())};
}

/// One zone in one scan, truly.
struct TrueZone {
    bool intruded = false;  ///< by an object with enough returns
    bool nearby = false;    ///< something stands in it, or almost
    std::string what;
};

class Judge {
  public:
    explicit Judge(const ZoneSet& set) {
        for (const Zone& zone : set.zones) shapes_.push_back(toPolygon(zone.polygon));
        last_real_.assign(shapes_.size(), -1e18);
        was_occupied_.assign(shapes_.size(), false);
    }

    void add(const sim::World& world, const TrueScan& scan, const SequenceResult& found, const ZoneMonitor& zones) {
        ++counts.scans;
        const double time = found.cloud.timestamp;
        for (std::size_t z = 0; z < shapes_.size(); ++z) {
            TrueZone truth = truthOf(world, scan, found, z);
            const ZoneReason reason = zones.reports()[z].reason;
            if (!truth.nearby && (reason == ZoneReason::Step || reason == ZoneReason::Drop))
                truth.nearby = test::hasStep(world, scan.poses.ego.at(scan.lidar.turn.middle()), shapes_[z]);
            if (truth.nearby) last_real_[z] = time;
            judge(z, truth, zones.reports()[z], time);
            const bool is_missed = truth.intruded && zones.reports()[z].state == ZoneState::Free;
            if (!verbose || !(was_occupied_[z] || is_missed)) continue;
            tellReturns(scan, found, z);
            tellObstacle(found, zones.reports()[z], z);
        }
    }

    Counts counts;
    bool verbose = false;
    std::string scene;

  private:
    TrueZone truthOf(const sim::World& world, const TrueScan& scan, const SequenceResult& found, std::size_t z) const {
        TrueZone truth;
        std::vector<int> returns(world.objects.size(), 0);
        std::vector<double> times(world.objects.size(), 0.0);
        for (const sim::LidarReturn& r : scan.lidar.returns) {
            if (r.object < 0) continue;
            ++returns[static_cast<std::size_t>(r.object)];
            times[static_cast<std::size_t>(r.object)] += static_cast<double>(r.time);
        }
        for (std::size_t k = 0; k < returns.size(); ++k) {
            if (!scan.poses.objects[k]) continue;
            const double t =
                returns[k] > 0 ? scan.lidar.turn.start() + times[k] / returns[k] : scan.lidar.turn.middle();
            const double apart = distance(shapes_[z], toPolygon(cornersOf(boxOf(scan, world.objects[k], k, t))));
            truth.nearby = truth.nearby || apart <= kNearby;
            if (apart > 0.0 || returns[k] < kFewest) continue;
            truth.intruded = true;
            truth.what += world.objects[k].model->name + " " + std::to_string(returns[k]) + " returns; ";
        }
        truth.nearby = truth.nearby || hasReturns(scan, found, z);
        return truth;
    }

    /// True returns on what stands, in the zone or almost.
    bool hasReturns(const TrueScan& scan, const SequenceResult& found, std::size_t z) const {
        for (std::size_t i = 0; i < found.cloud.size(); ++i) {
            const sim::LidarReturn& r = scan.lidar.returns[scan.cloud.source[i]];
            if (r.kind == ObjectKind::Ground || r.kind == ObjectKind::Noise) continue;
            if (static_cast<double>(found.detection.ground.height[i]) > kCeiling) continue;
            if (distance(shapes_[z], Eigen::Vector2d(found.cloud.xyz[i].head<2>().cast<double>())) <= kNearby)
                return true;
        }
        return false;
    }

    /// What the returns in a zone that the detector took for something truly lie on.
    void tellReturns(const TrueScan& scan, const SequenceResult& found, std::size_t z) const {
        std::map<std::string, int> kinds;
        for (const std::int32_t i : found.detection.candidates) {
            const auto k = static_cast<std::size_t>(i);
            if (distance(shapes_[z], Eigen::Vector2d(found.cloud.xyz[k].head<2>().cast<double>())) > kNearby) continue;
            ++kinds[nameOf(scan.lidar.returns[static_cast<std::size_t>(scan.cloud.source[k])].kind)];
        }
        for (const auto& [kind, count] : kinds) std::fprintf(stderr, "    %d candidates on %s\n", count, kind.c_str());
    }

    /// The box that made a zone occupied.
    void tellObstacle(const SequenceResult& found, const ZoneReport& report, std::size_t z) const {
        for (const Obstacle& o : found.detection.obstacles) {
            const bool near = distance(shapes_[z], toPolygon(cornersOf(o.box))) < 1.0;
            if (report.state == ZoneState::Free ? !near : o.id != report.id) continue;
            double nearest = 1e9;
            for (const std::int32_t i : o.points)
                nearest = std::min(
                    nearest,
                    distance(shapes_[z],
                             Eigen::Vector2d(found.cloud.xyz[static_cast<std::size_t>(i)].head<2>().cast<double>())));
            std::fprintf(stderr,
                         "    %s of %d returns at %.1f %.1f, %.1f x %.1f x %.1f m (seen %.1f x %.1f), yaw %.2f; "
                         "nearest return %.2f m\n",
                         toString(o.cls), o.num_points, o.box.center.x(), o.box.center.y(), o.box.size.x(),
                         o.box.size.y(), o.box.size.z(), o.seen_box.size.x(), o.seen_box.size.y(), o.box.yaw, nearest);
        }
    }

    void judge(std::size_t z, const TrueZone& truth, const ZoneReport& report, double time) {
        ++counts.zone_scans;
        const bool occupied = report.state == ZoneState::Occupied;
        counts.free += report.state == ZoneState::Free;
        counts.occupied += occupied;
        if (report.state == ZoneState::Unknown) {
            ++counts.unknown;
            ++counts.unknown_by_reason[toString(report.reason)];
        }
        if (truth.intruded) {
            ++counts.intrusions;
            counts.missed += report.state == ZoneState::Free;
            counts.unsure += report.state == ZoneState::Unknown;
            if (verbose && report.state == ZoneState::Free)
                std::fprintf(stderr, "missed: %s scan %zu zone %zu: %s\n", scene.c_str(), counts.scans, z,
                             truth.what.c_str());
        }
        const bool is_false = occupied && time - last_real_[z] > kLeft;
        if (is_false) {
            ++counts.false_scans;
            if (!was_false(z)) {
                ++counts.false_alarms;
                ++counts.false_by_reason[std::string(toString(report.reason)) + " " + toString(report.cls)];
                if (verbose)
                    std::fprintf(stderr, "false: %s scan %zu zone %zu: %s %s\n", scene.c_str(), counts.scans, z,
                                 toString(report.reason), toString(report.cls));
            }
        }
        was_occupied_[z] = is_false;
    }
    bool was_false(std::size_t z) const { return was_occupied_[z]; }

    std::vector<ZonePolygon> shapes_;
    std::vector<double> last_real_;
    std::vector<bool> was_occupied_;
};

void runScene(const sim::Scenario& scenario, const ZoneSet& set, std::uint64_t seed, Judge& judge) {
    const sim::World world = sim::buildWorld(scenario);
    const DetectorParams params;
    ObstacleDetector detector(params);
    ZoneMonitor zones(set, params.region);
    HealthMonitor health;
    double told = 0.0;
    for (const sim::Turn& turn : sim::turnsOf(scenario, {})) {
        TrueScan scan{{}, sim::posesDuring(world, turn), {}};
        scan.lidar = sim::castScan(world, turn, scan.poses, seed);
        scan.cloud = sim::toCloud(scan.lidar, scenario.sensor);
        for (const double time : sim::ticks(told, turn.start() + 0.3, 0.05)) {
            const auto pose = sim::rtkPose(world, time, seed);
            detector.addPose(toStampedPose(mrpt::Clock::toDouble(pose->timestamp), pose->pose.mean));
        }
        told = turn.start() + 0.3;
        const SequenceResult found = detector.process(scan.cloud.cloud);
        const HealthReport& well = health.update(found);
        judge.counts.faults += !well.ok();
        if (!well.ok()) ++judge.counts.faults_by_text[judge.scene + ": " + toText(well)];
        zones.update({found, detector.trajectory(), &well, std::nullopt});
        judge.add(world, scan, found, zones);
    }
}

nlohmann::ordered_json toJson(const Counts& c) {
    const double hours = static_cast<double>(c.scans) * 0.1 / 3600.0;
    return {{"scans", c.scans},
            {"zone_scans", c.zone_scans},
            {"free", c.free},
            {"occupied", c.occupied},
            {"unknown", c.unknown},
            {"intrusions", c.intrusions},
            {"missed", c.missed},
            {"unknown_while_intruded", c.unsure},
            {"false_alarms", c.false_alarms},
            {"false_alarms_per_hour", static_cast<double>(c.false_alarms) / hours},
            {"scans_with_a_false_alarm", c.false_scans},
            {"false_by_reason", c.false_by_reason},
            {"unknown_by_reason", c.unknown_by_reason},
            {"scans_with_a_fault", c.faults},
            {"faults", c.faults_by_text}};
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: zones_truth ZONES.yaml SCENES [FIRST_SEED]\n");
        return 2;
    }
    try {
        ZoneSet set =
            loadZones(argv[1]);  // what merely stands in a zone with a rule of distance or time is no intrusion
        const auto has_rule = [](const Zone& z) { return z.rule.nearest || z.rule.time_to_contact; };
        set.zones.erase(std::remove_if(set.zones.begin(), set.zones.end(), has_rule), set.zones.end());
        const auto scenes = static_cast<std::uint64_t>(std::strtoul(argv[2], nullptr, 10));
        const auto first = static_cast<std::uint64_t>(argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 1);
        Counts all;
        for (std::uint64_t k = 0; k < scenes; ++k) {
            const auto kind = k % 2 == 0 ? sim::RandomScene::Street : sim::RandomScene::Sidewalk;
            const std::uint64_t seed = first + k / 2;
            Judge judge(set);
            judge.counts = all;
            judge.verbose = true;
            judge.scene = std::string(sim::toString(kind)) + " " + std::to_string(seed);
            runScene(sim::randomScenario(kind, seed), set, seed, judge);
            all = judge.counts;
        }
        std::printf("%s\n", toJson(all).dump().c_str());
        return all.missed == 0 ? 0 : 1;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "zones_truth: %s\n", e.what());
        return 2;
    }
}
