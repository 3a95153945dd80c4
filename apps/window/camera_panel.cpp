// SPDX-License-Identifier: BSD-3-Clause
// The image of a camera, with the boxes in it.
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <type_traits>

#include "look_style.h"
#include "viewer.h"

namespace lidar_obstacles::apps {
namespace {

constexpr unsigned kBgr = 0x80E0;          ///< GL_BGR: the order of MRPT's images
constexpr unsigned kClampToEdge = 0x812F;  ///< GL_CLAMP_TO_EDGE
constexpr ImU32 kTruth = IM_COL32(90, 255, 90, 255);

/// Dear ImGui's name of a texture: a pointer in some versions, a number in others.
template <class Id>
Id textureOf(unsigned name) {
    if constexpr (std::is_pointer_v<Id>)
        return reinterpret_cast<Id>(static_cast<std::uintptr_t>(name));
    else
        return static_cast<Id>(name);
}

/// Where the image is in its panel: as large as fits, in the middle.
ScreenRect fitted(const ScreenRect& panel, float width, float height) {
    const float scale = std::min(panel.width / width, panel.height / height);
    const float w = std::floor(scale * width), h = std::floor(scale * height);
    return {std::floor(panel.x + 0.5F * (panel.width - w)), std::floor(panel.y + 0.5F * (panel.height - h)), w, h};
}

/// What is an image's pixel in the window.
class OnScreen {
  public:
    OnScreen(const ScreenRect& at, const mrpt::img::CImage& image)
        : at_(at), scale_(at.width / static_cast<float>(image.getWidth())) {}
    Eigen::Vector2f operator()(const Eigen::Vector2d& pixel) const {
        return {at_.x + scale_ * (static_cast<float>(pixel.x()) + 0.5F),
                at_.y + scale_ * (static_cast<float>(pixel.y()) + 0.5F)};
    }

  private:
    ScreenRect at_;
    float scale_;
};

void drawLines(const std::vector<ImageLine>& lines, const OnScreen& at, ImU32 color, float width) {
    for (const auto& [from, to] : lines) {
        const Eigen::Vector2f a = at(from), b = at(to);
        ImGui::GetWindowDrawList()->AddLine({a.x(), a.y()}, {b.x(), b.y()}, color, width);
    }
}

std::string captionOf(const CameraImage& image, const LayerData* scan, bool calibrated) {
    if (!image.problem.empty()) return image.label + ": " + image.problem;
    char text[64] = "";
    const int late = scan ? static_cast<int>(std::lround(1e3 * (image.time - scan->cloud.timestamp))) : 0;
    std::snprintf(text, sizeof text, "  %+d ms", late);
    return image.label + text + (calibrated ? "" : ", no calibration: no boxes");
}

}  // namespace

ImageTexture::~ImageTexture() {
    if (name_ != 0) glDeleteTextures(1, &name_);
}

unsigned ImageTexture::show(const std::shared_ptr<const CameraImage>& image) {
    if (image != shown_) {
        if (name_ == 0) glGenTextures(1, &name_);
        glBindTexture(GL_TEXTURE_2D, name_);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, kClampToEdge);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, kClampToEdge);
        const mrpt::img::CImage& picture = image->image;
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glPixelStorei(GL_UNPACK_ROW_LENGTH, static_cast<GLint>(picture.getRowStride() / 3));
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, static_cast<GLsizei>(picture.getWidth()),
                     static_cast<GLsizei>(picture.getHeight()), 0, kBgr, GL_UNSIGNED_BYTE,
                     picture.ptrLine<std::uint8_t>(0));
        glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        shown_ = image;
    }
    return name_;
}

void Viewer::drawImage(const ViewerFrame& frame) {
    const ScreenRect& panel = drawn_.layout.image;
    if (panel.width < 1.F || panel.height < 1.F) return;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.F, 0.F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.F, 1.F});
    beginPanel("camera", panel,
               ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoInputs);
    const CameraImage& image = *frame.image;
    if (!image.image.isEmpty()) {
        drawn_.image =
            fitted(panel, static_cast<float>(image.image.getWidth()), static_cast<float>(image.image.getHeight()));
        ImGui::SetCursorScreenPos({drawn_.image.x, drawn_.image.y});
        ImGui::Image(textureOf<ImTextureID>(texture_.show(frame.image)), {drawn_.image.width, drawn_.image.height});
        drawBoxesInImage(frame);
    }
    const std::string caption = captionOf(image, scan_.get(), CameraProjection(image).isCalibrated());
    const ImVec2 size = ImGui::CalcTextSize(caption.c_str(), nullptr, false, panel.width - 8.F);
    auto* list = ImGui::GetWindowDrawList();
    list->AddRectFilled({panel.x, panel.y}, {panel.x + size.x + 8.F, panel.y + size.y + 4.F}, paper(170));
    list->AddText(nullptr, 0.F, {panel.x + 4.F, panel.y + 2.F}, ink(), caption.c_str(), nullptr, panel.width - 8.F);
    ImGui::End();
    ImGui::PopStyleVar(2);
}

void Viewer::drawBoxesInImage(const ViewerFrame& frame) {
    if (!scan_) return;
    const CameraProjection projection(*frame.image);
    const OnScreen at(drawn_.image, frame.image->image);
    const ScreenRect& clip = drawn_.image;
    auto* list = ImGui::GetWindowDrawList();
    list->PushClipRect({clip.x, clip.y}, {clip.x + clip.width, clip.y + clip.height}, true);
    if (has(frame.view.layers, Layer::Truth))
        for (const TruthBox& t : scan_->truth) drawLines(projection.edgesOf(t.box), at, kTruth, 1.F);
    for (const Obstacle& o : scan_->result.obstacles) {
        if (!has(frame.view.layers, Layer::Boxes)) break;
        const auto lines = projection.edgesOf(o.box);
        const auto middle = projection.pixelOf(o.box.center);
        if (lines.empty()) continue;
        if (middle) drawn_.in_image[o.id] = at(*middle);
        const bool is_chosen = chosen_ == o.id;
        const bool is_structure = o.cls == ObstacleClass::Structure;
        drawLines(lines, at, is_chosen ? IM_COL32_WHITE : classColor(o.cls),
                  is_chosen      ? 2.5F
                  : is_structure ? 1.F
                                 : 1.5F);
    }
    list->PopClipRect();
}

}  // namespace lidar_obstacles::apps
