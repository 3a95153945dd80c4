// SPDX-License-Identifier: BSD-3-Clause
#include "panels.h"

#include <imgui.h>

#include <algorithm>
#include <array>

#include "look_style.h"

namespace lidar_obstacles::apps {
namespace {

constexpr std::array<ImU32, 7> kMarkColors = {
    IM_COL32(70, 220, 110, 255), IM_COL32(255, 150, 40, 255), IM_COL32(255, 50, 40, 255),  IM_COL32(255, 225, 60, 255),
    IM_COL32(255, 80, 255, 255), IM_COL32(60, 200, 255, 255), IM_COL32(205, 205, 210, 255)};
constexpr float kMarkHeight = 5.F;  // [pixels]
constexpr float kMargin = 6.F;      // [pixels]

std::string markText(const Survey& survey, std::size_t scan) {
    std::string text;
    for (const Mark& m : survey.history().marks())
        if (m.scan == scan) text += (text.empty() ? "" : ", ") + std::string(toString(m.kind)) + ": " + m.text;
    return text;
}

/// Draws what lies on the bar.
void fillBar(const Player& player, const Survey& survey, const ScreenRect& bar) {
    auto* list = ImGui::GetWindowDrawList();
    const auto last = static_cast<float>(std::max<std::size_t>(2, player.store().size()) - 1);
    const auto x = [&](std::size_t scan) { return bar.x + bar.width * static_cast<float>(scan) / last; };
    const float low = bar.y, high = bar.y + bar.height;
    list->PushClipRect({bar.x - kMargin, low - kMargin}, {bar.x + bar.width + kMargin, high + kMargin});
    list->AddRectFilled({bar.x, low}, {bar.x + bar.width, high}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    if (survey.history().scans() > 0)
        list->AddRectFilled({bar.x, high - 3}, {x(survey.history().scans() - 1), high}, IM_COL32(80, 100, 140, 255));
    if (player.range())
        list->AddRectFilled({x(player.range()->first), low}, {x(player.range()->second), high},
                            IM_COL32(120, 150, 220, 110));
    const float lanes = (bar.height - kMarkHeight) / static_cast<float>(kMarkColors.size() - 1);
    for (const Mark& m : survey.history().marks()) {
        const float lane = low + lanes * static_cast<float>(m.kind);
        list->AddRectFilled({x(m.scan) - 1, lane}, {x(m.scan) + 1, lane + kMarkHeight},
                            shade(kMarkColors[static_cast<std::size_t>(m.kind)]));
    }
    list->AddRectFilled({x(player.position()) - 1.5F, low - 2}, {x(player.position()) + 1.5F, high + 2}, ink());
    list->PopClipRect();
}

}  // namespace

void drawTimeline(Player& player, const Survey& survey, const ScreenRect& at, ScreenRect& bar) {
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.F, 1.F});
    beginPanel("timeline", at, ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    bar = {at.x + kMargin, at.y + kMargin, at.width - 2 * kMargin, at.height - 2 * kMargin};
    ImGui::SetCursorScreenPos({bar.x, bar.y});
    ImGui::InvisibleButton("bar", {bar.width, bar.height});
    const auto scans = player.store().size();
    const float share = std::clamp((ImGui::GetIO().MousePos.x - bar.x) / bar.width, 0.F, 1.F);
    const auto under = static_cast<std::size_t>(share * static_cast<float>(std::max<std::size_t>(1, scans) - 1) + 0.5F);
    if (ImGui::IsItemActive() && scans > 0 && under != player.position()) player.goTo(under);
    const std::string text = ImGui::IsItemHovered() ? markText(survey, under) : "";
    if (!text.empty()) ImGui::SetTooltip("%s", text.c_str());
    fillBar(player, survey, bar);
    ImGui::End();
    ImGui::PopStyleVar();
}

}  // namespace lidar_obstacles::apps
