// SPDX-License-Identifier: BSD-3-Clause
// Outlines that are edited: their sides, and a square on each corner.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "look_style.h"
#include "viewer.h"

namespace lidar_obstacles::apps {
namespace {

constexpr float kHandle = 4.F;  ///< half a square's side [pixels]

ImU32 colorOf(OutlineKind kind) {
    switch (kind) {
        case OutlineKind::OwnBody:
            return IM_COL32(120, 200, 255, 255);
        case OutlineKind::Region:
            return IM_COL32(120, 150, 255, 255);
        case OutlineKind::Vehicle:
            return IM_COL32(255, 150, 220, 255);
        case OutlineKind::Zone:
            break;
    }
    return IM_COL32(255, 215, 70, 255);
}

/// A side on the ground, in pieces of at most two metres: what lies behind the camera is left out.
void drawEdge(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const GroundView& view, ImU32 color) {
    const int pieces = std::max(1, static_cast<int>(std::ceil((to - from).norm() / 2.0)));
    auto before = view.pixelOf(from);
    for (int k = 1; k <= pieces; ++k) {
        const auto here = view.pixelOf(from + (to - from) * k / pieces);
        if (before && here)
            ImGui::GetBackgroundDrawList()->AddLine({before->x(), before->y()}, {here->x(), here->y()}, color, 2.F);
        before = here;
    }
}

}  // namespace

void Viewer::drawOutlines(const OutlineEditor& editor) {
    const Projection projection = this->projection();
    const GroundView view = ground(projection);
    auto* list = ImGui::GetBackgroundDrawList();
    const ScreenRect& s = drawn_.layout.scene;
    list->PushClipRect({s.x, s.y}, {s.x + s.width, s.y + s.height});
    for (std::size_t o = 0; o < editor.outlines().size(); ++o) {
        const EditedOutline& outline = editor.outlines()[o];
        const ImU32 color = shade(colorOf(outline.kind));
        std::vector<Eigen::Vector2f> corners;
        corners.reserve(outline.corners.size());
        for (std::size_t k = 0; k < outline.corners.size(); ++k) {
            drawEdge(outline.corners[k], outline.corners[(k + 1) % outline.corners.size()], view, color);
            const auto at = view.pixelOf(outline.corners[k]);
            corners.push_back(at.value_or(Eigen::Vector2f(-1.F, -1.F)));
            if (!at) continue;
            const bool grabbed = editor.chosen() && editor.chosen()->outline == o && editor.chosen()->corner == k;
            const float half = grabbed ? kHandle + 2.F : kHandle;
            list->AddRectFilled({at->x() - half, at->y() - half}, {at->x() + half, at->y() + half},
                                grabbed ? ink() : color);
            if (k == 0) list->AddText({at->x() + half + 2.F, at->y() - half}, color, outline.name.c_str());
        }
        drawn_.outlines.push_back(std::move(corners));
    }
    list->PopClipRect();
}

}  // namespace lidar_obstacles::apps
