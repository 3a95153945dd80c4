// SPDX-License-Identifier: BSD-3-Clause
#include "options.h"

#include <CLI/CLI.hpp>

#include "common/run_app.h"

namespace lidar_obstacles::apps {
namespace {

constexpr const char* kDescription =
    "Looks at some scans of a new sensor and says how it sits and what to set.\n"
    "\n"
    "Printed: height and tilt of the sensor, the share of the ground, rings, rate, the seam of a turn, the vehicle's "
    "own\n"
    "body, poses; then, where something should change, the options and the lines for config.ini that do it. Where no\n"
    "ground is found, it is looked for again as if the sensor hung upside down.\n";

constexpr const char* kFooter =
    "Examples:\n"
    "  obstacle-check drive.rawlog\n"
    "      the first 20 scans, with the built-in parameters\n"
    "  obstacle-check drive.rawlog --from 300 --scans 100 --config my.ini\n"
    "      a hundred scans of the drive, with own parameters: a slow vehicle shows its own body only in many scans\n"
    "  obstacle-check scans.pcap --sensor-pose 0,0,1.8,0,0,180\n"
    "      whether the pose of the sensor is right now\n"
    "\n"
    "Exit code: 0 the scans could be read, whatever was found in them; 1 the input is damaged; 2 the command line or "
    "the\n"
    "configuration is not right.\n";

}  // namespace

std::optional<Options> parseOptions(int argc, char** argv) {
    Options o;
    CLI::App app(kDescription, "obstacle-check");
    app.footer(kFooter);
    app.add_option("INPUT", o.input, "rawlog (plain or gzip) or Velodyne capture (pcap); - is the standard input")
        ->required();
    app.add_option("--config", o.config, "parameters; without it the built-in defaults")->type_name("FILE");
    addInputChoice(app, o.choice);
    app.add_option("--from", o.from, "number of the first scan")->type_name("N")->check(CLI::NonNegativeNumber);
    app.add_option("--scans", o.scans, "how many to look at")
        ->type_name("N")
        ->check(CLI::PositiveNumber)
        ->capture_default_str();
    app.add_option("--set", o.set, "change one parameter; may be given again")
        ->type_name("SECTION.KEY=VALUE")
        ->allow_extra_args(false);
    app.set_version_flag("--version", "obstacle-check " LIDAR_OBSTACLES_VERSION);
    if (!parse(app, argc, argv)) return std::nullopt;
    return o;
}

}  // namespace lidar_obstacles::apps
