// SPDX-License-Identifier: BSD-3-Clause
#include "common/class_choice.h"

#include <algorithm>
#include <array>

#include "common/run_app.h"

namespace lidar_obstacles::apps {

ClassChoice parseClasses(const std::vector<std::string>& words) {
    constexpr std::array kAll = {ObstacleClass::Vehicle, ObstacleClass::Pedestrian, ObstacleClass::Cyclist,
                                 ObstacleClass::Structure, ObstacleClass::Unknown};
    ClassChoice chosen;
    for (const std::string& word : words) {
        const auto* const found =
            std::find_if(kAll.begin(), kAll.end(), [&](ObstacleClass c) { return word == toString(c); });
        if (found == kAll.end())
            throw UsageError("--classes " + word +
                             ": must be vehicle, pedestrian, cyclist, structure or unknown, or several of them");
        chosen.insert(*found);
    }
    return chosen;
}

void keepChosen(const ClassChoice& chosen, std::vector<Obstacle>& obstacles) {
    if (chosen.empty()) return;
    obstacles.erase(
        std::remove_if(obstacles.begin(), obstacles.end(), [&](const Obstacle& o) { return chosen.count(o.cls) == 0; }),
        obstacles.end());
}

}  // namespace lidar_obstacles::apps
