// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/grouping.h"
#include "objects/groups.h"

namespace lidar_obstacles {

std::vector<Merge> mergesOf(const std::vector<Hypothesis>& hypotheses) {
    const auto at = [](int k) { return static_cast<std::size_t>(k); };
    std::vector<bool> in_group(hypotheses.size(), false);
    for (std::size_t k = hypotheses.size(); k-- > 0;) {  // a whole comes after its parts
        const Hypothesis& h = hypotheses[k];
        if (h.chosen) in_group[k] = true;
        if (h.part[0] < 0 || !in_group[k]) continue;
        for (const int part : h.part) in_group[at(part)] = true;
    }
    std::vector<Merge> merges;
    merges.reserve(hypotheses.size());
    for (std::size_t k = 0; k < hypotheses.size(); ++k) {
        const Hypothesis& h = hypotheses[k];
        if (h.part[0] < 0) continue;
        const float apart = hypotheses[at(h.part[0])].cut + hypotheses[at(h.part[1])].cut;
        merges.push_back(
            {static_cast<int>(k), h.part, apart, apart + gainOf(h, hypotheses), static_cast<bool>(in_group[k])});
    }
    return merges;
}

}  // namespace lidar_obstacles
