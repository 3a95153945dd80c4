// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacle-check: how a new sensor sits and what it sees. Parses, wires, reports.
#include <cstdio>
#include <stdexcept>
#include <string>

#include "common/address_space.h"
#include "common/read_params.h"
#include "common/rereadable_input.h"
#include "common/run_app.h"
#include "lidar_obstacles/mrpt_bridge/ego_motion.h"
#include "look.h"
#include "options.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;

constexpr double kLevel = 2.0 * M_PI / 180.0;  // a mount is level within; roads are not flatter [rad]

/// As the input says; where no ground is found so, upside down if it is found then.
Look lookBothWays(const Options& options, const DetectorParams& params, bool& upside_down) {
    Look look = lookAt(options, params);
    upside_down = false;
    if (2 * look.report.with_ground >= look.report.scans || options.choice.joins()) return look;
    Look turned = lookAt(options, params, mrpt::poses::CPose3D(0.0, 0.0, 0.0, 0.0, 0.0, M_PI));
    upside_down = 2 * turned.report.with_ground >= turned.report.scans;
    return upside_down ? turned : look;
}

/// What to set, or that all is well.
void printAdvice(const Look& look, bool upside_down, const EgoSource& ego, const DetectorParams& params) {
    std::string options;
    if (upside_down)
        options += "  --sensor-pose " + levelPose(look) + "   # it hangs upside down, the input does not say so\n";
    else if (look.report.height && look.report.tilt > kLevel)
        options += "  --sensor-pose " + levelPose(look) + "   # if the mount is tilted, not the road\n";
    else if (!look.report.height)
        options += "  --sensor-pose X,Y,Z,YAW,PITCH,ROLL   # where the sensor sits: as it is, no ground is seen\n";
    std::string settings;
    for (const std::string& line : settingsFor(look.report, params)) settings += "  " + line + "\n";
    if (ego.kind == EgoKind::None && look.report.scans > 1)
        settings += "  ego.source = matching   # there are no poses: make them of the scans\n";
    if (!options.empty()) std::printf("\nOptions of the tools:\n%s", options.c_str());
    if (!settings.empty()) std::printf("\nTo set in config.ini, or with --set:\n%s", settings.c_str());
    if (options.empty() && settings.empty()) std::printf("\nNothing to set: the parameters fit.\n");
}

int run(const Options& options) {
    const DetectorParams params = readParams(options.config, options.set);
    bool upside_down = false;
    const Look look = lookBothWays(options, params, upside_down);
    const EgoSource ego = chooseEgoSource(options.input, params.ego.source);
    if (!look.remarks.empty()) std::fprintf(stderr, "obstacle-check: %s\n", look.remarks.c_str());
    if (!look.lidar.empty()) std::printf("lidar: '%s'\n", look.lidar.c_str());
    for (const std::string& line : toLines(look.report)) std::printf("%s\n", line.c_str());
    std::printf("poses: %s%s\n", toString(ego.kind), isRead(ego.kind) ? (" of '" + ego.label + "'").c_str() : "");
    printAdvice(look, upside_down, ego, params);
    if (!look.damage.empty()) throw std::runtime_error(look.damage);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("obstacle-check", [&] {
        capAddressSpace();
        auto options = parseOptions(argc, argv);
        if (!options) return 0;
        const RereadableInput input(options->input);
        options->input = input.path();
        return run(*options);
    });
}
