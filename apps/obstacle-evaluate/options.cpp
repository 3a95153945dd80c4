// SPDX-License-Identifier: BSD-3-Clause
#include "options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;
using evaluation::TruthPose;

constexpr const char* kDescription =
    "Holds obstacles against labelled truth: runs the detector on rawlogs, or takes existing obstacles.csv files.\n"
    "\n"
    "Written to the output folder:\n"
    "  metrics.json         recall, errors, rates, per range and type, with 95 % intervals (bootstrap over objects);\n"
    "                       F1 and calibration of the classes, HOTA, MOTA, velocities, near objects without any box\n"
    "  objects.csv          one row per object: how often it was asked for and found, its mean errors\n"
    "  matches.csv          one row per object and scan\n"
    "  SET/obstacles.csv    what the detector found\n"
    "  report.html          tables, plots and the worst scans as pictures, in one file\n"
    "  replays/             pages that play the worst scans, linked from it\n"
    "\n"
    "obstacle-evaluate monza ... is the paper's experiment: distance, relative heading and velocity of one vehicle "
    "over time\n"
    "(fig_16_plane, fig_8_plane as .png and .svg) and the table of its mean errors (monza.json, monza.html).\n";

constexpr const char* kFooter =
    "Examples:\n"
    "  obstacle-evaluate --rawlog drive.rawlog --truth drive_gt.csv --fov 80 --output output/drive\n"
    "      a set whose labels cover 80 degrees ahead\n"
    "  obstacle-evaluate --prefix sets/street --prefix sets/park --jobs 2\n"
    "      street.rawlog, street_gt.csv, and street_static.csv, street_ego.csv where they exist; likewise park\n"
    "  obstacle-evaluate --detections output/obstacles.csv --truth drive_gt.csv\n"
    "      what any detector found; with --rawlog as well, the worst scans are drawn\n"
    "  obstacle-evaluate monza --prefix sets/monza --jobs 2\n"
    "  obstacle-evaluate monza --prefix sets/monza --variant 16_plane:sensor.planes=16 \\\n"
    "      --variant fine:sensor.planes=16,grid.fine_resolution=0.1\n"
    "      the same with two variants of one's own\n"
    "\n"
    "Exit code: 0 all went well; 1 a file is damaged, not right, or cannot be written; 2 the command line or the\n"
    "configuration is not right; 130 interrupted (Ctrl-C): the numbers are those of the scans up to there, and there "
    "is\n"
    "no report.html.\n"
    "Plots want the program gnuplot; without it the rest is written. What an earlier evaluation left in the output\n"
    "folder is taken away first.\n";

/// What the command line says, as words.
struct Words {
    std::vector<std::string> rawlogs;
    std::vector<std::string> truths;
    std::vector<std::string> detections;
    std::vector<std::string> prefixes;
    std::string statics;
    std::string ego;
    std::string roi;
    std::vector<std::string> variants;
    std::string planes;
    std::vector<std::string> ignore;
    bool no_report = false;
};

const std::map<std::string, TruthPose>& poseNames() {
    static const std::map<std::string, TruthPose> names = {{"ref", TruthPose::Reference},
                                                           {"mid", TruthPose::MidScan},
                                                           {"obs", TruthPose::Observed},
                                                           {"ego", TruthPose::EgoCorrected}};
    return names;
}

void addInputs(CLI::App& app, Words& w) {
    const auto many = [&](const char* name, std::vector<std::string>& to, const char* text) {
        return app.add_option(name, to, text)->type_name("FILE")->allow_extra_args(false);
    };
    many("--prefix", w.prefixes,
         "PREFIX.rawlog, PREFIX_gt.csv and, where they exist, PREFIX_static.csv, PREFIX_ego.csv")
        ->type_name("PREFIX");
    many("--rawlog", w.rawlogs, "a recording; may be given again, in the order of --truth");
    many("--truth", w.truths, "its labels");
    many("--detections", w.detections, "judge this obstacles.csv, do not run the detector");
    app.add_option("--static", w.statics, "what stands there unlabelled (one set only)")->type_name("FILE");
    app.add_option("--ego", w.ego, "the vehicle's pose in every scan (one set only)")->type_name("FILE");
}

void addDetector(CLI::App& app, EvaluateOptions& o, Words& w) {
    app.add_option("--config", o.config, "parameters; without it the built-in defaults")->type_name("FILE");
    app.add_option("--planes", w.planes, "keep N of the sensor's rings; same as --set sensor.planes=N")->type_name("N");
    app.add_option("--set", o.set, "change one parameter; may be given again")
        ->type_name("SECTION.KEY=VALUE")
        ->allow_extra_args(false);
    addInputChoice(app, o.choice);
}

