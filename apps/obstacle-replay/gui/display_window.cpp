#include "display_window.h"

#include <GL/gl.h>
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
    first_ = scene->viewports().front().get();
    last_ = scene->viewports().back().get();
    observeBegin(window_);
    for (const auto& view : scene->viewports()) observeBegin(*view);
    change([&] {
        window_.get3DSceneAndLock() = scene;
        window_.unlockAccess3DScene();
    });
}

/// MRPT's window thread goes on painting a window that is being destroyed: it must have nothing left to paint.
DisplayWindow::~DisplayWindow() {
    for (std::uint64_t seen = frames_ + 1; isOpen() && seen != frames_;) {
        seen = frames_;
        std::this_thread::sleep_for(std::chrono::milliseconds(150));
    }
    observeEnd(window_);
}

void DisplayWindow::OnEvent(const mrpt::system::mrptEvent& event) {
    if (const auto* drawn = dynamic_cast<const mrpt::opengl::mrptEventGLPostRender*>(&event)) {
        if (drawn->source_viewport == first_) glGetIntegerv(GL_VIEWPORT, canvas_.data());
        if (drawn->source_viewport == last_) frameDrawn();
        return;
    }
    const auto* key = dynamic_cast<const mrptEventWindowChar*>(&event);
    if (!key || (key->char_code >= kFirstSpecial && codeOf(key->char_code) == key->char_code)) return;
    const std::lock_guard lock(mutex_);
    keys_.push_back({codeOf(key->char_code), (key->key_modifiers & mrpt::gui::MRPTKMOD_SHIFT) != 0});
}

/// Reads the picture before it is handed to the display: what MRPT reads afterwards can be an earlier one, or black.
void DisplayWindow::frameDrawn() {
    ++frames_;
    const std::lock_guard lock(mutex_);
    if (!picture_wanted_) return;
    picture_wanted_ = false;
    auto picture = mrpt::img::CImage::Create(canvas_[2], canvas_[3], mrpt::img::CH_RGB);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(picture->getRowStride() / 3));
    glReadPixels(canvas_[0], canvas_[1], canvas_[2], canvas_[3], GL_BGR, GL_UNSIGNED_BYTE,
                 picture->ptrLine<std::uint8_t>(0));
    picture->flipVertical();
    picture_ = picture;
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
    {
        const std::lock_guard lock(mutex_);
        picture_.reset();
        picture_wanted_ = true;
    }
    window_.repaint();
    mrpt::img::CImage::Ptr picture;
    for (int k = 0; k < 200 && !picture && isOpen(); ++k) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        const std::lock_guard lock(mutex_);
        picture = picture_;
    }
    if (!picture) throw std::runtime_error("no picture of the window");
    if (!picture->saveToFile(file)) throw std::runtime_error(file + ": cannot write");
}

}  // namespace lidar_obstacles::apps
