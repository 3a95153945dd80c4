// SPDX-License-Identifier: BSD-3-Clause
#include "importances.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>
#include <sstream>
#include <vector>

#include "lidar_obstacles/features.h"

namespace lidar_obstacles::apps {
namespace {

constexpr std::size_t kShown = 12;
using Weights = std::array<double, kFeatures>;

/// A tree: its nodes from the root on, each with the first of the two that follow it (0: none).
void addTree(std::istream& in, std::size_t nodes, Weights& weights) {
    std::vector<double> weight(nodes, 0.0);
    weight[0] = 1.0;
    for (std::size_t n = 0; n < nodes; ++n) {
        std::size_t feature = 0;
        std::string limit;
        in >> feature >> limit;
        if (feature == 0) continue;
        std::size_t next = 0;
        in >> next;
        weights[feature - 1] += weight[n];
        weight[next] = weight[next + 1] = 0.5 * weight[n];
    }
}

Weights weightsOf(std::istream& in) {
    Weights weights{};
    std::string word;
    std::size_t trees = 0;
    while (in >> word && word != "trees") {
    }
    in >> trees;
    for (std::size_t t = 0; t < trees; ++t) {
        std::size_t nodes = 0;
        in >> word >> nodes;
        addTree(in, nodes, weights);
    }
    return weights;
}

std::string listOf(const char* forest, const Weights& weights) {
    const double all = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::array<std::size_t, kFeatures> order{};
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return weights[a] > weights[b]; });
    std::string text = std::string("* ") + forest + ":";
    for (std::size_t k = 0; k < kShown && weights[order[k]] > 0.0; ++k) {
        char share[20];
        std::snprintf(share, sizeof share, " %.0f %%", 100.0 * weights[order[k]] / all);
        text += std::string(k == 0       ? " `"
                            : k % 6 == 0 ? ",\n  `"
                                         : ", `") +
                featureInfos()[order[k]].name + "`" + share;
    }
    return text + ".\n";
}

}  // namespace

std::string importancesText(const std::string& model) {
    std::istringstream in(model);
    const Weights grouping = weightsOf(in);
    const Weights verdict = weightsOf(in);
    return "\nWhat the trees ask for, as a share of their questions (the first question of a tree weighs most):\n\n" +
           listOf("to form groups", grouping) + listOf("to judge", verdict);
}

}  // namespace lidar_obstacles::apps
