// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacle-train: the recognizer's model from random scenes of the simulator.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <mutex>
#include <thread>

#include "boosting.h"
#include "calibration.h"
#include "card.h"
#include "common/input_choice.h"
#include "common/run_app.h"
#include "common/text_file.h"
#include "hold_out.h"
#include "importances.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "recordings.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;

constexpr const char* kDescription =
    "Trains the recognizer, which tells what a group of returns is, on scenes drawn at random.\n"
    "\n"
    "Scenes are simulated, every group of returns in them is measured, boosted trees learn what it is, and scenes "
    "that\n"
    "the trees have not seen calibrate the probabilities. Writes the model and, beside it, its card (MODEL.md): where\n"
    "it comes from, when it was made, and how good it is. The same options give the same model.\n"
    "\n"
    "Recordings of your own with truth boxes can be added. What lies in a box is the object, what is farther than "
    "half\n"
    "a metre from every box is structure: everything that is none, bins and bollards too, needs a box.\n";

struct Options {
    int scenes = 2000;
    std::uint64_t seed = 40000;
    int threads = 2;
    std::string output = "recognizer.txt";
    std::vector<std::string> set;
    DetectorParams params;  ///< with what was set
    BoostingOptions boosting;
    std::vector<std::string> add, truth;  ///< recordings and their truth, in the same order
    RecordingOptions recordings;
    std::vector<std::string> without;  ///< features
    std::optional<double> noise;       ///< of all scenes [m]
};

void addRecordingOptions(CLI::App& app, Options& o) {
    app.add_option("--add", o.add, "learn from this recording too; may be given again, each with its --truth")
        ->type_name("FILE");
    app.add_option("--truth", o.truth,
                   "the boxes of a recording (PREFIX_gt.csv; PREFIX_ego.csv beside it names scans without objects)")
        ->type_name("CSV");
    app.add_option("--every", o.recordings.every, "use every so many of the labelled scans of recordings")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    app.add_option("--view", o.recordings.view_deg,
                   "the truth labels this angle around the direction ahead [deg]; nothing is learned elsewhere")
        ->check(CLI::Range(1.0, 360.0))
        ->capture_default_str();
    addInputChoice(app, o.recordings.choice);
}

/// For experiments: how much a model loses.
void addAblationOptions(CLI::App& app, Options& o) {
    app.add_option("--without", o.without,
                   "learn nothing from these features (names as in the model file), with commas")
        ->delimiter(',')
        ->type_name("FEATURE,...");
    app.add_option("--noise", o.noise, "the same noise of ranges in all scenes [m], instead of .005 to .03")
        ->check(CLI::Range(0.0, 1.0));
}

std::set<Feature> featuresNamed(const std::vector<std::string>& names) {
    std::set<Feature> features;
    for (const std::string& name : names) {
        std::size_t k = 0;
        while (k < kFeatures && name != featureInfos()[k].name) ++k;
        if (k == kFeatures) throw UsageError("--without: there is no feature '" + name + "'");
        features.insert(static_cast<Feature>(k));
    }
    return features;
}

void checkPairs(const Options& o) {
    if (o.add.size() != o.truth.size())
        throw UsageError("each --add needs a --truth: there are " + std::to_string(o.add.size()) + " of --add and " +
                         std::to_string(o.truth.size()) + " of --truth");
}

std::optional<Options> parseOptions(int argc, char** argv) {
    Options o;
    CLI::App app(kDescription, "obstacle-train");
    app.add_option("--output", o.output, "the model")->type_name("FILE")->capture_default_str();
    app.add_option("--scenes", o.scenes,
                   "scenes to simulate, two sets of one of each kind at least; every fifth set calibrates and judges")
        ->check(CLI::Range(leastScenes(), 1000000))
        ->capture_default_str();
    app.add_option("--seed", o.seed, "seed of the first scene; the next ones count on")->capture_default_str();
    app.add_option("--threads", o.threads, "scenes simulated at a time; does not change the model")
        ->check(CLI::Range(1, 256))
        ->capture_default_str();
    app.add_option("--rounds", o.boosting.rounds, "trees for each category")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    app.add_option("--depth", o.boosting.depth, "of the trees")->check(CLI::Range(1, 12))->capture_default_str();
    app.add_option("--rate", o.boosting.rate, "how much each tree adds")
        ->check(CLI::Range(0.001, 1.0))
        ->capture_default_str();
    app.add_option("--set", o.set, "change one parameter of the detector, as SECTION.NAME=VALUE; may be given again");
    addRecordingOptions(app, o);
    addAblationOptions(app, o);
    app.set_version_flag("--version", "obstacle-train " LIDAR_OBSTACLES_VERSION);
    if (!parse(app, argc, argv)) return std::nullopt;
    checkPairs(o);
    o.boosting.left_out = featuresNamed(o.without);
    for (const std::string& assignment : o.set) setParam(o.params, assignment);
    return o;
}

