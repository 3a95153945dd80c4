// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A window with a scene and panels of Dear ImGui around it: every key, the mouse, the camera, pictures.
#pragma once

#include <mrpt/opengl/COpenGLScene.h>

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "controls.h"
#include "projection.h"

struct GLFWwindow;

namespace lidar_obstacles::apps {

constexpr CameraPlace kFromAbove{5.F, 0.F, 0.F, 180.F, 90.F, 60.F};

/// STEM_0.png or, where there are such files, the first number that is free; in the working folder.
std::string freePictureName(const std::string& stem);

/// Something that is held by the mouse.
struct Drag {
    enum class Phase : std::uint8_t { Begin, Move, End };
    Phase phase = Phase::Begin;
    Eigen::Vector2f at;  ///< [pixels]
};

/// To be made, used and destroyed by one thread; one at a time.
class Screen {
  public:
    /// @throws std::runtime_error if no window comes up.
    Screen(const std::string& title, int width, int height);
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    /// Takes in what the user did since the last call. Scenes are turned (left button), moved (right button) and zoomed
    /// (wheel) by the mouse.
    void poll();
    bool isOpen() const;
    /// True if the panels or the camera want to be drawn anew.
    bool wantsFrame() const { return frames_wanted_ > 0; }
    std::optional<KeyPress> nextKey();
    /// What the left button takes hold of, to move it instead of the camera: asked at each press in the scene.
    void setGrab(std::function<bool(const Eigen::Vector2f&)> wants) { wants_ = std::move(wants); }
    std::optional<Drag> nextDrag();
    /// A place in the scene that was clicked [pixels].
    std::optional<Eigen::Vector2f> nextClick();

    int width() const { return width_; }
    int height() const { return height_; }
    /// Draws the scene into a part of the window, then the panels over it.
    void draw(mrpt::opengl::COpenGLScene& scene, const ScreenRect& part, const std::function<void()>& panels);
    /// Frames drawn so far.
    std::uint64_t frames() const { return frames_; }

    /// Colours and letters of the panels, and the ground that scenes are drawn on, from the next draw() on.
    void setLook(const Look& look);

    const CameraPlace& camera() const { return camera_; }
    void setCamera(const CameraPlace& place) { camera_ = place; }
    /// So many steps of a key farther (positive) or nearer.
    void zoom(int steps);

    /// The next draw() saves a picture; it throws std::runtime_error if that cannot be written.
    void savePicture(const std::string& file) { picture_file_ = file; }

  private:
    void connect();
    void onKey(int key, int mods);
    void onButton(int button, bool down);
    void onMove(float x, float y);
    void onWheel(double steps);
    void writePicture(const std::string& file) const;

    GLFWwindow* window_ = nullptr;
    Look look_;
    ScreenRect scene_;  ///< where it was drawn last
    CameraPlace camera_;
    int width_ = 0, height_ = 0;
    std::uint64_t frames_ = 0;
    int frames_wanted_ = 3;
    int button_ = -1;  ///< that is down in the scene; -1: none
    Eigen::Vector2f mouse_{0, 0}, pressed_at_{0, 0};
    std::string picture_file_;  ///< to be written; empty: none
    std::deque<KeyPress> keys_;
    std::deque<Eigen::Vector2f> clicks_;
    std::function<bool(const Eigen::Vector2f&)> wants_;
    bool grabbed_ = false;
    std::deque<Drag> drags_;
};

}  // namespace lidar_obstacles::apps
