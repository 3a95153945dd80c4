// SPDX-License-Identifier: BSD-3-Clause
#include "look_style.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles::apps {
namespace {

constexpr float kLetters = 13.F;  ///< [pixels]

}  // namespace

void applyLook(const Look& look) {
    ImGuiStyle style;
    style.WindowRounding = 0.F;
    look.theme == Theme::Light ? ImGui::StyleColorsLight(&style) : ImGui::StyleColorsDark(&style);
    style.ScaleAllSizes(look.text_scale);
    ImGui::GetStyle() = style;
    ImFontConfig letters;
    letters.SizePixels = std::round(kLetters * look.text_scale);
    ImGui::GetIO().Fonts->Clear();
    ImGui::GetIO().Fonts->AddFontDefault(&letters);
}

float textScale() { return ImGui::GetFontSize() / kLetters; }

bool isLight() { return ImGui::GetStyle().Colors[ImGuiCol_WindowBg].x > 0.5F; }

ImU32 ink() { return isLight() ? IM_COL32(15, 18, 25, 255) : IM_COL32(224, 230, 240, 255); }

ImU32 paper(int alpha) { return isLight() ? IM_COL32(250, 250, 252, alpha) : IM_COL32(5, 5, 8, alpha); }

ImU32 shade(ImU32 color) {
    constexpr float kBrightest = 0.43F;
    if (!isLight()) return color;
    ImVec4 c = ImGui::ColorConvertU32ToFloat4(color);
    const float brightness = 0.3F * c.x + 0.59F * c.y + 0.11F * c.z;
    const bool white = std::min({c.x, c.y, c.z}) > 0.8F;
    if (white) return ImGui::ColorConvertFloat4ToU32({0.12F, 0.12F, 0.12F, c.w});  // and not one of the greys
    const float factor = std::min(1.F, kBrightest / std::max(1e-3F, brightness));
    return ImGui::ColorConvertFloat4ToU32({factor * c.x, factor * c.y, factor * c.z, c.w});
}

}  // namespace lidar_obstacles::apps
