// SPDX-License-Identifier: BSD-3-Clause
#include "options.h"

#include <CLI/CLI.hpp>

#include "common/run_app.h"

namespace lidar_obstacles::apps {
namespace {

constexpr const char* kDescription =
    "Sends the packets of a recording as the sensor does: over UDP, at its rate, over and over.\n"
    "\n"
    "Whole turns are taken from the recording; the packets' clock is rewritten, so that it runs on. The shares of\n"
    "faults are drawn at random, the same for the same seed; the first and last ten packets have none. At the end\n"
    "what was done is printed as one line of JSON.\n";

constexpr const char* kFooter =
    "Example:\n"
    "  velodyne-send drive.rawlog --duration 120 --drop 0.05 --duplicate 0.05 --reorder 0.05 --garbage 0.05\n"
    "\n"
    "Exit code: 0 all went well; 1 the input is damaged (its whole turns are sent) or nothing can be sent; 2 the\n"
    "command line is not right; 130 interrupted (Ctrl-C).\n";

}  // namespace

std::optional<Options> parseOptions(int argc, char** argv) {
    Options o;
    std::string to, from;
    CLI::App app(kDescription, "velodyne-send");
    app.footer(kFooter);
    app.add_option("INPUT", o.input,
                   "rawlog or capture with packets of a sensor that obstacle-live reads; its first 600 turns are sent")
        ->required();
    app.add_option("--to", to, "default 127.0.0.1:2368")->type_name("ADDRESS[:PORT]");
    app.add_option("--from", from, "address of this machine to send from")->type_name("ADDRESS");
    app.add_option("--duration", o.duration, "[s]")->check(CLI::PositiveNumber)->capture_default_str();
    app.add_flag("--dual", o.dual, "dual return, twice the packets: both returns are those of the recording");
    const auto share = CLI::Range(0.0, 0.25);
    app.add_option("--drop", o.faults.drop, "share of packets not sent")->check(share);
    app.add_option("--duplicate", o.faults.duplicate, "share of packets sent twice")->check(share);
    app.add_option("--reorder", o.faults.reorder, "share of packets sent one to four packets late")->check(share);
    app.add_option("--garbage", o.faults.garbage, "datagrams of other content per packet")->check(share);
    app.add_option("--seed", o.seed, "of the faults")->capture_default_str();
    app.set_version_flag("--version", "velodyne-send " LIDAR_OBSTACLES_VERSION);
    if (!parse(app, argc, argv)) return std::nullopt;
    if (!to.empty()) o.to = live::parseEndpoint(to, {});
    if (!from.empty()) o.from = live::parseAddress(from);
    return o;
}

}  // namespace lidar_obstacles::apps
