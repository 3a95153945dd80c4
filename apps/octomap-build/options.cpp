// SPDX-License-Identifier: BSD-3-Clause
#include "options.h"

#include <CLI/CLI.hpp>

namespace lidar_obstacles::apps {
namespace {

constexpr const char* kDescription =
    "Builds a map of what stands still from a rawlog with poses, for [octomap] mode = static.\n"
    "\n"
    "A voxel that most scans hit is occupied; one that most scans look through is free: what drove away is not in the\n"
    "map. Leaves and fences, which let most beams through, stay if they are hit again and again. Up to a quarter of a\n"
    "second per scan. MAP.bt holds occupied and free, MAP.ot probabilities; octovis shows both.\n";

constexpr const char* kFooter =
    "Examples:\n"
    "  octomap-build drive.rawlog route.bt\n"
    "      voxels of 0.2 m from all scans\n"
    "  octomap-build drive.rawlog route.bt --every 5 --set octomap.resolution=0.1\n"
    "      a finer map from every fifth scan\n"
    "  obstacle-replay again.rawlog --set octomap.mode=static --set octomap.map=route.bt --set ego.source=ego_rtk\n"
    "      only what is not in the map; its poses must be in the frame of those that the map was built with\n"
    "\n"
    "Keys of the configuration that count: [sensor], [ego], [octomap] resolution and range.\n"
    "Exit code: 0 all went well; 1 the input is damaged (what stands before is in the map), some scans cannot be "
    "right\n"
    "(the others are in the map) or nothing can be written; 2 the command line or the configuration is not right, or\n"
    "the input has no poses; 130 interrupted (Ctrl-C): the map holds the scans up to there.\n";

}  // namespace

std::optional<Options> parseOptions(int argc, char** argv) {
    Options o;
    CLI::App app(kDescription, "octomap-build");
    app.footer(kFooter);
    app.add_option("INPUT", o.input, "rawlog with lidar scans and poses")->required();
    app.add_option("MAP", o.output, "file to write, .bt or .ot")->required();
    app.add_option("--config", o.config, "parameters; without it the built-in defaults")->type_name("FILE");
    addInputChoice(app, o.choice);
    app.add_option("--from", o.from, "number of the first scan")->type_name("N")->check(CLI::NonNegativeNumber);
    app.add_option("--to", o.to, "number of the last scan")->type_name("N")->check(CLI::NonNegativeNumber);
    app.add_option("--every", o.every, "only every K-th scan")->type_name("K")->check(CLI::PositiveNumber);
    app.add_option("--set", o.set, "change one parameter; may be given again")
        ->type_name("SECTION.KEY=VALUE")
        ->allow_extra_args(false);
    app.set_version_flag("--version", "octomap-build " LIDAR_OBSTACLES_VERSION);
    if (!parse(app, argc, argv)) return std::nullopt;
    const std::string end = o.output.size() < 3 ? "" : o.output.substr(o.output.size() - 3);
    if (end != ".bt" && end != ".ot") throw UsageError(o.output + ": the name of the map must end with .bt or .ot");
    if (o.to < o.from) throw UsageError("--to " + std::to_string(o.to) + " is before --from " + std::to_string(o.from));
    return o;
}

}  // namespace lidar_obstacles::apps
