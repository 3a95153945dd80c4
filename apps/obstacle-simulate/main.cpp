// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacle-simulate: a rawlog and its truth from a scenario. Parses, wires, reports.
#include <chrono>
#include <cstdio>
#include <string>

#include "common/interrupt.h"
#include "common/progress_bar.h"
#include "common/run_app.h"
#include "options.h"
#include "outputs.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;

/// The turns to record. @throws UsageError if --from and --to leave none.
std::vector<simulation::Turn> requireTurns(const simulation::Scenario& scenario, const Options& options) {
    std::vector<simulation::Turn> turns = simulation::turnsOf(scenario, options.run);
    if (turns.empty())
        throw UsageError((options.random ? toString(*options.random) : options.scenario) +
                         ": --from and --to leave no turn of the sensor; the scenario takes " +
                         std::to_string(simulation::durationOf(scenario)) + " s");
    return turns;
}

/// What a run has recorded.
struct Counts {
    std::size_t scans = 0, returns = 0, seen = 0;
};

/// Records the turns into the files. @return what was recorded, less than the turns where the run was interrupted.
Counts record(const simulation::World& world, const Options& options, std::size_t turns, Outputs& outputs) {
    struct Interrupted {};
    ProgressBar progress;
    Counts counts;
    try {
        simulation::run(world, options.run, [&](const simulation::RecordedScan& scan) {
            outputs.add(scan);
            ++counts.scans;
            counts.returns += scan.returns;
            counts.seen += scan.objects;
            progress.update(static_cast<double>(counts.scans) / static_cast<double>(turns), counts.scans);
            if (isInterrupted() && counts.scans < turns) throw Interrupted{};
        });
    } catch (const Interrupted&) {  // what is there is whole
    }
    return counts;
}

int run(const Options& options) {
    const simulation::Scenario scenario = changed(scenarioOf(options), options);
    const std::vector<simulation::Turn> turns = requireTurns(scenario, options);
    const simulation::World world = simulation::buildWorld(scenario);
    Outputs outputs(options, world);
    const auto start = std::chrono::steady_clock::now();
    const Counts counts = record(world, options, turns.size(), outputs);
    outputs.finish(turns[counts.scans - 1].end());
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%zu scans, %zu returns, %zu objects seen: see %s.rawlog (%.1f scans/s)\n", counts.scans,
                counts.returns, counts.seen, options.output.c_str(), static_cast<double>(counts.scans) / seconds);
    if (counts.scans == turns.size()) return 0;
    return exitCode("obstacle-simulate", counts.scans);
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("obstacle-simulate", [&] {
        catchInterrupts();
        const auto options = parseOptions(argc, argv);
        try {
            return options ? run(*options) : 0;
        } catch (const simulation::ScenarioError& e) {
            throw UsageError(e.what());
        }
    });
}
