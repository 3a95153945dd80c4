// SPDX-License-Identifier: BSD-3-Clause
#include "param_list.h"

#include <imgui.h>

#include "look_style.h"

namespace lidar_obstacles::apps {
namespace {

constexpr ImU32 kChanged = IM_COL32(255, 217, 77, 255);

void drawParameter(const ParamRow& row, bool chosen, std::size_t place, ParamPanel& panel) {
    const std::string text = (row.changed ? "* " : "  ") + row.key + "  " + row.value + " " + row.unit;
    if (row.changed) ImGui::PushStyleColor(ImGuiCol_Text, shade(kChanged));
    if (ImGui::Selectable((text + "##" + std::to_string(place)).c_str(), chosen)) panel.chooseAt(place);
    if (row.changed) ImGui::PopStyleColor();
    if (chosen) ImGui::TextWrapped("%s", row.text.c_str());
}

}  // namespace

DrawnParameters drawParameters(const DetectorParams& params, ParamPanel& panel, std::size_t& shown) {
    const std::vector<ParamRow> rows = paramRows(params);
    const std::size_t chosen = panel.place();
    const bool other = chosen != shown;
    shown = chosen;
    DrawnParameters drawn;
    for (std::size_t k = 0; k < rows.size();) {
        const std::size_t begin = k;
        std::size_t changed = 0;
        for (; k < rows.size() && rows[k].section == rows[begin].section; ++k) changed += rows[k].changed ? 1 : 0;
        std::string title = rows[begin].section;
        if (changed > 0) title += " *" + std::to_string(changed);
        if (other && chosen >= begin && chosen < k) ImGui::SetNextItemOpen(true);
        if (!ImGui::TreeNode((title + "###" + rows[begin].section).c_str())) continue;
        drawn.open_groups.push_back(rows[begin].section);
        for (std::size_t i = begin; i < k; ++i) {
            drawParameter(rows[i], i == chosen, i, panel);
            if (rows[i].changed) drawn.starred.push_back(rows[i].section + "." + rows[i].key);
            if (other && i == chosen) ImGui::SetScrollHereY();
        }
        ImGui::TreePop();
    }
    return drawn;
}

}  // namespace lidar_obstacles::apps