void addQuestion(CLI::App& app, EvaluateOptions& o, Words& w) {
    evaluation::EvaluationOptions& e = o.evaluation;
    app.add_option_function<std::string>(
           "--gt-pose", [&o](const std::string& word) { o.pose = poseNames().at(word); },
           "truth at the scan's timestamp (ref), at mid scan (mid), when the laser saw the object (obs), or the "
           "same told in the vehicle frame of the timestamp, for a detector that undoes ego motion (ego)")
        ->check(CLI::IsMember(poseNames()))
        ->default_str("obs");
    app.add_option("--points-col", o.points_column, "column that counts returns")->capture_default_str();
    app.add_option("--min-points", e.min_points, "objects with fewer returns are not asked for")->capture_default_str();
    app.add_option("--max-range", e.max_range, "nor those farther than this [m]")->capture_default_str();
    app.add_option("--near", e.near, "objects as near as this are counted where no box covers them [m]")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--fov", e.fov_deg, "nor those outside this sector ahead [deg]")
        ->check(CLI::Range(1.0, 360.0))
        ->capture_default_str();
    app.add_option("--roi", w.roi, "box centres within XMIN,XMAX,YMIN,YMAX [m] (write --roi=-5,...)");
    app.add_option("--target", e.target, "figures of one object: a type (its object with most rows) or id:N");
    app.add_option("--skip-first", e.skip_first, "seconds left out at the beginning");
    app.add_option("--min-iou", e.match.min_iou, "overlap that lets a pair match")->capture_default_str();
    app.add_option("--max-dist", e.match.max_distance, "or distance of the centres [m]")->capture_default_str();
    app.add_option("--max-dist-ped", e.match.max_distance_small, "the same for people [m]")->capture_default_str();
    app.add_flag("--class-aware", e.match.class_aware, "detections with a class match their group only");
    app.add_option("--ignore", w.ignore, "types that are neither wanted nor false")
        ->delimiter(',')
        ->default_str("ignore,dontcare,misc");
    app.add_flag("--structure", e.structure, "count boxes of class structure too (they claim no road user)");
    app.add_flag("--match-by-index", e.match_by_index, "tell scans by scan_index instead of by time");
    app.add_option("--tol", e.time_tolerance, "a detection belongs to a scan not farther than this [s]")
        ->capture_default_str();
    app.add_flag("--only-with-det", e.only_scans_with_detections, "leave out scans without any detection");
}

void addOutputs(CLI::App& app, EvaluateOptions& o, Words& w) {
    app.add_option("--output", o.output, "folder for the results, made if missing")
        ->type_name("DIR")
        ->capture_default_str();
    app.add_option("--jobs", o.jobs, "sets worked on at a time; does not change the numbers")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    app.add_option("--bootstrap", o.bootstrap.replicates, "replicates of the intervals; 0: none")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_option("--seed", o.bootstrap.seed, "of the bootstrap")->capture_default_str();
    app.add_option("--worst", o.worst, "how many of the worst scans are drawn")
        ->check(CLI::NonNegativeNumber)
        ->capture_default_str();
    app.add_flag("--no-report", w.no_report, "numbers only: no plots, no pictures, no report.html");
    app.set_version_flag("--version", "obstacle-evaluate " LIDAR_OBSTACLES_VERSION);
}

std::string nameOf(const std::string& file) {
    std::string name = fs::path(file).stem().string();
    const std::string tail = "_gt";
    if (name.size() > tail.size() && name.compare(name.size() - tail.size(), tail.size(), tail) == 0)
        name.resize(name.size() - tail.size());
    return name.empty() ? "set" : name;
}

SetFiles filesOfPrefix(const std::string& prefix) {
    const auto existing = [&](const std::string& tail) { return fs::exists(prefix + tail) ? prefix + tail : ""; };
    SetFiles files;
    files.name = fs::path(prefix).filename().string();
    files.rawlog = prefix + ".rawlog";
    files.truth = prefix + "_gt.csv";
    files.statics = existing("_static.csv");
    files.ego = existing("_ego.csv");
    return files;
}

/// What each set has of its own, and what goes with a single one.
void addOtherFiles(std::vector<SetFiles>& sets, const Words& w) {
    for (std::size_t k = 0; k < sets.size(); ++k) {
        if (!w.rawlogs.empty()) sets[k].rawlog = w.rawlogs[k];
        if (!w.detections.empty()) {
            sets[k].detections = w.detections[k];
            if (w.rawlogs.empty() && !fs::exists(sets[k].rawlog)) sets[k].rawlog.clear();  // then there are no pictures
        }
        if (!w.statics.empty()) sets[k].statics = w.statics;
        if (!w.ego.empty()) sets[k].ego = w.ego;
    }
}

