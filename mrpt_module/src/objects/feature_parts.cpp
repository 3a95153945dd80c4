// SPDX-License-Identifier: BSD-3-Clause
// What the verdicts on its parts say of a whole.
#include <algorithm>
#include <array>

#include "lidar_obstacles/features.h"
#include "objects/feature_tools.h"

namespace lidar_obstacles {

void measureParts(const Hypothesis& h, const std::vector<Hypothesis>& tree, FeatureVector& f) {
    std::fill(f.data() + static_cast<std::size_t>(Feature::Apart), f.data() + kGroupFeatures, -1.0f);
    if (h.part[0] < 0 || h.points.empty()) return;
    const auto part = [&](std::size_t k) -> const Hypothesis& { return tree[static_cast<std::size_t>(h.part[k])]; };
    const std::size_t more = part(0).points.size() >= part(1).points.size() ? 0 : 1;
    const auto returns = static_cast<float>(h.points.size());
    at(f, Feature::Apart) = (part(0).cut + part(1).cut) / returns;
    at(f, Feature::LessShare) = static_cast<float>(part(1 - more).points.size()) / returns;
    const std::array<Feature, 2> first{Feature::MoreWhole, Feature::LessWhole};
    for (std::size_t k = 0; k < 2; ++k) {
        const Hypothesis& p = part(k == 0 ? more : 1 - more);
        const auto of = [&](ObstacleClass c) { return p.probability[static_cast<std::size_t>(c)]; };
        float* const verdict = f.data() + static_cast<std::size_t>(first[k]);
        verdict[0] = p.whole;
        verdict[1] = of(ObstacleClass::Vehicle);
        verdict[2] = of(ObstacleClass::Pedestrian) + of(ObstacleClass::Cyclist);
        verdict[3] = of(ObstacleClass::Structure);
    }
}

}  // namespace lidar_obstacles
