// SPDX-License-Identifier: BSD-3-Clause
#include "samples.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "lidar_obstacles/feature_extractor.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/object_models.h"
#include "lidar_obstacles/pipelines.h"
#include "lidar_obstacles/simulation/random_scene.h"
#include "lidar_obstacles/simulation/recording.h"
#include "objects/footprint.h"
#include "objects/groups.h"
#include "objects/surroundings.h"

namespace lidar_obstacles::apps {
namespace {

constexpr double kWhole = 0.9;  // share of the returns of a thing that is whole
constexpr double kMain = 0.5;   // and of one that is most of it
constexpr double kPure = 0.9;   // share of the returns of a group that are of one thing
constexpr int kStructure = 0;   // id of all structure and ground together

/// The thing a return belongs to.
int thingOf(const simulation::ReturnLabel& label) {
    if (label.id == kUnsure) return kUnsure;
    const bool ground = label.kind == ObjectKind::Ground || label.kind == ObjectKind::Noise;
    return ground || classOf(label.kind) == ObstacleClass::Structure ? kStructure : label.id;
}

/// Returns of each thing in a group, and of the largest a label.
struct Census {
    std::map<int, int> returns;
    int largest = kStructure;
    ObjectKind kind = ObjectKind::Ground;
};

Census censusOf(const std::vector<std::int32_t>& points, const std::vector<simulation::ReturnLabel>& labels) {
    Census c;
    for (const std::int32_t i : points) ++c.returns[thingOf(labels[static_cast<std::size_t>(i)])];
    for (const auto& [thing, count] : c.returns)
        if (count > c.returns[c.largest]) c.largest = thing;
    for (const std::int32_t i : points)
        if (thingOf(labels[static_cast<std::size_t>(i)]) == c.largest)
            c.kind = labels[static_cast<std::size_t>(i)].kind;
    return c;
}

/// Is most of something else in it? A person beside a car is few of the returns, but must not be lost in it.
bool holdsMore(const Census& c, const std::map<int, int>& of_thing) {
    const int kLeast = GateParams{}.min_points;  // fewer returns are no obstacle
    return std::any_of(c.returns.begin(), c.returns.end(), [&](const auto& other) {
        const auto [thing, count] = other;
        return thing != kStructure && thing != kUnsure && thing != c.largest && count >= kLeast &&
               2 * count > of_thing.at(thing);
    });
}

/// Does anything else in it lie well outside the rectangle around the returns of its largest thing? Few returns of the
/// next car make the box of a car as long as two.
bool reachesBeyond(const Census& c, const std::vector<std::int32_t>& points, const PointCloud& cloud,
                   const std::vector<simulation::ReturnLabel>& labels) {
    constexpr float kWellOutside = 0.5f;  // half of what two parked cars leave between them [m]
    std::vector<std::int32_t> mine, others;
    for (const std::int32_t i : points) {
        const int thing = thingOf(labels[static_cast<std::size_t>(i)]);
        if (thing != kUnsure) (thing == c.largest ? mine : others).push_back(i);
    }
    if (others.empty()) return false;
    const Eigen::Vector2f along = smallestRectangle(footprintOf(mine, cloud)).along;
    const auto place = [&](std::int32_t i) {
        const Eigen::Vector2f p = cloud.xyz[i].head<2>();
        return Eigen::Vector2f(along.dot(p), along.x() * p.y() - along.y() * p.x());
    };
    Eigen::AlignedBox2f around;
    for (const std::int32_t i : mine) around.extend(place(i));
    return std::any_of(others.begin(), others.end(), [&](std::int32_t i) {
        const Eigen::Vector2f p = place(i);
        return ((around.min() - p).array() > kWellOutside || (p - around.max()).array() > kWellOutside).any();
    });
}

/// @param complete  share of its returns that a whole thing has
Category categoryOf(const Census& c, std::size_t returns, const std::map<int, int>& of_thing, double complete) {
    const int mine = c.returns.at(c.largest);
    if (mine < kPure * static_cast<double>(returns) || holdsMore(c, of_thing)) return Category::Mixture;
    if (c.largest == kStructure) return Category::Structure;
    const bool whole = mine >= complete * of_thing.at(c.largest);
    switch (classOf(c.kind)) {
        case ObstacleClass::Vehicle:
            return whole ? Category::Vehicle : Category::VehiclePart;
        case ObstacleClass::Pedestrian:
            return whole ? Category::Pedestrian : Category::PersonPart;
        case ObstacleClass::Cyclist:
            return whole ? Category::Cyclist : Category::PersonPart;
        case ObstacleClass::Structure:
        case ObstacleClass::Unknown:
            break;
    }
    return Category::Unknown;
}

/// Every return of the cloud keeps its label: nothing is dropped for being near or far.
DetectorParams paramsFor(int rings, DetectorParams params) {
    params.sensor.planes = rings;
    params.sensor.min_range = 0.0;
    params.sensor.max_range = 300.0;
    return params;
}

/// The labels of what decimation keeps, in their order.
std::vector<simulation::ReturnLabel> labelsKept(const PointCloud& full, int full_rings, int rings,
                                                const std::vector<simulation::ReturnLabel>& labels) {
    const int every = full_rings / rings;
    std::vector<simulation::ReturnLabel> kept;
    for (std::size_t i = 0; i < full.size(); ++i)
        if (full.ring[i] % every == (every - 1) / 2) kept.push_back(labels[i]);
    return kept;
}

}  // namespace

std::vector<Truth> truthOf(const DetectionResult& result, const PointCloud& cloud,
                           const std::vector<simulation::ReturnLabel>& labels) {
    std::map<int, int> of_thing;
    for (const Hypothesis& h : result.hypotheses)
        if (h.part[0] < 0)
            for (const std::int32_t i : h.points) ++of_thing[thingOf(labels[static_cast<std::size_t>(i)])];
    std::vector<Truth> truth;
    truth.reserve(result.hypotheses.size());
    for (const Hypothesis& h : result.hypotheses) {
        const Census census = censusOf(h.points, labels);
        const auto unsure = census.returns.find(kUnsure);
        if (unsure != census.returns.end() && 10 * unsure->second > static_cast<int>(h.points.size())) {
            truth.push_back({Category::Unknown, Category::Unknown, kStructure, false});
            continue;
        }
        const auto category = [&](double complete) { return categoryOf(census, h.points.size(), of_thing, complete); };
        Truth t{category(kWhole), category(kMain), census.largest, true};
        if (isMixed(h) && classOf(census.kind) != ObstacleClass::Vehicle) t.category = t.verdict = Category::Mixture;
        const bool object = t.category != Category::Mixture && census.largest != kStructure;
        if (object && reachesBeyond(census, h.points, cloud, labels)) t.category = Category::Mixture;
        truth.push_back(t);
    }
    return truth;
}

ScanSamples samplesOfScan(const PointCloud& cloud, const std::vector<simulation::ReturnLabel>& labels,
                          const DetectorParams& params) {
    const DetectionResult r = detect(cloud, params);
    const std::vector<Truth> truth = truthOf(r, cloud, labels);
    const Beams beams(cloud);
    FeatureExtractor featuresOf(beams, r.ground);
    MergeTree tree{r.hypotheses, {}, {}};
    for (const Hypothesis& h : r.hypotheses) {
        tree.footprints.push_back(footprintOf(h.points, cloud));
        tree.features.push_back(featuresOf(h, tree.footprints.back()));
        measureParts(h, r.hypotheses, tree.features.back());
    }
    const Surroundings surroundings(tree);
    ScanSamples samples;
    samples.reserve(truth.size());
    for (std::size_t k = 0; k < truth.size(); ++k) {
        const Hypothesis& h = r.hypotheses[k];
        if (h.chosen) surroundings.measure(k, tree.features[k]);
        samples.push_back({tree.features[k], truth[k].category, truth[k].verdict, truth[k].thing,
                           static_cast<std::int32_t>(h.points.size()), h.part, h.parent, h.chosen, truth[k].known});
    }
    return samples;
}

std::vector<ScanSamples> samplesOfScene(const SceneChoice& choice) {
    const auto& kinds = simulation::randomScenes();
    const simulation::RandomScene kind = kinds[static_cast<std::size_t>(choice.kind) % kinds.size()];
    simulation::Scenario scenario = simulation::randomScenario(kind, choice.seed);
    scenario.sensor.elevations = simulation::randomLasers(kind, choice.seed);
    scenario.sensor.planes = 0;
    if (choice.noise) scenario.sensor.range_noise = *choice.noise;
    const simulation::World world = simulation::buildWorld(scenario);
    simulation::RunOptions options;
    options.stride = choice.stride;
    options.seed = choice.seed;
    options.threads = 1;
    std::vector<ScanSamples> all;
    simulation::run(world, options, [&](const simulation::RecordedScan& scan) {
        const auto full = toPointCloud(*scan.observation, paramsFor(0, choice.params).sensor);
        if (full.size() != scan.labels.returns.size()) throw std::logic_error("the labels are not those of the scan");
        const int full_rings = full.view.rings;
        for (const int rings : {16, 8, 4}) {
            if (full_rings % rings != 0 || (rings == 4 && scan.index % 2 == 0)) continue;
            const auto cloud = toPointCloud(*scan.observation, paramsFor(rings, choice.params).sensor);
            all.push_back(samplesOfScan(cloud, labelsKept(full, full_rings, rings, scan.labels.returns),
                                        paramsFor(rings, choice.params)));
        }
    });
    return all;
}

}  // namespace lidar_obstacles::apps
