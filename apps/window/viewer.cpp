// SPDX-License-Identifier: BSD-3-Clause
#include "viewer.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "look_style.h"

namespace lidar_obstacles::apps {
namespace {

constexpr float kMargin = 6.F;          // [pixels]
constexpr float kBesideLegend = 112.F;  // [pixels]
constexpr float kRoomForTimes = 560.F;  // of the scene [pixels]

ImU32 colorOf(const mrpt::img::TColor& c) { return IM_COL32(c.R, c.G, c.B, 255); }

ImVec2 sizeOf(const std::string& text, float width) { return ImGui::CalcTextSize(text.c_str(), nullptr, false, width); }

/// A text on a dark ground, so that it can be read over points; broken into lines of at most `width`.
void drawText(const Eigen::Vector2f& at, const std::string& text, float width) {
    auto* list = ImGui::GetBackgroundDrawList();
    const ImVec2 size = sizeOf(text, width);
    list->AddRectFilled({at.x() - 3, at.y() - 2}, {at.x() + size.x + 3, at.y() + size.y + 2}, paper(130));
    list->AddText(nullptr, 0.F, {at.x(), at.y()}, ink(), text.c_str(), nullptr, width);
}

}  // namespace

void beginPanel(const char* name, const ScreenRect& at, int flags) {
    ImGui::SetNextWindowPos({at.x, at.y});
    ImGui::SetNextWindowSize({at.width, at.height});
    ImGui::Begin(name, nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | flags);
}

Viewer::Viewer(const std::string& title, int width, int height) : screen_(title, width, height), layers_(false) {}

void Viewer::setScan(const std::shared_ptr<const LayerData>& scan) {
    scan_ = scan;
    layers_.setScan(scan);
}

const Obstacle* Viewer::chosenObstacle() const {
    if (!scan_ || !chosen_) return nullptr;
    for (const Obstacle& o : scan_->result.obstacles)
        if (o.id == *chosen_) return &o;
    return nullptr;
}

const GroundModel& Viewer::groundModel() const {
    static const GroundModel kFlat;
    return scan_ ? scan_->result.ground : kFlat;
}

bool Viewer::tookCamera() { return std::exchange(took_camera_, false); }

void Viewer::centreOn(const Obstacle& obstacle) {
    CameraPlace place = screen_.camera();
    place.x = static_cast<float>(obstacle.box.center.x());
    place.y = static_cast<float>(obstacle.box.center.y());
    place.z = static_cast<float>(obstacle.box.center.z());
    screen_.setCamera(place);
    took_camera_ = true;
    chosen_ = obstacle.id;
}

/// A click beside everything takes the choice back.
void Viewer::takeClicks() {
    while (const auto at = screen_.nextClick()) {
        if (!scan_) continue;
        const Projection projection(screen_.camera(), drawn_.layout.scene);
        const auto hit = obstacleAt(scan_->result.obstacles, projection, at->x(), at->y());
        chosen_ = hit ? std::optional(scan_->result.obstacles[*hit].id) : std::nullopt;
    }
}

void Viewer::draw(const ViewerFrame& frame) {
    takeClicks();
    screen_.setLook(frame.view.look);
    layers_.setLight(frame.view.look.theme == Theme::Light);
    layers_.setPointColor(frame.view.color);
    layers_.setViewDistance(screen_.camera().distance);
    layers_.setVisible(frame.view.layers);
    if (const Obstacle* o = chosenObstacle())
        chosen_name_ = std::string(toString(o->cls)) + " " + std::to_string(o->id);
    const bool side = chosen_ || frame.view.tracks || (frame.view.panel && frame.parameters);
    drawn_ = {};
    const bool has_image = frame.image && !frame.image->image.isEmpty();
    const float shape = has_image ? static_cast<float>(frame.image->image.getWidth()) /
                                        static_cast<float>(frame.image->image.getHeight())
                                  : 4.F / 3.F;
    drawn_.layout = layoutOf({screen_.width(), screen_.height(), side, static_cast<bool>(frame.timeline),
                              frame.image ? shape : 0.F, frame.view.look.text_scale});
    setClipDistances(*layers_.scene(), screen_.camera().distance);
    screen_.draw(*layers_.scene(), drawn_.layout.scene, [&] {
        drawChosen();
        if (frame.outlines) drawOutlines(*frame.outlines);
        drawLabels(frame);
        drawTexts(frame);
        if (frame.view.legend) drawn_.legend = drawLegend(drawn_.layout.scene, frame.view.layers);
        if (frame.image) drawImage(frame);
        if (side) drawSide(frame);
        if (frame.timeline) frame.timeline(drawn_.layout.timeline);
    });
}

bool Viewer::timesShown(const SceneTexts& texts) const {
    return !texts.times.empty() &&
           drawn_.layout.scene.width >= kRoomForTimes * textScale() + sizeOf(texts.times, 0.F).x;
}

void Viewer::drawLabels(const ViewerFrame& frame) {
    const ScreenRect& s = drawn_.layout.scene;
    const float width = s.width - 2 * kMargin;
    const ImVec2 state = sizeOf(frame.texts.state, width),
                 layers = sizeOf(frame.texts.layers, width - kBesideLegend * textScale());
    std::vector<ScreenRect> taken = {{s.x, s.y, state.x + 2 * kMargin, state.y + 2 * kMargin}};
    taken.push_back({s.x, s.y + s.height - layers.y - 2 * kMargin, layers.x + 2 * kMargin, layers.y + 2 * kMargin});
    const ImVec2 times = sizeOf(frame.texts.times, width);
    if (timesShown(frame.texts))
        taken.push_back({s.x + s.width - times.x - 2 * kMargin, s.y, times.x, times.y + kMargin});
    if (frame.view.legend) taken.push_back(legendRect(s, frame.view.layers));
    const ImVec2 letter = ImGui::CalcTextSize("M");
    drawn_.labels = placeLabels(layers_.texts(), Projection(screen_.camera(), s), {s, taken}, {letter.x, letter.y});
    auto* list = ImGui::GetBackgroundDrawList();
    for (const PlacedLabel& l : drawn_.labels) {
        list->AddRectFilled({l.at.x, l.at.y}, {l.at.x + l.at.width, l.at.y + l.at.height}, paper(110));
        if (l.anchor.y() > l.at.y + l.at.height + 2.F)
            list->AddLine({l.anchor.x(), l.at.y + l.at.height}, {l.anchor.x(), l.anchor.y()},
                          IM_COL32(120, 120, 130, 160));
        list->AddText({l.at.x + 1, l.at.y}, shade(colorOf(l.color)), l.text.c_str());
    }
}

/// The box of the chosen obstacle in white.
void Viewer::drawChosen() const {
    const Obstacle* o = chosenObstacle();
    if (!o) return;
    const Projection projection(screen_.camera(), drawn_.layout.scene);
    const Eigen::Rotation2Dd turn(o->box.yaw);
    std::array<std::optional<Eigen::Vector2f>, 8> corners;
    for (std::size_t k = 0; k < 8; ++k) {
        const Eigen::Vector3d half = 0.5 * o->box.size + Eigen::Vector3d::Constant(0.06);
        const Eigen::Vector2d flat =
            turn * Eigen::Vector2d((k & 1) ? half.x() : -half.x(), (k & 2) ? half.y() : -half.y());
        corners[k] =
            projection.pixelOf(o->box.center + Eigen::Vector3d(flat.x(), flat.y(), (k & 4) ? half.z() : -half.z()));
    }
    auto* list = ImGui::GetBackgroundDrawList();
    const ScreenRect& s = drawn_.layout.scene;
    list->PushClipRect({s.x, s.y}, {s.x + s.width, s.y + s.height});
    for (std::size_t k = 0; k < 8; ++k)
        for (const std::size_t bit : {1U, 2U, 4U})
            if (!(k & bit) && corners[k] && corners[k | bit])
                list->AddLine({corners[k]->x(), corners[k]->y()}, {corners[k | bit]->x(), corners[k | bit]->y()},
                              isLight() ? IM_COL32_BLACK : IM_COL32_WHITE, 2.F);
    list->PopClipRect();
}

void Viewer::drawTexts(const ViewerFrame& frame) const {
    const ScreenRect& s = drawn_.layout.scene;
    const SceneTexts& t = frame.texts;
    const float width = s.width - 2 * kMargin;
    drawText({s.x + kMargin, s.y + kMargin}, t.state, width);
    if (timesShown(t)) drawText({s.x + s.width - sizeOf(t.times, width).x - kMargin, s.y + kMargin}, t.times, width);
    const float beside = width - kBesideLegend * textScale();
    float y = s.y + s.height - kMargin - sizeOf(t.layers, beside).y;
    drawText({s.x + kMargin, y}, t.layers, beside);
    if (!t.bottom.empty()) drawText({s.x + kMargin, y -= sizeOf(t.bottom, width).y + kMargin}, t.bottom, width);
    if (t.help.empty()) return;
    auto* list = ImGui::GetForegroundDrawList();
    const ImVec2 help = sizeOf(t.help, width);
    const float top = std::max(0.F, 0.5F * (s.height - help.y));
    list->AddRectFilled({s.x, top}, {s.x + help.x + 2 * kMargin, top + help.y}, paper(235));
    list->AddText({s.x + kMargin, top}, ink(), t.help.c_str());
}

void Viewer::drawSide(const ViewerFrame& frame) {
    beginPanel("side", drawn_.layout.side);
    if (frame.view.tracks && ImGui::CollapsingHeader("Obstacles", ImGuiTreeNodeFlags_DefaultOpen)) drawTable();
    if (chosen_) drawDetails(frame);
    if (frame.view.panel && frame.parameters && ImGui::CollapsingHeader("Parameters", ImGuiTreeNodeFlags_DefaultOpen))
        frame.parameters();
    ImGui::End();
}

void Viewer::drawDetails(const ViewerFrame& frame) {
    const Obstacle* o = chosenObstacle();
    if (!ImGui::CollapsingHeader((chosen_name_ + "###chosen").c_str(), ImGuiTreeNodeFlags_DefaultOpen)) return;
    if (!o) return ImGui::TextWrapped("%s", "It is not in this scan.");
    drawn_.numbers = numbersOf(*o);
    drawn_.reasons = reasonsOf(*o, *scan_);
    for (const Line& line : drawn_.numbers) {
        ImGui::TextDisabled("%s", line.name.c_str());
        ImGui::SameLine(76.F * textScale());
        ImGui::TextWrapped("%s", line.value.c_str());
    }
    const auto& points = frame.history(*o);
    drawn_.history = points.size();
    drawn_.plots = drawPlots(points, scan_->cloud.timestamp);
    ImGui::TextDisabled("%s", "why");
    for (const std::string& reason : drawn_.reasons) ImGui::TextWrapped("%s", reason.c_str());
    drawFeatures(*o);
}

/// Folded at first: measured only when they are looked at.
void Viewer::drawFeatures(const Obstacle& o) {
    const bool open = ImGui::TreeNode("features");
    const ImVec2 title = ImGui::GetItemRectMin();
    drawn_.features_at = {title.x + 10.F, title.y + 6.F};
    if (!open) return;
    if (measured_ != scan_ || measured_id_ != o.id) {
        measured_ = scan_;
        measured_id_ = o.id;
        features_ = featuresOf(o, *scan_);
    }
    drawn_.features = features_;
    if (features_.empty()) ImGui::TextWrapped("%s", "nothing was weighed for it");
    for (const Line& line : features_) {
        ImGui::TextDisabled("%s", line.name.c_str());
        if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", line.meaning.c_str());
        ImGui::SameLine(150.F * textScale());
        ImGui::TextUnformatted(line.value.c_str());
    }
    ImGui::TreePop();
}

}  // namespace lidar_obstacles::apps
