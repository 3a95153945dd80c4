/// @file
/// MRPT's window with what the replay needs of it: every key, the camera, pictures.
#pragma once

#include <mrpt/gui/CDisplayWindow3D.h>
#include <mrpt/system/CObserver.h>

#include <array>
#include <atomic>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "controls.h"

namespace lidar_obstacles::apps {

/// Where the window's camera is.
struct CameraPlace {
    float x = 0, y = 0, z = 0;  ///< looks at
    float azimuth_deg = 0, elevation_deg = 0;
    float distance = 0;
};

/// A window draws in a thread of its own: scenes are changed under its lock.
class DisplayWindow : private mrpt::system::CObserver {
  public:
    /// @param scene  complete: viewports are not added later.
    /// @throws std::runtime_error if no window comes up.
    DisplayWindow(const std::string& title, int width, int height, const mrpt::opengl::COpenGLScene::Ptr& scene);
    ~DisplayWindow() override;

    bool isOpen() { return window_.isOpen(); }
    /// The next key that was pressed.
    std::optional<KeyPress> nextKey();
    /// Frames drawn so far.
    std::uint64_t frames() const { return frames_; }

    /// Runs a function while the window does not draw, then draws anew.
    template <class Function>
    void change(Function&& function) {
        {
            window_.get3DSceneAndLock();
            const Unlock unlock{window_};
            function();
        }
        window_.repaint();
    }

    CameraPlace camera() const;
    void setCamera(const CameraPlace& place);

    /// Saves a picture of the window. @throws std::runtime_error if it cannot be taken or written.
    void savePicture(const std::string& file);

  private:
    struct Unlock {
        mrpt::gui::CDisplayWindow3D& window;
        ~Unlock() { window.unlockAccess3DScene(); }
    };
    void OnEvent(const mrpt::system::mrptEvent& event) override;

    void frameDrawn();

    const mrpt::opengl::COpenGLViewport* first_ = nullptr;  ///< covers the whole window
    const mrpt::opengl::COpenGLViewport* last_ = nullptr;   ///< drawn last
    std::array<int, 4> canvas_{};                           ///< of the window; the drawing thread's
    std::atomic<std::uint64_t> frames_{0};
    std::mutex mutex_;
    std::deque<KeyPress> keys_;
    bool picture_wanted_ = false;
    mrpt::img::CImage::Ptr picture_;
    mrpt::gui::CDisplayWindow3D window_;  ///< gone before what its thread writes to
};

}  // namespace lidar_obstacles::apps
