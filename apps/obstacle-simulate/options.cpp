// SPDX-License-Identifier: BSD-3-Clause
#include "options.h"

#include <CLI/CLI.hpp>
#include <cmath>

namespace lidar_obstacles::apps {
namespace {

constexpr const char* kDescription =
    "Simulates a drive with a VLP-16: a rawlog as the sensor would record it, and the truth.\n"
    "\n"
    "SCENARIO is a YAML file, see datasets/scenarios/; or --random draws one. Written:\n"
    "  PREFIX.rawlog      packets of the lidar, pose of the vehicle at 20 Hz (RTK-like); --odometry: of its wheels, "
    "too\n"
    "  PREFIX_gt.csv      every object in every scan: box, velocity, returns, visible faces, occlusion\n"
    "  PREFIX_static.csv  walls, trees, poles ... (world frame)\n"
    "  PREFIX_ego.csv     exact pose of the vehicle in every scan\n"
    "  PREFIX_labels.bin  what every return hit: object or clutter, and its kind (see datasets/scenarios/README.md)\n";

constexpr const char* kFooter =
    "Examples:\n"
    "  obstacle-simulate datasets/scenarios/monza.yaml --output output/monza\n"
    "      the whole lap, 300 s\n"
    "  obstacle-simulate datasets/scenarios/street.yaml --from 10 --to 20 --stride 4 --seed 7 --output output/s\n"
    "      ten seconds of it, every fourth turn of the sensor, other noise\n"
    "  obstacle-simulate datasets/scenarios/street.yaml --rain 0.05 --mount-error 0,0,0.02,0.5,1,0 --output output/r\n"
    "      rain, and a sensor that is not quite where the recording says\n"
    "  obstacle-simulate --random car-park --seed 7 --planes 8 --output output/p\n"
    "      four seconds in a car park that no one has seen before; another seed, another car park\n"
    "\n"
    "The same scenario, options and seed give the same files, byte for byte, on any number of threads.\n"
    "Exit code: 0 all went well; 1 nothing can be written; 2 the command line or the scenario is not right;\n"
    "130 interrupted (Ctrl-C): the files hold whole scans up to there.\n";

/// What is looked at after the command line was read.
struct Words {
    std::vector<double> mount, mount_error;  ///< six numbers each
    std::string random;                      ///< kind of scene
};

std::vector<std::string> sceneNames() {
    std::vector<std::string> names;
    for (simulation::RandomScene kind : simulation::randomScenes()) names.emplace_back(toString(kind));
    return names;
}

void addOptions(CLI::App& app, Options& o, Words& words) {
    CLI::Option* file = app.add_option("SCENARIO", o.scenario, "scenario file");
    app.add_option("--random", words.random, "draw a scene from the seed instead of reading a file")
        ->type_name("KIND")
        ->check(CLI::IsMember(sceneNames()))
        ->excludes(file);
    app.add_option("--output", o.output, "prefix of the files; the folder is made if missing")
        ->type_name("PREFIX")
        ->capture_default_str();
    app.add_option("--seed", o.run.seed, "of all noise; of the scene too with --random")
        ->type_name("N")
        ->capture_default_str();
    app.add_option("--from", o.run.from, "begin there")->type_name("SECONDS")->check(CLI::NonNegativeNumber);
    app.add_option("--to", o.run.to, "end there")->type_name("SECONDS")->check(CLI::NonNegativeNumber);
    app.add_option("--stride", o.run.stride, "record every K-th turn of the sensor")
        ->type_name("K")
        ->check(CLI::PositiveNumber);
    app.add_option("--threads", o.run.threads, "how many; by default as many as there are cores")
        ->type_name("N")
        ->check(CLI::Range(1, 256));
    app.add_flag("--odometry", o.odometry, "record wheel odometry as well, at 20 Hz");
    app.add_option("--planes", o.planes, "rings of the sensor")->type_name("16|8|4")->check(CLI::IsMember({16, 8, 4}));
    app.add_option("--rate", o.rate, "turns per second")->type_name("HZ")->check(CLI::Range(5.0, 20.0));
    app.add_option("--rain", o.rain, "share of shots that a drop or dust sends back")
        ->type_name("SHARE")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--height", o.height, "of the sensor above the ground")
        ->type_name("M")
        ->check(CLI::Range(0.05, 10.0));
    app.add_option("--mount", words.mount, "where the sensor sits on the vehicle, in metres and degrees")
        ->type_name("X,Y,Z,YAW,PITCH,ROLL")
        ->delimiter(',');
    app.add_option("--mount-error", words.mount_error,
                   "what the recorded pose of the sensor does not know, in metres and degrees")
        ->type_name("X,Y,Z,YAW,PITCH,ROLL")
        ->delimiter(',');
    app.set_version_flag("--version", "obstacle-simulate " LIDAR_OBSTACLES_VERSION);
}

std::optional<simulation::Pose6> toPose(const std::string& option, const std::vector<double>& numbers) {
    if (numbers.empty()) return std::nullopt;
    if (numbers.size() != 6)
        throw UsageError(option + ": must be six numbers X,Y,Z,YAW,PITCH,ROLL, not " + std::to_string(numbers.size()));
    for (double n : numbers)
        if (!(std::abs(n) <= 180.0)) throw UsageError(option + ": numbers must lie within -180 and 180");
    constexpr double kDegree = M_PI / 180.0;
    return simulation::Pose6{
        {numbers[0], numbers[1], numbers[2]}, numbers[3] * kDegree, numbers[4] * kDegree, numbers[5] * kDegree};
}

}  // namespace

std::optional<Options> parseOptions(int argc, char** argv) {
    Options o;
    Words words;
    CLI::App app(kDescription, "obstacle-simulate");
    app.footer(kFooter);
    addOptions(app, o, words);
    if (!parse(app, argc, argv)) return std::nullopt;
    o.mount = toPose("--mount", words.mount);
    o.mount_error = toPose("--mount-error", words.mount_error);
    o.random = simulation::randomSceneNamed(words.random);
    if (o.random.has_value() != o.scenario.empty()) throw UsageError("give a SCENARIO file or --random KIND");
    if (!(o.run.from < o.run.to)) throw UsageError("--to must be later than --from");
    return o;
}

simulation::Scenario scenarioOf(const Options& options) {
    if (!options.random) return simulation::loadScenario(options.scenario);
    return simulation::randomScenario(*options.random, options.run.seed);
}

simulation::Scenario changed(simulation::Scenario scenario, const Options& options) {
    simulation::SensorSpec& sensor = scenario.sensor;
    sensor.planes = options.planes.value_or(sensor.planes);
    sensor.rate = options.rate.value_or(sensor.rate);
    for (simulation::SensorSpec& other : scenario.more_sensors) other.rate = sensor.rate;
    sensor.rain = options.rain.value_or(sensor.rain);
    sensor.pose = options.mount.value_or(sensor.pose);
    sensor.pose.position.z() = options.height.value_or(sensor.pose.position.z());
    sensor.mount_error = options.mount_error.value_or(sensor.mount_error);
    return scenario;
}

}  // namespace lidar_obstacles::apps