/// Scenes, and the model that scores and joins groups in them.
struct Round {
    int scenes = 0;
    std::uint64_t seed = 0;  ///< of the first one
    std::string model;
    Serves recorded = Serves::Grouping;  ///< what the scans of recordings that it learns from are for
};

/// All that examples are made of.
struct Examples {
    const Options& options;
    const std::vector<Recording>& recordings;
};

/// The detector whose guesses and mistakes a round learns from.
DetectorParams paramsOf(const Options& o, const Round& round) {
    DetectorParams params = o.params;
    params.recognizer.model = round.model;
    return params;
}

/// The scans of all scenes, in the order of the scenes whatever the number of threads.
std::vector<std::vector<ScanSamples>> simulateAll(const Options& o, const Round& round) {
    std::vector<std::vector<ScanSamples>> scenes(static_cast<std::size_t>(round.scenes));
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    std::string error;
    std::mutex lock;
    const DetectorParams params = paramsOf(o, round);
    const auto simulate = [&](std::size_t k) {
        try {
            scenes[k] = samplesOfScene({round.seed + k, static_cast<int>(k), 8, params, o.noise});
        } catch (const std::exception& e) {
            const std::lock_guard<std::mutex> guard(lock);
            error = "scene of seed " + std::to_string(round.seed + k) + ": " + e.what();
            failed = true;
        }
        if (k % 20 == 0) std::fprintf(stderr, "obstacle-train: scene %zu of %zu\n", k, scenes.size());
    };
    const auto work = [&] {
        for (std::size_t k = next++; k < scenes.size() && !failed; k = next++) simulate(k);
    };
    std::vector<std::thread> threads;
    for (int t = 0; t < o.threads; ++t) threads.emplace_back(work);
    for (std::thread& t : threads) t.join();
    if (failed) throw std::runtime_error(error);
    return scenes;
}

/// Scenes to learn from, and those kept back; of recordings the last fifth.
struct Split {
    std::vector<ScanSamples> training, held_back;
    std::size_t simulated = 0;  ///< of those kept back; those of recordings follow
    std::vector<ScanSamples> recorded() const {
        return {held_back.begin() + static_cast<std::ptrdiff_t>(simulated), held_back.end()};
    }
};

Split gather(const Examples& examples, const Round& round) {
    Split split;
    std::vector<std::vector<ScanSamples>> scenes = simulateAll(examples.options, round);
    for (std::size_t k = 0; k < scenes.size(); ++k) {
        std::vector<ScanSamples>& part = isKeptBack(k, scenes.size()) ? split.held_back : split.training;
        std::move(scenes[k].begin(), scenes[k].end(), std::back_inserter(part));
    }
    split.simulated = split.held_back.size();
    const DetectorParams params = paramsOf(examples.options, round);
    const auto append = [](std::vector<ScanSamples> scans, std::vector<ScanSamples>& to) {
        std::move(scans.begin(), scans.end(), std::back_inserter(to));
    };
    for (const Recording& r : examples.recordings) {
        append(samplesOfRecording(r, round.recorded, params), split.training);
        append(samplesOfRecording(r, Serves::Judging, params), split.held_back);
    }
    return split;
}

/// @param chosen  only what was chosen.
std::vector<const Sample*> samplesOf(const std::vector<ScanSamples>& scans, bool chosen) {
    std::vector<const Sample*> samples;
    for (const ScanSamples& scan : scans)
        for (const Sample& s : scan)
            if (s.known && (!chosen || (s.chosen && s.returns > 2))) samples.push_back(&s);
    std::fprintf(stderr, "obstacle-train: %zu groups to learn from\n", samples.size());
    return samples;
}

