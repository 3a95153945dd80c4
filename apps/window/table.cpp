// SPDX-License-Identifier: BSD-3-Clause
// The table of obstacles.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <numeric>

#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "viewer.h"

namespace lidar_obstacles::apps {
namespace {

constexpr std::array<const char*, static_cast<std::size_t>(TableColumn::Count)> kTitles = {"id",  "class", "m",  "m/s",
                                                                                           "age", "p",     "pts"};
constexpr double kUnknown = -1.0;

/// What numbers are sorted by; below zero: not known.
double numberOf(const Obstacle& o, TableColumn column) {
    switch (column) {
        case TableColumn::Distance:
            return distanceTo(o.box);
        case TableColumn::Speed:
            if (!o.track || !o.track->velocity) return kUnknown;
            return o.track->moving ? o.track->velocity->norm() : 0.0;
        case TableColumn::Age:
            return o.track ? o.track->age : kUnknown;
        case TableColumn::Probability:
            return probabilityOf(o) > 0.F ? static_cast<double>(probabilityOf(o)) : kUnknown;
        case TableColumn::Returns:
            return o.num_points;
        case TableColumn::Class:
            return static_cast<double>(o.cls);
        default:
            return o.id;
    }
}

std::string cellText(const Obstacle& o, TableColumn column) {
    if (column == TableColumn::Class) return toString(o.cls);
    const double value = numberOf(o, column);
    if (column == TableColumn::Id ? o.id >= kFirstUntrackedId : value < 0.0) return "-";
    char text[32];
    const bool whole = column == TableColumn::Id || column == TableColumn::Returns;
    std::snprintf(text, sizeof text, whole ? "%.0f" : column == TableColumn::Probability ? "%.2f" : "%.1f", value);
    return text;
}

}  // namespace

std::vector<std::size_t> sortedBy(const std::vector<Obstacle>& obstacles, TableColumn column, bool ascending) {
    std::vector<std::size_t> order(obstacles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        const double x = numberOf(obstacles[a], column), y = numberOf(obstacles[b], column);
        if ((x < 0.0) != (y < 0.0) && column != TableColumn::Id) return y < 0.0;
        return ascending ? x < y : x > y;
    });
    return order;
}

void Viewer::drawTable() {
    constexpr auto kFlags = ImGuiTableFlags_Sortable | ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerV |
                            ImGuiTableFlags_ScrollY | ImGuiTableFlags_ScrollX | ImGuiTableFlags_SizingFixedFit;
    const float height = std::min(ImGui::GetTextLineHeightWithSpacing() * 14.F, 0.4F * ImGui::GetWindowHeight());
    if (!ImGui::BeginTable("obstacles", static_cast<int>(kTitles.size()), kFlags, {0.F, height})) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (std::size_t k = 0; k < kTitles.size(); ++k)
        ImGui::TableSetupColumn(kTitles[k], static_cast<TableColumn>(k) == TableColumn::Distance
                                                ? ImGuiTableColumnFlags_DefaultSort
                                                : ImGuiTableColumnFlags_None);
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (std::size_t k = 0; k < kTitles.size(); ++k) {
        ImGui::TableSetColumnIndex(static_cast<int>(k));
        ImGui::TableHeader(kTitles[k]);
        const ImVec2 low = ImGui::GetItemRectMin();
        drawn_.header_at[kTitles[k]] = {low.x + 12.F, low.y + 8.F};
    }
    const ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
    if (specs && specs->SpecsCount > 0) {
        sorted_by_ = static_cast<TableColumn>(specs->Specs[0].ColumnIndex);
        ascending_ = specs->Specs[0].SortDirection == ImGuiSortDirection_Ascending;
    }
    if (scan_)
        for (const std::size_t k : sortedBy(scan_->result.obstacles, sorted_by_, ascending_))
            drawRow(scan_->result.obstacles[k]);
    ImGui::EndTable();
}

void Viewer::drawRow(const Obstacle& obstacle) {
    ImGui::TableNextRow();
    for (std::size_t k = 0; k < kTitles.size(); ++k) {
        ImGui::TableSetColumnIndex(static_cast<int>(k));
        const std::string text = cellText(obstacle, static_cast<TableColumn>(k));
        if (k > 0) {
            ImGui::TextUnformatted(text.c_str());
            continue;
        }
        const std::string label = text + "##" + std::to_string(drawn_.rows.size());
        if (ImGui::Selectable(label.c_str(), chosen_ == obstacle.id, ImGuiSelectableFlags_SpanAllColumns))
            centreOn(obstacle);
        const ImVec2 low = ImGui::GetItemRectMin();
        drawn_.rows.push_back(obstacle.id);
        drawn_.row_at.emplace_back(low.x + 10.F, low.y + 6.F);
    }
}

}  // namespace lidar_obstacles::apps
