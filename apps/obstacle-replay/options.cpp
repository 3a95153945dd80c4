// SPDX-License-Identifier: BSD-3-Clause
#include "options.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <iostream>

#include "common/number_text.h"

namespace lidar_obstacles::apps {
namespace {

constexpr const char* kDescription =
    "Finds obstacles in the lidar scans of a rawlog or a Velodyne capture.\n"
    "\n"
    "INPUT is read scan by scan. Written to the output folder:\n"
    "  obstacles.csv            one row per obstacle and scan (vehicle frame, metres, radians)\n"
    "  obstacles.jsonl          the same, one line of JSON per scan           (--format)\n"
    "  kitti_tracking.txt       tracks as the KITTI tracking benchmark        (--format)\n"
    "  kitti/NNNNNN.txt         the same, label files of the KITTI benchmark  (--format)\n"
    "  obstacles.mcap           points, grid, boxes, poses for Foxglove       (--format)\n"
    "  ply/NNNNNN.ply           points with class and track, boxes as edges   (--format)\n"
    "  matched_poses.csv        poses of the vehicle, where they are made of the scans (ego.source=matching)\n"
    "  summary.json             scans, returns, obstacles by class, times per stage, parameters\n"
    "  low_things.csv           one line per step, drop or missing ground and scan (low.enabled=true)\n"
    "  zones.csv                one line per zone and scan                  (--zones)\n"
    "  scene_NNNNNN.3Dscene     points, grid and boxes, for SceneViewer3D   (--scenes)\n"
    "  grid_NNNNNN.png, .yaml   occupancy grid, as ROS map_server reads it  (--grids)\n"
    "  picture_NNNNNN.png       the scene seen from behind the vehicle      (--pictures)\n"
    "NNNNNN is the scan's number in the input, counted from 0.\n";

constexpr const char* kFooter =
    "Examples:\n"
    "  obstacle-replay drive.rawlog\n"
    "      all scans with the built-in parameters; obstacles.csv and summary.json in output/\n"
    "  obstacle-replay drive.rawlog --output run1 --from 100 --to 200 --pictures all\n"
    "      scans 100 to 200, with a picture of each\n"
    "  obstacle-replay drive.rawlog --config config.ini --set grid.fine_resolution=0.1 --scenes 10\n"
    "      parameters from a file, one of them changed; a 3D scene of every 10th scan\n"
    "  obstacle-replay drive.rawlog --annotate drive_obstacles.rawlog\n"
    "      the recording with the boxes in it, for RawLogViewer\n"
    "  obstacle-replay drive.rawlog --report drive.html\n"
    "      the recording with its boxes as one file for any browser\n"
    "  obstacle-replay drive.rawlog --gui\n"
    "      the scans in a window; h shows the keys\n"
    "  obstacle-replay drive.rawlog --record drive.mp4 --layers raw,boxes,labels\n"
    "      the same as a video, no display needed\n"
    "  obstacle-replay drive.rawlog --learn-own-body\n"
    "      what the sensor sees of its own vehicle, as boxes for the configuration, in output/own_body.txt\n"
    "  obstacle-replay drive.pcap --sensor-pose 0,0,1.8,0,0,180\n"
    "      a capture of a sensor that hangs upside down 1.8 m above the ground\n"
    "  obstacle-replay robot.rawlog --sensor-label front,rear\n"
    "      two lidars as one, at the times of the first; each return keeps its own ray\n"
    "  obstacle-replay --print-config > config.ini\n"
    "      all parameters with their meaning, range and default\n"
    "\n"
    "Exit code: 0 all went well; 1 the input is damaged or nothing can be written (what stands before\n"
    "the damage is processed and written); 2 the command line or the configuration is not right; 130 interrupted\n"
    "(Ctrl-C): all files are whole and hold the scans up to there.\n"
    "What an earlier run left in the output folder is taken away first.\n";

/// "none", "all" or a positive number k.
Selection readSelection(const std::string& option, const std::string& word) {
    if (word == "none") return {0};
    if (word == "all") return {1};
    Selection selection;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), selection.every);
    if (error != std::errc() || end != word.data() + word.size() || selection.every < 1) {
        throw UsageError(option + " " + word + ": must be none, all or a number k (every k-th scan)");
    }
    return selection;
}

struct SelectionWords {
    std::string scenes = "none";
    std::string grids = "none";
    std::string pictures = "none";
    std::vector<std::string> formats = {"csv"};
    std::vector<std::string> classes;
    std::string view;
};

/// "X,Y,DISTANCE,AZIMUTH,ELEVATION"; the usual view from behind for "".
CameraView readView(const std::string& words) {
    CameraView view;
    if (words.empty()) return view;
    const std::vector<double> numbers = readNumbers(words);
    if (numbers.size() != 5 || !(numbers[2] > 0.0)) {
        throw UsageError("--view " + words +
                         ": must be X,Y,DISTANCE,AZIMUTH,ELEVATION, five numbers, DISTANCE above 0");
    }
    view.target = {numbers[0], numbers[1], 0.0};
    view.distance = numbers[2];
    view.azimuth_deg = numbers[3];
    view.elevation_deg = numbers[4];
    return view;
}

