// SPDX-License-Identifier: BSD-3-Clause
#include "window_layout.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles::apps {
namespace {

constexpr float kTimelineHeight = 36.F;  // [pixels]
constexpr float kWidestSide = 400.F;     // [pixels]
constexpr float kScene = 2.F / 3.F;      // of the window, at least

}  // namespace

WindowLayout layoutOf(const WindowParts& parts) {
    const auto w = static_cast<float>(parts.width), h = static_cast<float>(parts.height);
    const bool image = parts.image > 0.F;
    const bool image_below = image && !parts.side && parts.image >= 1.5F;
    WindowLayout layout;
    const float below = parts.timeline ? std::floor(std::min(kTimelineHeight * parts.scale, 0.1F * h)) : 0.F;
    const float above = h - below;
    layout.timeline = {0, above, w, below};
    if (image_below) {
        const float high = std::floor(std::clamp(above - kScene * h, 0.F, w / parts.image));
        layout.scene = {0, 0, w, above - high};
        layout.image = {0, above - high, w, high};
        layout.side = {w, 0, 0, above - high};
        return layout;
    }
    const bool beside = parts.side || image;
    const float wide =
        beside ? std::floor(std::clamp(w - kScene * w * h / above, 0.F, kWidestSide * parts.scale)) : 0.F;
    const float high = image ? std::floor(std::min(wide / parts.image, parts.side ? 0.5F * above : above)) : 0.F;
    layout.scene = {0, 0, w - wide, above};
    layout.image = {w - wide, 0, wide, high};
    layout.side = {w - wide, high, parts.side ? wide : 0.F, above - high};
    return layout;
}

}  // namespace lidar_obstacles::apps
