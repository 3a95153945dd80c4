// SPDX-License-Identifier: BSD-3-Clause
// The legend, and what became of an obstacle as curves.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "look_style.h"
#include "viewer.h"

namespace lidar_obstacles::apps {
namespace {

constexpr float kPlotHeight = 38.F;  ///< [pixels], for a scale of 1, as the others
constexpr float kLegendWidth = 100.F;
constexpr std::array<ImU32, 5> kClassColors = {IM_COL32(255, 255, 255, 255), IM_COL32(255, 140, 0, 255),
                                               IM_COL32(0, 255, 255, 255), IM_COL32(200, 120, 255, 255),
                                               IM_COL32(130, 130, 130, 255)};

/// A value over time; not a number: not known.
struct Curve {
    ImU32 color;
    std::function<float(const HistoryPoint&)> value;
    const char* name = "";  ///< in its colour above the plot
};

struct Plot {
    const char* name;
    const char* unit;
    std::vector<Curve> curves;
    float most = 0.F;  ///< upper end of the axis; 0: as the values need
};

float upperEnd(const Plot& plot, const std::vector<HistoryPoint>& points) {
    if (plot.most > 0.F) return plot.most;
    float most = 1.F;
    for (const Curve& c : plot.curves)
        for (const HistoryPoint& p : points)
            if (std::isfinite(c.value(p))) most = std::max(most, c.value(p));
    return most;
}

void drawTitle(const Plot& plot, float most) {
    ImGui::TextDisabled("%s, 0 to %.3g%s", plot.name, static_cast<double>(most), plot.unit);
    for (const Curve& c : plot.curves) {
        if (*c.name == '\0') continue;
        ImGui::SameLine();
        ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(shade(c.color)), "%s", c.name);
    }
}

void draw(const Plot& plot, const std::vector<HistoryPoint>& points, double now) {
    const float most = upperEnd(plot, points);
    drawTitle(plot, most);
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const float height = kPlotHeight * textScale();
    const float width = std::max(40.F, ImGui::GetContentRegionAvail().x);
    ImGui::Dummy({width, height});
    auto* list = ImGui::GetWindowDrawList();
    list->AddRectFilled(low, {low.x + width, low.y + height}, ImGui::GetColorU32(ImGuiCol_FrameBg));
    const double begin = points.front().time, span = std::max(0.1, points.back().time - begin);
    const auto at = [&](double time, float value) {
        return ImVec2(low.x + 1 + (width - 2) * static_cast<float>((time - begin) / span),
                      low.y + 1 + (height - 2) * (1.F - std::clamp(value / most, 0.F, 1.F)));
    };
    if (now >= begin && now <= begin + span) list->AddLine(at(now, 0.F), at(now, most), IM_COL32(110, 110, 120, 255));
    for (const Curve& c : plot.curves) {
        const ImU32 color = shade(c.color);
        for (std::size_t k = 0; k < points.size(); ++k) {
            const float value = c.value(points[k]);
            const float before = k > 0 ? c.value(points[k - 1]) : value;
            if (!std::isfinite(value)) continue;
            const ImVec2 here = at(points[k].time, value);
            if (k > 0 && std::isfinite(before)) list->AddLine(at(points[k - 1].time, before), here, color, 1.5F);
            if (points.size() < 30) list->AddRectFilled({here.x - 1, here.y - 1}, {here.x + 1, here.y + 1}, color);
        }
    }
}

std::vector<Plot> plotsOfAnObstacle() {
    using Point = HistoryPoint;
    Plot classes{"class", "", {}, 1.F};
    for (std::size_t k = 0; k < kClassColors.size(); ++k)
        classes.curves.push_back({kClassColors[k], [k](const Point& p) { return p.classes[k]; }});
    return {{"speed", " m/s", {{IM_COL32(190, 255, 60, 255), [](const Point& p) { return p.speed.value_or(NAN); }}}},
            {"distance", " m", {{IM_COL32(135, 206, 250, 255), [](const Point& p) { return p.distance; }}}},
            {"size",
             " m",
             {{IM_COL32(255, 170, 90, 255), [](const Point& p) { return p.size.x(); }, "length"},
              {IM_COL32(110, 220, 150, 255), [](const Point& p) { return p.size.y(); }, "width"},
              {IM_COL32(150, 150, 255, 255), [](const Point& p) { return p.size.z(); }, "height"}}},
            classes};
}

struct Entry {
    ImU32 color;
    const char* text;
    Layer layer;
};
constexpr std::array<Entry, 14> kEntries = {{{kClassColors[1], "vehicle", Layer::Boxes},
                                             {kClassColors[2], "pedestrian", Layer::Boxes},
                                             {kClassColors[3], "cyclist", Layer::Boxes},
                                             {kClassColors[0], "unknown", Layer::Boxes},
                                             {kClassColors[4], "structure", Layer::Boxes},
                                             {IM_COL32(190, 255, 60, 255), "in a second", Layer::Tracks},
                                             {IM_COL32(150, 118, 84, 255), "ground", Layer::Ground},
                                             {IM_COL32(255, 60, 60, 255), "taken out", Layer::Filtered},
                                             {IM_COL32(110, 160, 235, 255), "voxels", Layer::Voxels},
                                             {IM_COL32(255, 60, 255, 255), "rejected", Layer::Rejected},
                                             {IM_COL32(0, 230, 64, 255), "joined", Layer::Merges},
                                             {IM_COL32(255, 60, 60, 255), "not joined", Layer::Merges},
                                             {IM_COL32(90, 255, 90, 255), "truth", Layer::Truth},
                                             {IM_COL32(120, 170, 255, 255), "region", Layer::Region}}};

std::vector<Entry> entriesOf(const LayerSet& layers) {
    std::vector<Entry> shown;
    for (const Entry& e : kEntries)
        if (has(layers, e.layer)) shown.push_back(e);
    return shown;
}

}  // namespace

