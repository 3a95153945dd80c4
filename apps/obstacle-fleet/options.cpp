// SPDX-License-Identifier: BSD-3-Clause
#include "options.h"

#include <CLI/CLI.hpp>

#include "common/input_choice.h"
#include "common/run_app.h"

namespace lidar_obstacles::fleet {
namespace {

constexpr const char* kDescription =
    "Finds the obstacles of thousands of recordings, under any scheduler, and merges them into one database.\n"
    "\n"
    "First a manifest: which recordings, with what parameters. Then any number of processes, on machines that share "
    "the\n"
    "output folder, each with its shard of it; what is done is not done again, what was cut off is taken up. At last "
    "the\n"
    "merge. The database has the same bytes whatever the shards were. Written to the output folder:\n"
    "  results/ab/<key>/  obstacles.csv, scans.csv, tracks.csv, timings.csv, result.json of a recording, whole or not "
    "there\n"
    "  fleet.sqlite       tables about, recordings, results, scans, obstacles, tracks, failures   (merge)\n"
    "  timings.sqlite     table timings                                                           (merge)\n"
    "  failures.csv       what failed, is damaged or not done yet, with the reason                (merge)\n"
    "  report.html        what was seen, strangest scans, drift against a baseline                (merge)\n"
    "  timings.html       slowest scans and recordings                                            (merge)\n"
    "  replays/           changed recordings, before and now side by side                         (merge --baseline)\n";

constexpr const char* kFooter =
    "Examples:\n"
    "  obstacle-fleet manifest /data/drives --config my.ini --output night.jsonl\n"
    "      all .rawlog, .pcap and .pcapng below that folder\n"
    "  obstacle-fleet run night.jsonl --output /data/night\n"
    "      all of it, in one process\n"
    "  obstacle-fleet run night.jsonl --output /data/night --shard 2/8\n"
    "      the third of eight parts; scripts/fleet_slurm.sh and fleet_parallel.sh start all of them\n"
    "  obstacle-fleet merge night.jsonl --output /data/night --baseline /data/last/fleet.sqlite\n"
    "      the database and the report, with what changed since\n"
    "\n"
    "Without --shard the part is that of SLURM_ARRAY_TASK_ID, of the rank of MPI (OMPI_COMM_WORLD_RANK, PMI_RANK) or "
    "of\n"
    "SLURM_PROCID; else it is all.\n"
    "Exit code: 0 all went well; 1 recordings failed, are damaged or not done yet (the others are there), or "
    "something\n"
    "cannot be read or written; 2 the command line or the configuration is not right; 130 interrupted (Ctrl-C, "
    "SIGTERM):\n"
    "the same command takes it up.\n";

/// The words of the input's options, as they go into the manifest.
std::vector<std::string> wordsOf(const CLI::App& app) {
    std::vector<std::string> words;
    for (const char* name : {"--sensor-label", "--sensor-pose", "--port", "--source", "--sensor-model"})
        for (const std::string& value : app.get_option(name)->results()) {
            words.emplace_back(name);
            words.push_back(value);
        }
    if (app.get_option("--points-in-vehicle")->count() > 0) words.emplace_back("--points-in-vehicle");
    return words;
}

CLI::App* addManifest(CLI::App& app, ManifestOptions& o, apps::InputChoice& choice) {
    CLI::App* sub =
        app.add_subcommand("manifest", "list recordings by their content, with what is to be done with them");
    sub->add_option("INPUT", o.inputs, "recordings, and folders to search for .rawlog, .pcap and .pcapng (also .gz)");
    sub->add_option("--list", o.list, "file with one of these in each line; - is the standard input")
        ->type_name("FILE");
    sub->add_option("--output", o.output, "the manifest")->type_name("FILE")->capture_default_str();
    sub->add_option("--config", o.config, "parameters; without it the built-in defaults")->type_name("FILE");
    sub->add_option("--set", o.set, "change one parameter; may be given again")
        ->type_name("SECTION.KEY=VALUE")
        ->allow_extra_args(false);
    apps::addInputChoice(*sub, choice);
    sub->add_option("--known", o.known,
                    "earlier manifest: what has the same place, size and time there is not read again; may be given\n"
                    "again. --output is one if it is there")
        ->type_name("FILE")
        ->allow_extra_args(false);
    sub->add_flag("--rehash", o.rehash, "read all recordings, also what --output knows");
    sub->add_option("--threads", o.threads, "read so many at the same time")
        ->type_name("N")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    return sub;
}

CLI::App* addRun(CLI::App& app, RunOptions& o) {
    CLI::App* sub = app.add_subcommand("run", "do what is not done yet of a shard");
    sub->add_option("MANIFEST", o.manifest, "written by `obstacle-fleet manifest`")->required();
    sub->add_option("--output", o.output, "folder for the results, shared by all shards")
        ->type_name("DIR")
        ->capture_default_str();
    sub->add_option("--shard", o.shard, "part I of N, counted from 0")->type_name("I/N");
    sub->add_flag("--retry-failed", o.retry_failed,
                  "also what failed for a reason in the recording itself: damage, a crash. What failed for another\n"
                  "(no such file, killed, out of memory, --timeout) is tried again anyway");
    sub->add_flag_callback(
        "--no-wait", [&o] { o.wait = false; }, "end where others are at the rest of the shard; else it is waited for");
    sub->add_option("--stale", o.stale, "a process that gave no sign of life for so long is dead")
        ->type_name("SECONDS")
        ->check(CLI::Range(1.0, 1e6))
        ->capture_default_str();
    sub->add_option("--timeout", o.timeout, "a recording that takes longer has failed; 0: none does")
        ->type_name("SECONDS")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    return sub;
}

CLI::App* addMerge(CLI::App& app, MergeOptions& o) {
    CLI::App* sub = app.add_subcommand("merge", "make databases and a report of the results");
    sub->add_option("MANIFEST", o.manifest, "as of the runs")->required();
    sub->add_option("--output", o.output, "folder with the results")->type_name("DIR")->capture_default_str();
    sub->add_option("--into", o.into, "folder for the databases and the report, else --output; for parts of a manifest")
        ->type_name("DIR");
    sub->add_option("--baseline", o.baseline, "fleet.sqlite of another merge, to say what changed")->type_name("FILE");
    sub->add_flag_callback(
        "--no-obstacles", [&o] { o.with_obstacles = false; },
        "leave the rows of obstacles where they are, in obstacles.csv: most of the database");
    sub->add_option("--replays", o.replays, "play so many of the recordings that changed most, before and now")
        ->type_name("N")
        ->check(CLI::Range(0, 999))
        ->capture_default_str();
    sub->add_option("--replay", o.replay, "the obstacle-replay that does; else the one beside this program")
        ->type_name("PROGRAM");
    sub->add_option("--baseline-replay", o.baseline_replay, "that of the baseline's version")->type_name("PROGRAM");
    return sub;
}

}  // namespace

std::optional<Options> parseOptions(int argc, char** argv) {
    Options o;
    apps::InputChoice choice;
    CLI::App app(kDescription, "obstacle-fleet");
    app.footer(kFooter);
    app.set_help_flag();
    app.set_help_all_flag("-h,--help", "print this help, of all commands or of one");
    app.set_version_flag("--version", "obstacle-fleet " LIDAR_OBSTACLES_VERSION);
    app.require_subcommand(1);
    const CLI::App* manifest = addManifest(app, o.manifest, choice);
    const CLI::App* run = addRun(app, o.run);
    addMerge(app, o.merge);
    if (!apps::parse(app, argc, argv)) return std::nullopt;
    o.command = manifest->parsed() ? Options::Command::Manifest
                : run->parsed()    ? Options::Command::Run
                                   : Options::Command::Merge;
    if (manifest->parsed()) {
        o.manifest.input_options = wordsOf(*manifest);
        if (o.manifest.inputs.empty() && o.manifest.list.empty())
            throw apps::UsageError("INPUT or --list is missing (see obstacle-fleet manifest --help)");
    }
    return o;
}

}  // namespace lidar_obstacles::fleet
