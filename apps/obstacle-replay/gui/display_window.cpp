#include "display_window.h"

#include <mrpt/gui/keycodes.h>
#include <mrpt/opengl/COpenGLViewport.h>

#include <chrono>
#include <map>
#include <stdexcept>
#include <thread>

namespace lidar_obstacles::apps {
namespace {

using mrpt::gui::mrptEventWindowChar;

/// Codes from here on are keys without a character: shift, function keys ...
constexpr int kFirstSpecial = mrpt::gui::MRPTK_START;

/// MRPT tells letters in upper case and keys of the number pad by codes of their own.
int codeOf(int key) {
    static const std::map<int, int> kCodes = {
        {mrpt::gui::MRPTK_LEFT, kLeft},
        {mrpt::gui::MRPTK_RIGHT, kRight},
        {mrpt::gui::MRPTK_UP, kUp},
        {mrpt::gui::MRPTK_DOWN, kDown},
        {mrpt::gui::MRPTK_HOME, kHome},
        {mrpt::gui::MRPTK_END, kEnd},
        {mrpt::gui::MRPTK_PAGEUP, kPageUp},
        {mrpt::gui::MRPTK_PAGEDOWN, kPageDown},
        {mrpt::gui::MRPTK_NUMPAD_ADD, '+'},
        {mrpt::gui::MRPTK_NUMPAD_SUBTRACT, '-'},
        {mrpt::gui::MRPTK_NUMPAD_DECIMAL, '.'},
        {mrpt::gui::MRPTK_NUMPAD_ENTER, kEnter},
    };
    const auto known = kCodes.find(key);
    if (known != kCodes.end()) return known->second;
    if (key >= mrpt::gui::MRPTK_NUMPAD0 && key <= mrpt::gui::MRPTK_NUMPAD9) return '0' + key - mrpt::gui::MRPTK_NUMPAD0;
    if (key >= 'A' && key <= 'Z') return key - 'A' + 'a';
    return key;
}

}  // namespace

DisplayWindow::DisplayWindow(const std::string& title, int width, int height,
                             const mrpt::opengl::COpenGLScene::Ptr& scene)
    : window_(title, static_cast<unsigned>(width), static_cast<unsigned>(height)) {
    if (!window_.isOpen()) throw std::runtime_error("--gui: no window can be opened on this display");
    observeBegin(window_);
    observeBegin(*scene->getViewport());
    change([&] { window_.get3DSceneAndLock() = scene, window_.unlockAccess3DScene(); });
}

DisplayWindow::~DisplayWindow() = default;

void DisplayWindow::OnEvent(const mrpt::system::mrptEvent& event) {
    if (dynamic_cast<const mrpt::opengl::mrptEventGLPostRender*>(&event)) ++frames_;
    const auto* key = dynamic_cast<const mrptEventWindowChar*>(&event);
    if (!key || (key->char_code >= kFirstSpecial && codeOf(key->char_code) == key->char_code)) return;
    const std::lock_guard lock(mutex_);
    keys_.push_back({codeOf(key->char_code), (key->key_modifiers & mrpt::gui::MRPTKMOD_SHIFT) != 0});
}

std::optional<KeyPress> DisplayWindow::nextKey() {
    const std::lock_guard lock(mutex_);
    if (keys_.empty()) return std::nullopt;
    const KeyPress key = keys_.front();
    keys_.pop_front();
    return key;
}

CameraPlace DisplayWindow::camera() const {
    CameraPlace place;
    window_.getCameraPointingToPoint(place.x, place.y, place.z);
    place.azimuth_deg = window_.getCameraAzimuthDeg();
    place.elevation_deg = window_.getCameraElevationDeg();
    place.distance = window_.getCameraZoom();
    return place;
}

void DisplayWindow::setCamera(const CameraPlace& place) {
    window_.setCameraPointingToPoint(place.x, place.y, place.z);
    window_.setCameraAzimuthDeg(place.azimuth_deg);
    window_.setCameraElevationDeg(place.elevation_deg);
    window_.setCameraZoom(place.distance);
}

void DisplayWindow::savePicture(const std::string& file) {
    window_.captureImagesStart();
    // MRPT reads what the display shows right after a frame was handed to it: that can be the frame before
    for (int k = 0; k < 4 && isOpen(); ++k) {
        const std::uint64_t before = frames_;
        window_.repaint();
        for (int wait = 0; wait < 100 && frames_ == before; ++wait)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    const auto picture = window_.getLastWindowImagePtr();
    window_.captureImagesStop();
    if (!picture) throw std::runtime_error("no picture of the window");
    if (!picture->saveToFile(file)) throw std::runtime_error(file + ": cannot write");
}

}  // namespace lidar_obstacles::apps
