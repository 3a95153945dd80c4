// SPDX-License-Identifier: BSD-3-Clause
#include "calibration.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "lidar_obstacles/features.h"
#include "lidar_obstacles/params.h"
#include "objects/groups.h"

namespace lidar_obstacles::apps {
namespace {

const std::int32_t kMinReturns = GateParams{}.min_points;  // smaller groups are no obstacles

/// Counts the vehicles and people of a scan that a whole hypothesis was made of, and chosen.
void countWholes(const ScanSamples& scan, Judgement& j) {
    constexpr int kClear = 15;  // returns
    struct Found {
        int returns = 0;
        bool person = false, made = false, chosen = false;
    };
    std::map<int, Found> things;
    for (const Sample& s : scan) {
        if (!s.known || s.thing == 0 || s.truth == Category::Unknown || s.truth == Category::Mixture) continue;
        Found& f = things[s.thing];
        f.person = s.truth != Category::Vehicle && s.truth != Category::VehiclePart;
        f.returns += s.part[0] < 0 ? s.returns : 0;
        const bool whole = s.truth != Category::VehiclePart && s.truth != Category::PersonPart;
        f.made |= whole;
        f.chosen |= whole && s.chosen;
    }
    for (const auto& [thing, f] : things) {
        if (f.returns < kClear) continue;
        std::array<int, 3>& count = f.person ? j.people : j.vehicles;
        ++count[0];
        count[1] += f.made;
        count[2] += f.chosen;
    }
}

/// Was it joined beside the tree?
bool isBeside(const std::vector<Hypothesis>& tree, std::size_t k) {
    return tree[k].part[0] >= 0 && tree[static_cast<std::size_t>(tree[k].part[0])].parent != static_cast<int>(k);
}

/// The best cut, then of what was joined beside the tree whatever gains.
void choose(std::vector<Hypothesis>& tree) {
    std::size_t of_tree = tree.size();
    while (of_tree > 0 && isBeside(tree, of_tree - 1)) --of_tree;
    std::vector<Hypothesis> beside(tree.begin() + static_cast<std::ptrdiff_t>(of_tree), tree.end());
    tree.resize(of_tree);
    chooseBestCut(tree);
    for (Hypothesis& h : beside) {
        const auto part = [&](std::size_t k) -> Hypothesis& { return tree[static_cast<std::size_t>(h.part[k])]; };
        h.chosen = part(0).chosen && part(1).chosen && gainOf(h, tree) > 0.0f;
        if (h.chosen) part(0).chosen = part(1).chosen = false;
        tree.push_back(std::move(h));
    }
}

/// How the log-likelihood of the groups changes with the sharpness and the biases.
struct Slope {
    double sharpness = 0.0;
    std::array<double, kCategories> bias{};
};

Slope slopeOf(const std::vector<Chosen>& groups, const Calibration& c) {
    Slope slope;
    for (const Chosen& g : groups) {
        const CategoryProbabilities p = probabilitiesOf(g.scores, c);
        for (std::size_t k = 0; k < kCategories; ++k) {
            const double off = (static_cast<std::size_t>(g.truth) == k ? 1.0 : 0.0) - p[k];
            slope.bias[k] += off;
            slope.sharpness += off * g.scores[k];
        }
    }
    return slope;
}

/// Of each class and tenth of the probabilities: count, sum of probabilities, right.
using Bins = std::array<std::array<std::array<double, 3>, 10>, 5>;

void note(const CategoryProbabilities& verdict, Category truth, Judgement& j, Bins& bins) {
    const ClassProbabilities p = classesOf(verdict);
    const auto told = static_cast<std::size_t>(std::max_element(p.begin(), p.end()) - p.begin());
    ++j.confusion[told][static_cast<std::size_t>(truth)];
    CategoryProbabilities sure{};
    sure[static_cast<std::size_t>(truth)] = 1.0f;
    auto& bin = bins[told][static_cast<std::size_t>(std::min(9.0f, 10.0f * p[told]))];
    bin[0] += 1.0;
    bin[1] += p[told];
    bin[2] += classesOf(sure)[told] > 0.4f;
}

}  // namespace

std::vector<Chosen> chosenAnew(const Recognizer& model, const std::vector<ScanSamples>& scans) {
    std::vector<Chosen> groups;
    std::vector<Hypothesis> tree;
    for (const ScanSamples& scan : scans) {
        tree.assign(scan.size(), {});
        std::vector<FeatureVector> features(scan.size());
        for (std::size_t k = 0; k < scan.size(); ++k) {
            tree[k].part = scan[k].part;
            tree[k].parent = scan[k].parent;
            tree[k].points.resize(static_cast<std::size_t>(scan[k].returns));
            features[k] = scan[k].features;
            measureParts(tree[k], tree, features[k]);
            setScore(tree[k], model(features[k], Recognizer::Forest::Grouping), tree);
        }
        choose(tree);
        for (std::size_t k = 0; k < scan.size(); ++k)
            if (tree[k].chosen && scan[k].known && scan[k].returns >= kMinReturns)
                groups.push_back({model.scores(features[k], Recognizer::Forest::Grouping), scan[k].truth});
    }
    return groups;
}

std::vector<Chosen> chosenOnceMore(const Recognizer& model, const std::vector<ScanSamples>& scans) {
    std::vector<Chosen> groups;
    for (const ScanSamples& scan : scans)
        for (const Sample& s : scan)
            if (s.chosen && s.known && s.returns >= kMinReturns)
                groups.push_back({model.scores(s.features, Recognizer::Forest::Verdict), s.verdict});
    return groups;
}

Calibration calibrate(const std::vector<Chosen>& groups) {
    constexpr int kSteps = 500;
    constexpr double kStep = 0.3;
    Calibration c;
    if (groups.empty()) return c;
    for (int step = 0; step < kSteps; ++step) {
        const Slope slope = slopeOf(groups, c);
        const double rate = kStep / static_cast<double>(groups.size());
        c.sharpness += static_cast<float>(0.1 * rate * slope.sharpness);
        for (std::size_t k = 0; k < kCategories; ++k) c.bias[k] += static_cast<float>(rate * slope.bias[k]);
    }
    return c;
}

Judgement judge(const Recognizer& model, const std::vector<ScanSamples>& scans) {
    Judgement j;
    j.scans = scans.size();
    Bins bins{};
    for (const ScanSamples& scan : scans) {
        countWholes(scan, j);
        for (const Sample& s : scan)
            if (s.chosen && s.known && s.returns >= kMinReturns)
                note(model(s.features, Recognizer::Forest::Verdict), s.verdict, j, bins);
    }
    for (std::size_t c = 0; c < 5; ++c) {
        double count = 0.0;
        double off = 0.0;
        for (const auto& bin : bins[c]) {
            count += bin[0];
            off += std::abs(bin[1] - bin[2]);
        }
        j.calibration_error[c] = count > 0.0 ? off / count : 0.0;
    }
    return j;
}

}  // namespace lidar_obstacles::apps
