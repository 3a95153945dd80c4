#include "window.h"

#include <cstdlib>
#include <stdexcept>
#include <utility>

#ifdef LIDAR_OBSTACLES_HAS_GUI
#include <mrpt/gui/CDisplayWindow3D.h>

#include "lidar_obstacles/mrpt_bridge/filter_scene.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"
#endif

namespace lidar_obstacles::apps {

#ifdef LIDAR_OBSTACLES_HAS_GUI

struct Window::Impl {
    mrpt::gui::CDisplayWindow3D window{"obstacle-live", 1000, 700};
};

Window::Window(OwnBody own_body) : own_body_(std::move(own_body)) {
    const char* display = std::getenv("DISPLAY");
    if (!display || !*display) throw std::runtime_error("--window needs a display: DISPLAY is not set");
    impl_ = std::make_unique<Impl>();
    if (!impl_->window.isOpen()) throw std::runtime_error(std::string("--window: cannot open display ") + display);
    impl_->window.setCameraPointingToPoint(8.F, 0.F, 0.F);
    impl_->window.setCameraZoom(38.F);
    impl_->window.setCameraAzimuthDeg(180.F);
    impl_->window.setCameraElevationDeg(32.F);
}

Window::~Window() = default;

bool Window::isOpen() const { return impl_->window.isOpen(); }

void Window::show(const SequenceResult& found, const ObstacleDetector& detector) {
    if (!isOpen()) return;
    SceneOptions options;
    options.own_body = own_body_;
    const auto scene = toScene(found.cloud, found.detection, options);
    if (found.filtered) addFilter(*scene, found, detector);
    scene->getViewport()->setViewportClipDistances(0.5F, 500.F);
    impl_->window.get3DSceneAndLock() = scene;
    impl_->window.unlockAccess3DScene();
    impl_->window.repaint();
}

#else

struct Window::Impl {};

Window::Window(OwnBody) { throw std::runtime_error("--window: this tool was built without MRPT's gui library"); }
Window::~Window() = default;
bool Window::isOpen() const { return false; }
void Window::show(const SequenceResult&, const ObstacleDetector&) {}

#endif

}  // namespace lidar_obstacles::apps
