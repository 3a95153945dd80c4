// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacle-fleet: obstacles of thousands of recordings. Parses, wires, reports.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <opencv2/core/utility.hpp>

#include "common/address_space.h"
#include "common/interrupt.h"
#include "common/read_params.h"
#include "common/run_app.h"
#include "find_recordings.h"
#include "manifest.h"
#include "options.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::fleet;

std::vector<Manifest> knownManifests(const ManifestOptions& options) {
    std::vector<Manifest> known;
    known.reserve(options.known.size() + 1);
    for (const std::string& file : options.known) known.push_back(readManifest(file));
    if (!options.rehash && std::filesystem::exists(options.output)) known.push_back(readManifest(options.output));
    return known;
}

int listRecordings(const ManifestOptions& options) {
    const Settings settings = makeSettings(apps::readParams(options.config, options.set), options.input_options);
    const std::vector<std::string> names = findRecordings(options.inputs, options.list);
    const Manifest manifest = makeManifest(settings, names, knownManifests(options), options.threads);
    writeManifest(options.output, manifest);
    std::size_t bad = 0;
    double bytes = 0.0;
    for (const Recording& r : manifest.recordings) {
        bytes += static_cast<double>(r.stamp.bytes);
        if (r.error.empty()) continue;
        ++bad;
        std::fprintf(stderr, "obstacle-fleet: %s: %s\n", r.name.c_str(), r.error.c_str());
    }
    std::printf("%zu recordings, %.3f GB: see %s\n", names.size(), bytes / 1e9, options.output.c_str());
    if (bad == 0) return 0;
    std::fprintf(stderr, "obstacle-fleet: %zu recordings could not be read; the manifest says so\n", bad);
    return 1;
}

int runOne(const RunOptions& options) {
    apps::catchInterrupts();
    const RunReport report = runShard(options);
    std::printf("%zu recordings: %zu done now, %zu before, %zu of these failed, %zu left\n", report.recordings,
                report.done, report.before, report.failed, report.left);
    if (apps::isInterrupted() && report.left > 0) {
        std::fputs("obstacle-fleet: interrupted; the same command takes it up\n", stderr);
        return apps::kInterruptedCode;
    }
    return report.failed + report.left > 0 ? 1 : 0;
}

int mergeShards(MergeOptions options) {
    if (options.into.empty()) options.into = options.output;
    const MergeReport report = fleet::merge(options);
    std::printf("%zu recordings, %zu failed or damaged, %zu not done yet, %zu rows: see %s\n", report.recordings,
                report.failed, report.missing, report.rows, (options.into / "report.html").c_str());
    if (!options.baseline.empty())
        std::printf("%zu recordings changed against %s\n", report.changed, options.baseline.c_str());
    return report.failed + report.missing > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
    return apps::runApp("obstacle-fleet", [&] {
        capAddressSpace();
        cv::setNumThreads(1);  // one core for each process
        const auto options = parseOptions(argc, argv);
        if (!options) return 0;
        switch (options->command) {
            case Options::Command::Manifest:
                return listRecordings(options->manifest);
            case Options::Command::Run:
                return runOne(options->run);
            case Options::Command::Merge:
                break;
        }
        return mergeShards(options->merge);
    });
}
