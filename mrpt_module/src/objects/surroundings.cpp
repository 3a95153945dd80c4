// SPDX-License-Identifier: BSD-3-Clause
#include "objects/surroundings.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "objects/feature_tools.h"

namespace lidar_obstacles {
namespace {

constexpr float kReach = 12.0f;      // what is farther away tells nothing [m]
constexpr std::size_t kShapely = 3;  // fewer returns were not looked at

/// What groups within a radius were taken for.
struct Company {
    float radius;
    float structure = 0.0f, vehicle = 0.0f, person = 0.0f, all = 0.0f;  ///< sums of weights
    int count = 0;
};

void write(const Company& c, float* f) {
    const float all = c.all + 1.0f;
    f[0] = c.structure / all;
    f[1] = c.vehicle / all;
    f[2] = c.person / all;
    f[3] = std::max(0.0f, c.all - c.structure - c.vehicle - c.person) / all;
    // In double: the C library's log1p of floats differs between releases.
    f[4] = static_cast<float>(std::log1p(static_cast<double>(c.count)));
}

}  // namespace

/// What is near a group.
struct Surroundings::Near {
    std::array<Company, 3> company{{{1.0f}, {3.0f}, {8.0f}}};
    std::array<const Group*, 4> nearest{};  ///< of all, structure, vehicles, people
    std::array<float, 4> away{kReach, kReach, kReach, kReach};

    void add(const Group& g, float distance) {
        for (Company& c : company) {
            if (distance >= c.radius) continue;
            c.structure += g.weight * g.structure;
            c.vehicle += g.weight * g.vehicle;
            c.person += g.weight * g.person;
            c.all += g.weight;
            ++c.count;
        }
        const std::array<bool, 4> is{true, g.structure > 0.5f, g.vehicle > 0.5f, g.person > 0.5f};
        for (std::size_t k = 0; k < is.size(); ++k) {
            if (!is[k] || distance >= away[k]) continue;
            away[k] = distance;
            nearest[k] = &g;
        }
    }
};

Surroundings::Group Surroundings::groupOf(std::size_t k, const MergeTree& tree) {
    const Hypothesis& h = tree.hypotheses[k];
    const auto of = [&](Category c) { return h.category[static_cast<std::size_t>(c)]; };
    Group g;
    g.hypothesis = k;
    g.box = tree.footprints[k].box;
    g.structure = of(Category::Structure);
    g.vehicle = of(Category::Vehicle) + of(Category::VehiclePart);
    g.person = of(Category::Pedestrian) + of(Category::Cyclist) + of(Category::PersonPart);
    const auto returns = static_cast<float>(h.points.size());
    g.size = std::log2(returns);
    g.weight = std::sqrt(returns);
    g.top = tree.features[k][static_cast<std::size_t>(Feature::Top)];
    g.bottom = tree.features[k][static_cast<std::size_t>(Feature::Bottom)];
    return g;
}

Surroundings::Surroundings(const MergeTree& tree) : tree_(tree) {
    for (std::size_t k = 0; k < tree.hypotheses.size(); ++k) {
        const Hypothesis& h = tree.hypotheses[k];
        if (!h.chosen || h.points.size() < kShapely) continue;
        groups_.push_back(groupOf(k, tree));
        widest_ = std::max(widest_, groups_.back().box.sizes().x());
    }
    std::sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) {
        return a.box.min().x() != b.box.min().x() ? a.box.min().x() < b.box.min().x() : a.hypothesis < b.hypothesis;
    });
}

void Surroundings::measure(std::size_t hypothesis, FeatureVector& f) const {
    const Group own = groupOf(hypothesis, tree_);
    Near near;
    const auto first = std::lower_bound(groups_.begin(), groups_.end(), own.box.min().x() - kReach - widest_,
                                        [](const Group& g, float x) { return g.box.min().x() < x; });
    for (auto g = first; g != groups_.end() && g->box.min().x() < own.box.max().x() + kReach; ++g)
        if (g->hypothesis != hypothesis) near.add(*g, own.box.exteriorDistance(g->box));
    const auto place = [&](Feature k) { return f.data() + static_cast<std::size_t>(k); };
    const CategoryProbabilities& told = tree_.hypotheses[hypothesis].category;
    std::copy(told.begin(), told.end(), place(Feature::ToldUnknown));
    write(near.company[0], place(Feature::BesideStructure));
    write(near.company[1], place(Feature::NearStructure));
    write(near.company[2], place(Feature::AboutStructure));
    const Group nobody{};
    const Group& next = near.nearest[0] != nullptr ? *near.nearest[0] : nobody;
    const bool some = near.nearest[0] != nullptr;
    const std::array<float, 7> of_next{near.away[0],
                                       next.structure,
                                       next.vehicle,
                                       next.person,
                                       some ? next.size - own.size : 0.0f,
                                       some ? next.top - own.top : 0.0f,
                                       some ? next.bottom - own.bottom : 0.0f};
    std::copy(of_next.begin(), of_next.end(), place(Feature::NextAway));
    for (std::size_t k = 1; k < near.nearest.size(); ++k) {
        float* const pair = place(Feature::StructureAway) + 2 * (k - 1);
        pair[0] = near.away[k];
        pair[1] = near.nearest[k] != nullptr ? near.nearest[k]->size - own.size : 0.0f;
    }
}

}  // namespace lidar_obstacles
