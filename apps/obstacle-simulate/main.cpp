/// @file
/// obstacle-simulate: a rawlog and its truth from a scenario. Parses, wires, reports.
#include <chrono>
#include <cstdio>
#include <string>

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

int run(const Options& options) {
    const simulation::Scenario scenario = changed(scenarioOf(options), options);
    const std::vector<simulation::Turn> turns = requireTurns(scenario, options);
    const simulation::World world = simulation::buildWorld(scenario);
    Outputs outputs(options, world);
    ProgressBar progress;
    const auto start = std::chrono::steady_clock::now();
    std::size_t scans = 0, returns = 0, seen = 0;
    simulation::run(world, options.run, [&](const simulation::RecordedScan& scan) {
        outputs.add(scan);
        ++scans;
        returns += scan.returns;
        seen += scan.objects;
        progress.update(static_cast<double>(scans) / static_cast<double>(turns.size()), scans);
    });
    outputs.finish(turns.back().end());
    progress.clear();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::printf("%zu scans, %zu returns, %zu objects seen: see %s.rawlog (%.1f scans/s)\n", scans, returns, seen,
                options.output.c_str(), static_cast<double>(scans) / seconds);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("obstacle-simulate", [&] {
        const auto options = parseOptions(argc, argv);
        try {
            return options ? run(*options) : 0;
        } catch (const simulation::ScenarioError& e) {
            throw UsageError(e.what());
        }
    });
}