void addInputOptions(CLI::App& app, Options& o) {
    app.add_option("INPUT", o.input, "rawlog (plain or gzip) or Velodyne capture (pcap); - is the standard input");
    app.add_option("--config", o.config, "parameters; without it the built-in defaults")->type_name("FILE");
    app.add_option("--output", o.output, "folder for the results, made if missing")
        ->type_name("DIR")
        ->capture_default_str();
    addInputChoice(app, o.choice);
    app.add_option("--planes", o.planes, "keep N of the sensor's rings; same as --set sensor.planes=N")->type_name("N");
    app.add_option("--from", o.from, "number of the first scan")->type_name("N")->check(CLI::NonNegativeNumber);
    app.add_option("--to", o.to, "number of the last scan")->type_name("N")->check(CLI::NonNegativeNumber);
    app.add_option("--every", o.every, "only every K-th scan")->type_name("K")->check(CLI::PositiveNumber);
    app.add_option("--set", o.set, "change one parameter; may be given again")
        ->type_name("SECTION.KEY=VALUE")
        ->allow_extra_args(false);
}

void addOptions(CLI::App& app, Options& o, SelectionWords& words) {
    addInputOptions(app, o);
    app.add_option("--format", words.formats,
                   "formats of the obstacles, several with commas: csv, jsonl, kitti, kitti-tracking, mcap, ply")
        ->delimiter(',')
        ->type_name("FORMAT,..")
        ->allow_extra_args(false)
        ->capture_default_str();
    app.add_option("--classes", words.classes, kClassesHelp)
        ->delimiter(',')
        ->type_name("CLASS,..")
        ->allow_extra_args(false);
    app.add_option("--zones", o.zones, "zones to watch: their states go to zones.csv, obstacles.jsonl and summary.json")
        ->type_name("FILE.yaml");
    app.add_option("--annotate", o.annotate, "copy of the recording with a 3D scene behind each scan, for RawLogViewer")
        ->type_name("OUT.rawlog");
    app.add_option("--report", o.report,
                   "one HTML file that plays in any browser: points, grid, boxes, tracks, plots; at most some 30 MB")
        ->type_name("OUT.html");
    const std::string which = "none|all|K";
    app.add_option("--scenes", words.scenes, "3D scenes: none, all or of every K-th scan")->type_name(which);
    app.add_option("--grids", words.grids, "occupancy grids, likewise")->type_name(which);
    app.add_option("--pictures", words.pictures, "pictures, likewise")->type_name(which);
    app.add_option("--view", words.view,
                   "where pictures are taken from: a point of the ground, metres away from it, degrees")
        ->type_name("X,Y,DISTANCE,AZIMUTH,ELEVATION");
    app.add_flag(
        "--explain", o.explain,
        "draw where each box comes from into scenes and pictures: hull, corners A B C D, line; rule, rings, returns;\n"
        "the merges of pieces that were weighed, taken (green) or refused (red), and list them in merges.csv");
    app.add_flag(
        "--learn-own-body", o.learn_own_body,
        "find what stays in place around the moving vehicle, in all processed scans, and write it as boxes to\n"
        "own_body.txt: --set region.own_body=@DIR/own_body.txt then leaves it out");
    addViewOptions(app, o.show);
    app.add_flag("--print-config", o.print_config, "print the parameters as a config file and stop");
    app.set_version_flag("--version", "obstacle-replay " LIDAR_OBSTACLES_VERSION);
}

}  // namespace

std::optional<Options> parseOptions(int argc, char** argv) {
    Options o;
    SelectionWords words;
    CLI::App app(kDescription, "obstacle-replay");
    app.footer(kFooter);
    addOptions(app, o, words);
    if (!parse(app, argc, argv)) return std::nullopt;
    o.scenes = readSelection("--scenes", words.scenes);
    o.grids = readSelection("--grids", words.grids);
    o.pictures = readSelection("--pictures", words.pictures);
    o.view = readView(words.view);
    o.classes = parseClasses(words.classes);
    try {
        o.formats = parseFormats(words.formats);
    } catch (const std::invalid_argument& e) {
        throw UsageError(e.what());
    }
    finishViewOptions(o.show);
    if (o.input.empty() && !o.print_config) throw UsageError("INPUT is missing (see obstacle-replay --help)");
    if (o.show.gui && o.choice.joins()) throw UsageError("--gui shows one lidar: choose one with --sensor-label");
    if (o.to < o.from) throw UsageError("--to " + std::to_string(o.to) + " is before --from " + std::to_string(o.from));
    return o;
}

}  // namespace lidar_obstacles::apps
