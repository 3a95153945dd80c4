// SPDX-License-Identifier: BSD-3-Clause
#include <deque>
#include <future>
#include <set>
#include <thread>
#include <vector>

#include "lidar_obstacles/simulation/recording.h"

namespace lidar_obstacles::simulation {
namespace {

/// The same world for each sensor of the scenario, as its only one.
std::vector<World> worldsOf(const World& world) {
    std::vector<World> worlds{world};
    for (const SensorSpec& sensor : world.scenario.more_sensors) {
        worlds.push_back(world);
        worlds.back().scenario.sensor = sensor;
    }
    return worlds;
}

/// Adds what another sensor saw in the same turn, for the truth.
void addSight(const LidarScan& other, LidarScan& scan) {
    scan.returns.insert(scan.returns.end(), other.returns.begin(), other.returns.end());
    for (std::size_t i = 0; i < scan.sights.size(); ++i) {
        scan.sights[i].first += other.sights[i].first;
        scan.sights[i].alone += other.sights[i].alone;
    }
}

RecordedScan recordTurn(const std::vector<World>& worlds, const Turn& turn, std::size_t index, std::uint64_t seed) {
    constexpr std::uint64_t kOther = 7919;  // between the seeds of two sensors
    const World& world = worlds.front();
    const TurnPoses poses = posesDuring(world, turn);
    LidarScan scan = castScan(world, turn, poses, seed);
    RecordedScan recorded;
    recorded.index = index;
    recorded.observation = toObservation(scan, world.scenario.sensor);
    recorded.labels = labelsOf(scan, index);
    for (std::size_t k = 1; k < worlds.size(); ++k) {
        const LidarScan other = castScan(worlds[k], turn, poses, seed + k * kOther);
        recorded.beside.push_back(toObservation(other, worlds[k].scenario.sensor));
        addSight(other, scan);
    }
    recorded.truth_rows = truthRows(world, poses, scan, index);
    recorded.ego_row = egoRow(poses, scan, index);
    std::set<std::int32_t> seen;
    for (const LidarReturn& r : scan.returns)
        if (r.object >= 0) seen.insert(r.object);
    recorded.objects = seen.size();
    recorded.returns = scan.returns.size();
    recorded.time = turn.start();
    return recorded;
}

}  // namespace

std::vector<Turn> turnsOf(const Scenario& scenario, const RunOptions& options) {
    std::vector<Turn> turns;
    const double end = std::min(options.to, durationOf(scenario)) + 1e-9;
    std::size_t selected = 0;
    for (std::size_t i = 0;; ++i) {
        const Turn turn = turnNumber(i, scenario.sensor.rate);
        // The last turn may end with the packet that is on its way when the time is up.
        if (turn.end() > end + kPacketPeriod) return turns;
        if (turn.start() < options.from) continue;
        if (selected++ % static_cast<std::size_t>(options.stride) == 0) turns.push_back(turn);
    }
}

void run(const World& world, const RunOptions& options, const std::function<void(const RecordedScan&)>& record) {
    const std::vector<Turn> turns = turnsOf(world.scenario, options);
    const std::vector<World> worlds = worldsOf(world);
    const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
    const std::size_t threads = options.threads > 0 ? static_cast<std::size_t>(options.threads) : cores;
    std::deque<std::future<RecordedScan>> under_way;
    std::size_t next = 0;
    for (std::size_t done = 0; done < turns.size(); ++done) {
        for (; next < turns.size() && under_way.size() < threads; ++next)
            under_way.push_back(std::async(std::launch::async, [&worlds, &turns, next, seed = options.seed] {
                return recordTurn(worlds, turns[next], next, seed);
            }));
        const RecordedScan scan = under_way.front().get();
        under_way.pop_front();
        record(scan);
    }
}

}  // namespace lidar_obstacles::simulation
