// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/opengl/CFBORender.h>

#include <algorithm>
#include <stdexcept>

#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles {
namespace {

/// MRPT asks OpenGL for rows that follow each other without a gap, and gets rows that begin at multiples of four bytes:
/// of other widths the picture is sheared and ends behind its memory. This one needs no gap.
unsigned widthWithoutGap(int width) { return (static_cast<unsigned>(width) + 3U) / 4U * 4U; }

}  // namespace

void setClipDistances(mrpt::opengl::COpenGLScene& scene, double distance) {
    const double near = std::clamp(0.05 * distance, 0.2, 5.0);
    scene.getViewport()->setViewportClipDistances(static_cast<float>(near), 500.F);
}

SceneRenderer::SceneRenderer(int width, int height) : width_(width), height_(height) {
    if (width <= 0 || height <= 0) throw std::invalid_argument("SceneRenderer: width and height must be positive");
    try {
        renderer_ = std::make_unique<mrpt::opengl::CFBORender>(widthWithoutGap(width), static_cast<unsigned>(height));
    } catch (const std::exception&) {  // MRPT's text is a failed assertion about the number of devices
        throw std::runtime_error("no pictures: off-screen rendering (EGL) is not available on this machine");
    }
}

SceneRenderer::~SceneRenderer() = default;
SceneRenderer::SceneRenderer(SceneRenderer&&) noexcept = default;
SceneRenderer& SceneRenderer::operator=(SceneRenderer&&) noexcept = default;

mrpt::img::CImage SceneRenderer::render(mrpt::opengl::COpenGLScene& scene, const CameraView& view) {
    auto& camera = renderer_->getCamera(scene);
    camera.setPointingAt(view.target.x(), view.target.y(), view.target.z());
    camera.setZoomDistance(static_cast<float>(view.distance));
    camera.setAzimuthDegrees(static_cast<float>(view.azimuth_deg));
    camera.setElevationDegrees(static_cast<float>(view.elevation_deg));
    setClipDistances(scene, view.distance);
    mrpt::img::CImage picture;
    renderer_->render_RGB(scene, picture);
    if (picture.getWidth() == static_cast<std::size_t>(width_)) return picture;
    mrpt::img::CImage part;
    picture.extract_patch(part, 0, 0, static_cast<unsigned>(width_), static_cast<unsigned>(height_));
    return part;
}

}  // namespace lidar_obstacles
