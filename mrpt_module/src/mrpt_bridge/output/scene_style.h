// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Colours and words that saved scenes and the layers of a window share.
#pragma once

#include <mrpt/img/TColor.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "mrpt_bridge/output/flat_arrow.h"

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
            return {130, 130, 130};
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

/// A colour that was chosen for a dark background, as dark as it takes to be seen on a light one.
inline mrpt::img::TColor onLight(const mrpt::img::TColor& c) {
    constexpr double kBrightest = 110.0;
    if (std::min({c.R, c.G, c.B}) > 204) return {31, 31, 31, c.A};  // white, and not one of the greys
    const double brightness = 0.3 * c.R + 0.59 * c.G + 0.11 * c.B;
    const double factor = std::min(1.0, kBrightest / std::max(1.0, brightness));
    const auto scaled = [factor](std::uint8_t v) { return static_cast<std::uint8_t>(factor * v + 0.5); };
    return {scaled(c.R), scaled(c.G), scaled(c.B), c.A};
}

constexpr mrpt::img::TColor kSpeedColor{190, 255, 60};

/// Where something that moves will be in a second, drawn on the top of its box; nothing for what does not, or where no
/// velocity is known.
inline std::optional<FlatArrow> speedArrow(const Obstacle& o) {
    if (!o.track || !o.track->moving || !o.track->velocity) return std::nullopt;
    const Eigen::Vector2d& v = *o.track->velocity;
    const Eigen::Vector3d top = o.box.center + Eigen::Vector3d(0.0, 0.0, 0.5 * o.box.size.z());
    return FlatArrow{top, std::atan2(v.y(), v.x()), v.norm(), 0.2};
}

/// What is known of a track: its speed, "stands" or "new", whether it is hidden, its age.
inline std::string trackText(const TrackState& t) {
    char text[80];
    std::string words = t.age > 0.0 ? "" : ", new";
    if (t.velocity && t.moving) {
        std::snprintf(text, sizeof text, ", %.1f m/s", t.velocity->norm());
        words += text;
    } else if (t.velocity) {
        words += ", stands";
    }
    if (!t.seen) words += ", hidden";
    if (!(t.age > 0.0)) return words;
    std::snprintf(text, sizeof text, ", %.1f s", t.age);
    return words + text;
}

/// What stands above a box; with `explain` also what gave the heading. The number of structure is that of one scan
/// alone, and is left out.
inline std::string labelText(const Obstacle& o, bool explain) {
    std::string words = toString(o.cls);
    if (o.id < kFirstUntrackedId) words += " " + std::to_string(o.id);
    char text[160];
    std::snprintf(text, sizeof text, ", %.1f m", distanceTo(o.box));
    words += text;
    if (o.track) words += trackText(*o.track);
    if (explain) {
        std::snprintf(text, sizeof text, "; %s %s, %d rings, %d returns", toString(o.rule), facesText(o.faces).c_str(),
                      o.num_rings, o.num_points);
        words += text;
    }
    return words;
}

}  // namespace lidar_obstacles
