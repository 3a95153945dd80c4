// SPDX-License-Identifier: BSD-3-Clause
#include "options.h"

#include <CLI/CLI.hpp>

namespace lidar_obstacles::apps {
namespace {

constexpr const char* kDescription =
    "Follows any detector's boxes over the scans of a sequence: numbers that last, velocities, steady sizes.\n"
    "\n"
    "DETECTIONS has the columns of obstacles.csv: timestamp, scan_index, class, x, y, z, length, width, height, yaw,\n"
    "heading_valid, num_points, in the vehicle frame. Used where there: probability, faces, heading_std, num_rings,\n"
    "seen_length, seen_width, time_offset. TRACKS has those of obstacle-replay's obstacles.csv; id is the track's.\n";

constexpr const char* kFooter =
    "EGO is a CSV file with scan_index, timestamp, x, y, z, roll, pitch, yaw (vehicle to world), a row for each scan;\n"
    "its scans count, also those without boxes. With --standing the scans are those that have boxes.\n"
    "\n"
    "There are no clouds, so that nothing tells where beams should have hit a track: only boxes before it hide it.\n"
    "\n"
    "Examples:\n"
    "  obstacle-track detections.csv --ego ego.csv --output tracks.csv\n"
    "  obstacle-track detections.csv --standing --output tracks.csv --set tracking.max_hidden=5\n"
    "\n"
    "Keys of the configuration that count: [tracking], [ego].\n"
    "Exit code: 0 all went well; 1 a file cannot be read or written, or is not right; 2 the command line or the\n"
    "configuration is not right.\n";

}  // namespace

std::optional<Options> parseOptions(int argc, char** argv) {
    Options o;
    bool standing = false;
    CLI::App app(kDescription, "obstacle-track");
    app.footer(kFooter);
    app.add_option("DETECTIONS", o.detections, "boxes of each scan")->required();
    auto* ego = app.add_option("--ego", o.ego, "poses of the vehicle")->type_name("EGO");
    app.add_flag("--standing", standing, "the vehicle does not move")->excludes(ego);
    app.add_option("--output", o.output, "file to write")->type_name("TRACKS")->required();
    app.add_option("--config", o.config, "parameters; without it the built-in defaults")->type_name("FILE");
    app.add_option("--set", o.set, "change one parameter; may be given again")
        ->type_name("SECTION.KEY=VALUE")
        ->allow_extra_args(false);
    app.set_version_flag("--version", "obstacle-track " LIDAR_OBSTACLES_VERSION);
    if (!parse(app, argc, argv)) return std::nullopt;
    if (o.ego.empty() && !standing)
        throw UsageError("say how the vehicle moves: --ego EGO or --standing (see obstacle-track --help)");
    return o;
}

}  // namespace lidar_obstacles::apps
