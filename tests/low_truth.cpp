// SPDX-License-Identifier: BSD-3-Clause
// False findings of low things: low_truth SCENES [FIRST_SEED]. Random streets and sidewalks without kerbs and ramps, 10
// scans each; what is found there on the bare ground, or on nothing, is false. Prints a line of JSON.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "lidar_obstacles/pipelines.h"
#include "lidar_obstacles/simulation/random_scene.h"
#include "lidar_obstacles/simulation/recording.h"

namespace {

using namespace lidar_obstacles;
namespace sim = lidar_obstacles::simulation;

struct Counts {
    std::size_t scans = 0, wrong_scans = 0;
    std::map<std::string, std::size_t> found, wrong;  ///< by kind
};

/// More than half of its returns lie on bare ground or on nothing; without returns there is nothing to lie on.
bool isWrong(const LowThing& thing, const sim::LidarScan& lidar, const sim::ScanCloud& scan) {
    std::size_t on_ground = 0;
    for (const std::int32_t i : thing.points) {
        const ObjectKind kind = lidar.returns[static_cast<std::size_t>(scan.source[static_cast<std::size_t>(i)])].kind;
        on_ground += static_cast<std::size_t>(kind == ObjectKind::Ground || kind == ObjectKind::Noise);
    }
    return 2 * on_ground >= thing.points.size();
}

sim::Scenario withoutKerbs(sim::Scenario scenario) {
    auto& clutter = scenario.clutter;
    clutter.erase(std::remove_if(clutter.begin(), clutter.end(), [](const auto& c) { return sim::isDrivable(c.kind); }),
                  clutter.end());
    return scenario;
}

void runScene(sim::RandomScene kind, std::uint64_t seed, Counts& counts) {
    const sim::Scenario scenario = withoutKerbs(sim::randomScenario(kind, seed));
    const sim::World world = sim::buildWorld(scenario);
    std::size_t turns = 0;
    for (const sim::Turn& turn : sim::turnsOf(scenario, {})) {
        if (turns++ % 4 != 0) continue;
        const sim::LidarScan lidar = sim::castScan(world, turn, sim::posesDuring(world, turn), seed);
        const sim::ScanCloud scan = sim::toCloud(lidar, scenario.sensor);
        DetectorParams params;
        params.low.enabled = true;
        const DetectionResult found = detect(scan.cloud, params);
        ++counts.scans;
        bool any = false;
        for (const LowThing& thing : found.low) {
            ++counts.found[toString(thing.kind)];
            if (!isWrong(thing, lidar, scan)) continue;
            ++counts.wrong[toString(thing.kind)];
            any = any || thing.kind != LowKind::NoGround;
            if (std::getenv("LOW_TRUTH_VERBOSE") != nullptr)
                std::fprintf(stderr, "%s %zu scan %zu: %s %.2f m high, %zu returns, at %.1f %.1f, %.1f m long\n",
                             sim::toString(kind), static_cast<std::size_t>(seed), turns - 1, toString(thing.kind),
                             thing.height, thing.points.size(), thing.box.center.x(), thing.box.center.y(),
                             thing.box.size.x());
        }
        counts.wrong_scans += static_cast<std::size_t>(any);
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        std::fprintf(stderr, "usage: low_truth SCENES [FIRST_SEED]\n");
        return 2;
    }
    try {
        const auto scenes = static_cast<std::uint64_t>(std::strtoul(argv[1], nullptr, 10));
        const auto first = static_cast<std::uint64_t>(argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 1);
        Counts counts;
        for (std::uint64_t k = 0; k < scenes; ++k)
            runScene(k % 2 == 0 ? sim::RandomScene::Street : sim::RandomScene::Sidewalk, first + k / 2, counts);
        const nlohmann::ordered_json json = {{"scans", counts.scans},
                                             {"scans_with_a_false_step_or_drop", counts.wrong_scans},
                                             {"found", counts.found},
                                             {"false", counts.wrong}};
        std::printf("%s\n", json.dump().c_str());
        return 0;
    } catch (const std::exception& e) {
        std::fprintf(stderr, "low_truth: %s\n", e.what());
        return 2;
    }
}