struct Model {
    std::string ranges;
    Forest grouping, verdict;
    std::size_t groups = 0;    ///< that grouping learned from
    std::size_t verdicts = 0;  ///< and the verdict
    std::string text() const { return modelText(ranges, grouping, verdict); }
    Recognizer parsed() const { return Recognizer::parse(text(), "new model"); }
};

Model trainGrouping(const Examples& examples, const Round& round) {
    const Split scenes = gather(examples, round);
    const std::vector<const Sample*> samples = samplesOf(scenes.training, false);
    Model m;
    m.groups = samples.size();
    m.ranges = rangesText(samples, examples.options.boosting.left_out);
    m.grouping.trees = boost(samples, Recognizer::Forest::Grouping, examples.options.boosting);
    m.grouping.calibration = calibrate(chosenAnew(m.parsed(), scenes.held_back));
    return m;
}

/// Teaches a model to judge what it chose in scenes that it has not seen.
Judgements trainVerdict(const Examples& examples, const Round& round, Model& m) {
    const Split scenes = gather(examples, round);
    const std::vector<const Sample*> samples = samplesOf(scenes.training, true);
    m.verdicts = samples.size();
    m.verdict.trees = boost(samples, Recognizer::Forest::Verdict, examples.options.boosting);
    m.verdict.calibration = calibrate(chosenOnceMore(m.parsed(), scenes.held_back));
    return {judge(m.parsed(), scenes.held_back), judge(m.parsed(), scenes.recorded())};
}

/// What was added, with what was left out of it said. Before anything is simulated: errors need not wait.
std::vector<Recording> openRecordings(const Options& o) {
    std::vector<Recording> recordings;
    recordings.reserve(o.add.size());
    for (std::size_t k = 0; k < o.add.size(); ++k) {
        recordings.push_back(openRecording(o.add[k], o.truth[k], o.recordings, o.params));
        const Recording& r = recordings.back();
        if (!r.remarks.empty()) std::fprintf(stderr, "obstacle-train: %s: %s\n", o.add[k].c_str(), r.remarks.c_str());
        std::fprintf(stderr, "obstacle-train: %s: %zu scans, %zu labelled, %zu used\n", o.add[k].c_str(),
                     r.scans_in_file, r.scans_labelled, r.scans.size());
        if (r.truth_without_scan > 0)
            std::fprintf(stderr, "obstacle-train: %s: %zu of its scans are not in the recording\n", o.truth[k].c_str(),
                         r.truth_without_scan);
    }
    return recordings;
}

/// Three rounds, each of scenes of its own. What is thought of the parts of a group, and what is joined beside the
/// tree, depends on a model: a first one makes the guesses and mistakes from which the second one learns to group.
/// The third round learns to judge what that one chooses.
int run(const Options& o) {
    const std::vector<Recording> recordings = openRecordings(o);
    const Examples examples{o, recordings};
    const std::string used = o.output + ".round";
    const auto write = [&](int round, const Model& m) {  // a model of a name is read once
        writeTextFile(used + std::to_string(round), m.text());
        return used + std::to_string(round);
    };
    const auto scenes = static_cast<std::uint64_t>(o.scenes);
    Model none;
    none.ranges = rangesText({});
    const int few = std::max(leastScenes(), o.scenes / 3);
    const Model first = trainGrouping(examples, {few, o.seed + 2 * scenes, write(0, none)});
    Model last = trainGrouping(examples, {o.scenes, o.seed, write(1, first)});
    const Judgements judgements =
        trainVerdict(examples, {o.scenes, o.seed + scenes, write(2, last), Serves::Verdict}, last);
    for (int round = 0; round < 3; ++round) std::filesystem::remove(used + std::to_string(round));
    writeTextFile(o.output, last.text());
    const std::string card =
        cardText({o.scenes, o.seed, o.boosting, last.groups, last.verdicts, o.set, recordings, o.noise}, judgements) +
        importancesText(last.text());
    writeTextFile(o.output + ".md", card);
    std::cout << card;
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("obstacle-train", [&] {
        const auto options = parseOptions(argc, argv);
        return options ? run(*options) : 0;
    });
}