/// --prefix, or --truth with --rawlog or --detections. @throws UsageError where they do not go together.
std::vector<SetFiles> setsOf(const Words& w) {
    std::vector<SetFiles> sets;
    if (!w.prefixes.empty() && !(w.truths.empty() && w.rawlogs.empty()))
        throw UsageError("--prefix names rawlog and truth: leave out --rawlog and --truth");
    std::transform(w.prefixes.begin(), w.prefixes.end(), std::back_inserter(sets), filesOfPrefix);
    for (const std::string& truth : w.truths) sets.push_back({nameOf(truth), "", truth, "", "", ""});
    if (sets.empty()) throw UsageError("nothing to evaluate: give --prefix, or --truth with --rawlog or --detections");
    const auto require = [&](const char* option, std::size_t count) {
        if (count == sets.size()) return;
        throw UsageError(std::to_string(sets.size()) + " truths but " + std::to_string(count) + " " + option);
    };
    if (!w.rawlogs.empty()) require("--rawlog", w.rawlogs.size());
    if (!w.detections.empty()) require("--detections", w.detections.size());
    if (w.prefixes.empty() && w.rawlogs.empty() && w.detections.empty())
        throw UsageError("--truth needs a --rawlog or --detections");
    if (sets.size() > 1 && !(w.statics.empty() && w.ego.empty()))
        throw UsageError("--static and --ego go with one set; several take them from --prefix");
    if (!w.statics.empty() && w.ego.empty() && sets.front().ego.empty())
        throw UsageError("--static " + w.statics + " needs --ego: its boxes are told in the world, scans are not");
    addOtherFiles(sets, w);
    return sets;
}

void makeNamesUnique(std::vector<SetFiles>& sets) {
    std::set<std::string> taken;
    for (SetFiles& s : sets) {
        const std::string name = s.name;
        for (int n = 2; !taken.insert(s.name).second; ++n) s.name = name + "_" + std::to_string(n);
    }
}

evaluation::RegionOfInterest roiOf(const std::string& word) {
    std::istringstream in(word);
    evaluation::RegionOfInterest roi;
    char a = 0;
    char b = 0;
    char c = 0;
    in >> roi.x_min >> a >> roi.x_max >> b >> roi.y_min >> c >> roi.y_max;
    if (!in || a != ',' || b != ',' || c != ',' || in.peek() != std::istringstream::traits_type::eof())
        throw UsageError("--roi " + word + ": expected XMIN,XMAX,YMIN,YMAX");
    return roi;
}

/// NAME:SECTION.KEY=VALUE,SECTION.KEY=VALUE ...
Variant variantOf(const std::string& word) {
    const auto colon = word.find(':');
    Variant v{word.substr(0, colon), {}};
    const bool is_file_name = !v.name.empty() && v.name.find_first_not_of(
                                                     "abcdefghijklmnopqrstuvwxyz"
                                                     "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == std::string::npos;
    if (!is_file_name || colon == std::string::npos)
        throw UsageError("--variant " + word +
                         ": expected NAME:SECTION.KEY=VALUE[,...], NAME of letters, digits, _ and -");
    std::istringstream in(word.substr(colon + 1));
    for (std::string assignment; std::getline(in, assignment, ',');) v.set.push_back(assignment);
    return v;
}

std::vector<Variant> variantsOf(const Words& w, bool monza) {
    std::vector<Variant> variants;
    std::transform(w.variants.begin(), w.variants.end(), std::back_inserter(variants), variantOf);
    if (!variants.empty()) return variants;
    if (monza) {
        return {{"16_plane", {"sensor.planes=16", "pipeline.algorithm=16-plane"}},
                {"8_plane", {"sensor.planes=8", "pipeline.algorithm=8-plane"}},
                {"auto_16", {"sensor.planes=16", "pipeline.algorithm=auto"}},
                {"auto_8", {"sensor.planes=8", "pipeline.algorithm=auto"}}};
    }
    return {Variant{}};
}

void finish(EvaluateOptions& o, const Words& w) {
    o.sets = setsOf(w);
    makeNamesUnique(o.sets);
    if (!w.roi.empty()) o.evaluation.roi = roiOf(w.roi);
    for (const std::string& type : w.ignore)
        o.evaluation.ignore.insert(boost::to_lower_copy(type));  // as truth files are read
    if (o.evaluation.target.rfind("id:", 0) != 0) o.evaluation.target = boost::to_lower_copy(o.evaluation.target);
    if (!w.planes.empty()) o.set.push_back("sensor.planes=" + w.planes);
    o.report = !w.no_report;
    o.variants = variantsOf(w, o.monza);
    if (o.monza && !w.detections.empty()) throw UsageError("monza runs the detector: leave out --detections");
    if (o.monza && o.evaluation.target.empty()) o.evaluation.target = "van";
}

void addAll(CLI::App& app, EvaluateOptions& o, Words& w) {
    addInputs(app, w);
    addDetector(app, o, w);
    addQuestion(app, o, w);
    addOutputs(app, o, w);
}

}  // namespace

std::optional<EvaluateOptions> parseEvaluateOptions(int argc, char** argv) {
    EvaluateOptions o;
    Words w;
    CLI::App app(kDescription, "obstacle-evaluate");
    app.footer(kFooter);
    addAll(app, o, w);
    CLI::App* monza = app.add_subcommand("monza", "the paper's experiment (Sec. V) on a recording with one vehicle");
    addAll(*monza, o, w);
    monza
        ->add_option("--variant", w.variants,
                     "one way to run the detector: NAME:SECTION.KEY=VALUE[,...]; may be given again (default: both "
                     "algorithms and auto)")
        ->type_name("NAME:...")
        ->allow_extra_args(false);
    if (!parse(app, argc, argv)) return std::nullopt;
    o.monza = monza->parsed();
    finish(o, w);
    return o;
}

}  // namespace lidar_obstacles::apps