std::uint32_t classColor(ObstacleClass cls) { return kClassColors[static_cast<std::size_t>(cls)]; }

std::vector<std::string> drawPlots(const std::vector<HistoryPoint>& points, double now) {
    std::vector<std::string> names;
    if (points.empty()) return names;
    ImGui::TextDisabled("%.1f s of history", points.back().time - points.front().time);
    for (const Plot& plot : plotsOfAnObstacle()) {
        draw(plot, points, now);
        names.emplace_back(plot.name);
    }
    return names;
}

ScreenRect legendRect(const ScreenRect& scene, const LayerSet& layers) {
    const float height = ImGui::GetTextLineHeight() * static_cast<float>(entriesOf(layers).size()) + 6.F;
    const float width = kLegendWidth * textScale();
    return {scene.x + scene.width - width - 6.F, scene.y + scene.height - height - 6.F, width, height};
}

std::vector<std::string> drawLegend(const ScreenRect& scene, const LayerSet& layers) {
    const std::vector<Entry> shown = entriesOf(layers);
    const ScreenRect at = legendRect(scene, layers);
    const float scale = textScale();
    std::vector<std::string> lines;
    auto* list = ImGui::GetBackgroundDrawList();
    list->AddRectFilled({at.x, at.y}, {at.x + at.width, at.y + at.height}, paper(150));
    for (std::size_t k = 0; k < shown.size(); ++k) {
        const float y = at.y + 3.F + ImGui::GetTextLineHeight() * static_cast<float>(k);
        list->AddRectFilled({at.x + 5 * scale, y + 3 * scale}, {at.x + 13 * scale, y + 11 * scale},
                            shade(shown[k].color));
        list->AddText({at.x + 18 * scale, y}, ink(), shown[k].text);
        lines.emplace_back(shown[k].text);
    }
    return lines;
}

}  // namespace lidar_obstacles::apps
