// SPDX-License-Identifier: BSD-3-Clause
#include "label_layout.h"

#include <algorithm>

namespace lidar_obstacles::apps {
namespace {

bool inside(const ScreenRect& r, const ScreenRect& scene) {
    return r.x >= scene.x && r.y >= scene.y && r.x + r.width <= scene.x + scene.width &&
           r.y + r.height <= scene.y + scene.height;
}

bool isFree(const ScreenRect& r, const std::vector<ScreenRect>& taken) {
    return std::none_of(taken.begin(), taken.end(), [&](const ScreenRect& t) { return r.meets(t); });
}

}  // namespace

std::vector<PlacedLabel> placeLabels(std::vector<SceneText> texts, const Projection& projection,
                                     const LabelSpace& space, const Eigen::Vector2f& letter) {
    const ScreenRect& scene = space.scene;
    std::stable_sort(texts.begin(), texts.end(), [&](const SceneText& a, const SceneText& b) {
        if (a.weight != b.weight) return a.weight > b.weight;
        return a.at.squaredNorm() < b.at.squaredNorm();
    });
    std::vector<ScreenRect> used = space.taken;
    std::vector<PlacedLabel> placed;
    for (const SceneText& text : texts) {
        const auto anchor = projection.pixelOf(text.at);
        if (!anchor || !scene.holds(anchor->x(), anchor->y())) continue;
        const float width = letter.x() * static_cast<float>(text.text.size()) + 2.F;
        for (const int lines : {0, -1, 1, -2, 2, -3}) {
            const float left =
                std::clamp(anchor->x() - 0.5F * width, scene.x, std::max(scene.x, scene.x + scene.width - width));
            const ScreenRect at{left, anchor->y() - (1.F - static_cast<float>(lines)) * letter.y(), width, letter.y()};
            if (!inside(at, scene) || !isFree(at, used)) continue;
            used.push_back(at);
            placed.push_back({text.text, text.color, at, *anchor});
            break;
        }
    }
    return placed;
}

}  // namespace lidar_obstacles::apps
