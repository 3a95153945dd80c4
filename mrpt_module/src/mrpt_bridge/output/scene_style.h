/// @file
/// Colours and words that saved scenes and the layers of a window share.
#pragma once

#include <mrpt/img/TColor.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <string>

#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles {

/// Colours of neighbouring ids that are easy to tell apart.
inline mrpt::img::TColor clusterColor(int id) {
    static constexpr std::array<std::array<std::uint8_t, 3>, 10> kPalette = {{{255, 99, 71},
                                                                              {64, 224, 208},
                                                                              {255, 215, 0},
                                                                              {124, 252, 0},
                                                                              {255, 105, 180},
                                                                              {135, 206, 250},
                                                                              {255, 165, 0},
                                                                              {186, 85, 211},
                                                                              {240, 230, 140},
                                                                              {0, 250, 154}}};
    const auto& c = kPalette[static_cast<std::size_t>(id % 10 + 10) % 10];
    return {c[0], c[1], c[2]};
}

inline mrpt::img::TColor classColor(ObstacleClass cls) {
    switch (cls) {
        case ObstacleClass::Vehicle:
            return {255, 140, 0};
        case ObstacleClass::Pedestrian:
            return {0, 255, 255};
        case ObstacleClass::Cyclist:
            return {200, 120, 255};
        case ObstacleClass::Structure:
            return {150, 150, 150};
        case ObstacleClass::Unknown:
            break;
    }
    return {255, 255, 255};
}

/// Blue on the ground to yellow at 2.5 m.
inline mrpt::img::TColor heightColor(float height) {
    const float t = std::clamp(height / 2.5F, 0.F, 1.F);
    const auto mix = [&](float low, float high) { return static_cast<std::uint8_t>(low + t * (high - low)); };
    return {mix(70, 255), mix(110, 235), mix(255, 80)};
}

/// What stands above a box; with `explain` also what gave the heading.
inline std::string labelText(const Obstacle& o, bool explain) {
    char text[160];
    std::snprintf(text, sizeof text, "%s %d, %.1f m", toString(o.cls), o.id, distanceTo(o.box));
    std::string words = text;
    if (explain) {
        std::snprintf(text, sizeof text, "; %s %s, %d planes, %d returns", toString(o.rule), facesText(o.faces).c_str(),
                      o.num_rings, o.num_points);
        words += text;
    }
    return words;
}

}  // namespace lidar_obstacles
