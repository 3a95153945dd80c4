// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How a window looks: dark or light, and how large its texts are.
#pragma once

#include <cstdint>

namespace CLI {
class App;
}

namespace lidar_obstacles::apps {

enum class Theme : std::uint8_t { Dark, Light };
/// "dark" or "light".
const char* toString(Theme theme);

struct Look {
    static constexpr float kSmallest = 0.5F, kLargest = 3.F, kStep = 0.25F;

    Theme theme = Theme::Dark;
    float text_scale = 1.F;  ///< kSmallest to kLargest; 1: letters of 13 pixels

    bool operator==(const Look& o) const { return theme == o.theme && text_scale == o.text_scale; }
    bool operator!=(const Look& o) const { return !(*this == o); }
    /// With texts a step larger (+1) or smaller (-1).
    Look scaled(int direction) const;
};

/// Adds --theme and --text-scale to a command line.
void addLookOptions(CLI::App& app, Look& look);

}  // namespace lidar_obstacles::apps
