// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A model for the recognizer written by hand, so that tests of boxes do not depend on what training found.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/recognizer.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::test {

/// A node of a tree as a model file has it: a leaf (value alone), or what goes to `next` where the feature is smaller
/// than `value`, else to the node after it.
struct ModelNode {
    float value = 0.0f;
    int feature = -1;
    int next = 0;
};
using ModelTree = std::vector<ModelNode>;

inline ModelTree leaf(float value) { return {{value, -1, 0}}; }

/// `below` where the feature is smaller than the limit, else `above`.
inline ModelTree stump(Feature feature, float limit, float below, float above) {
    return {{limit, static_cast<int>(feature), 1}, {below, -1, 0}, {above, -1, 0}};
}

inline std::string forestText(const std::string& name, std::vector<ModelTree> trees) {
    while (trees.size() % kCategories != 0) trees.push_back(leaf(0.0f));
    std::string text = name + " 1 0 0 0 0 0 0 0 0\ntrees " + std::to_string(trees.size()) + "\n";
    for (const ModelTree& tree : trees) {
        text += "tree " + std::to_string(tree.size()) + "\n";
        for (const ModelNode& n : tree)
            text += std::to_string(n.feature + 1) + " " + std::to_string(n.value) +
                    (n.feature < 0 ? "" : " " + std::to_string(n.next)) + "\n";
    }
    return text;
}

/// The text of a model that has seen all values, without calibration. Tree k adds to category k modulo 8; what is
/// missing in the last round of eight adds nothing.
/// @param verdict  the trees that judge what was chosen among what stands about it; without any nobody does.
inline std::string modelText(const std::vector<ModelTree>& trees, const std::vector<ModelTree>& verdict = {}) {
    std::string text = "lidar_obstacles_model 2\n";
    for (const FeatureInfo& info : featureInfos()) text += "feature " + std::string(info.name) + " -1e9 1e9\n";
    return text + forestText("grouping", trees) + forestText("verdict", verdict);
}

/// Classes by size alone: what reaches 2.6 m or is 6 m long is structure, the rest a pedestrian up to 0.8 m and a
/// vehicle beyond. Pieces farther apart than 0.5 m are no one thing.
inline std::string sizeModelText() {
    constexpr float kSure = 9.0f;
    const auto byTop = [](float below, float above) { return stump(Feature::Top, 2.6f, below, above); };
    const ModelTree vehicle = {{0.8f, static_cast<int>(Feature::Length), 1},
                               {0.0f, -1, 0},
                               {6.0f, static_cast<int>(Feature::Length), 3},
                               {kSure, -1, 0},
                               {0.0f, -1, 0}};
    return modelText({leaf(0.0f), vehicle, stump(Feature::Length, 0.8f, kSure, 0.0f), leaf(0.0f),
                      stump(Feature::Length, 6.0f, 0.0f, 2.0f * kSure), leaf(0.0f), leaf(0.0f),
                      stump(Feature::Gap, 0.5f, 0.0f, 4.0f * kSure),  //
                      leaf(0.0f), leaf(0.0f), leaf(0.0f), leaf(0.0f), byTop(0.0f, 2.0f * kSure)});
}

/// The same parameters with the model of sizes.
inline DetectorParams bySize(DetectorParams params = {}) {
    static const TempFolder folder;
    static const std::string file = [] {
        const std::string path = folder.file("sizes.txt");
        writeFile(path, sizeModelText());
        return path;
    }();
    params.recognizer.model = file;
    return params;
}

}  // namespace lidar_obstacles::test
