// SPDX-License-Identifier: BSD-3-Clause
#include "screen.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>
#include <mrpt/img/CImage.h>
#include <mrpt/opengl/CCamera.h>
#include <mrpt/opengl/COpenGLViewport.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <utility>

#include "look_style.h"

namespace lidar_obstacles::apps {
namespace {

constexpr int kFramesAfterInput = 3;  ///< until the panels of Dear ImGui have settled
constexpr float kDegreesPerPixel = 0.3F;
constexpr float kClick = 4.F;  ///< a press that moves no farther is a click [pixels]

/// Keys as Controls knows them; 0: none of them.
int codeOf(int key) {
    static const std::map<int, int> kCodes = {
        {GLFW_KEY_LEFT, kLeft},      {GLFW_KEY_RIGHT, kRight},
        {GLFW_KEY_UP, kUp},          {GLFW_KEY_DOWN, kDown},
        {GLFW_KEY_HOME, kHome},      {GLFW_KEY_END, kEnd},
        {GLFW_KEY_PAGE_UP, kPageUp}, {GLFW_KEY_PAGE_DOWN, kPageDown},
        {GLFW_KEY_ENTER, kEnter},    {GLFW_KEY_KP_ENTER, kEnter},
        {GLFW_KEY_ESCAPE, kEscape},  {GLFW_KEY_BACKSPACE, kBackspace},
        {GLFW_KEY_DELETE, kDelete},  {GLFW_KEY_F2, kF2},
        {GLFW_KEY_F3, kF3},          {GLFW_KEY_F6, kF6},
        {GLFW_KEY_F7, kF7},          {GLFW_KEY_F8, kF8},
        {GLFW_KEY_KP_ADD, '+'},      {GLFW_KEY_KP_SUBTRACT, '-'},
        {GLFW_KEY_KP_DECIMAL, '.'},  {GLFW_KEY_KP_DIVIDE, '/'},
    };
    const auto known = kCodes.find(key);
    if (known != kCodes.end()) return known->second;
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) return '0' + key - GLFW_KEY_KP_0;
    if (key >= 'A' && key <= 'Z') return key - 'A' + 'a';
    return key >= ' ' && key < 127 ? key : 0;
}

Screen& screenOf(GLFWwindow* window) { return *static_cast<Screen*>(glfwGetWindowUserPointer(window)); }

void lookAt(mrpt::opengl::CCamera& camera, const CameraPlace& place) {
    camera.setPointingAt(place.x, place.y, place.z);
    camera.setAzimuthDegrees(place.azimuth_deg);
    camera.setElevationDegrees(place.elevation_deg);
    camera.setZoomDistance(place.distance);
}

}  // namespace

std::string freePictureName(const std::string& stem) {
    for (int k = 0;; ++k) {
        std::string name = stem + "_" + std::to_string(k) + ".png";
        if (!std::filesystem::exists(name)) return name;
    }
}

Screen::Screen(const std::string& title, int width, int height) : width_(width), height_(height) {
    if (glfwInit() == GLFW_FALSE) throw std::runtime_error("no window can be opened on this display");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_COMPAT_PROFILE);
    window_ = glfwCreateWindow(width, height, title.c_str(), nullptr, nullptr);
    if (!window_) {
        glfwTerminate();
        throw std::runtime_error("no window with OpenGL 3.3 can be opened on this display");
    }
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(0);
    connect();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    applyLook(look_);
    ImGui_ImplGlfw_InitForOpenGL(window_, true);  // calls the functions that are set already first
    ImGui_ImplOpenGL3_Init("#version 130");
}

Screen::~Screen() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

void Screen::connect() {
    glfwSetWindowUserPointer(window_, this);
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int mods) {
        if (action != GLFW_RELEASE) screenOf(w).onKey(key, mods);
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int) {
        screenOf(w).onButton(button, action == GLFW_PRESS);
    });
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
        screenOf(w).onMove(static_cast<float>(x), static_cast<float>(y));
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) { screenOf(w).onWheel(y); });
    glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { screenOf(w).frames_wanted_ = kFramesAfterInput; });
    glfwSetFramebufferSizeCallback(window_,
                                   [](GLFWwindow* w, int, int) { screenOf(w).frames_wanted_ = kFramesAfterInput; });
}

void Screen::onKey(int key, int mods) {
    frames_wanted_ = kFramesAfterInput;
    const int code = codeOf(key);
    if (code != 0 && (mods & (GLFW_MOD_ALT | GLFW_MOD_CONTROL)) == 0)
        keys_.push_back({code, (mods & GLFW_MOD_SHIFT) != 0});
}

void Screen::onButton(int button, bool down) {
    frames_wanted_ = kFramesAfterInput;
    double x = 0, y = 0;
    glfwGetCursorPos(window_, &x, &y);
    onMove(static_cast<float>(x), static_cast<float>(y));
    if (down) {
        if (!scene_.holds(mouse_.x(), mouse_.y())) return;
        grabbed_ = button == GLFW_MOUSE_BUTTON_LEFT && wants_ && wants_(mouse_);
        if (grabbed_) return drags_.push_back({Drag::Phase::Begin, mouse_});
        button_ = button;
        pressed_at_ = mouse_;
        return;
    }
    if (grabbed_ && button == GLFW_MOUSE_BUTTON_LEFT) {
        grabbed_ = false;
        return drags_.push_back({Drag::Phase::End, mouse_});
    }
    if (button_ == GLFW_MOUSE_BUTTON_LEFT && (mouse_ - pressed_at_).norm() < kClick) clicks_.push_back(mouse_);
    button_ = -1;
}

void Screen::onMove(float x, float y) {
    const Eigen::Vector2f moved = Eigen::Vector2f(x, y) - mouse_;
    mouse_ += moved;
    frames_wanted_ = kFramesAfterInput;
    if (grabbed_) return drags_.push_back({Drag::Phase::Move, mouse_});
    if (button_ < 0 || (mouse_ - pressed_at_).norm() < kClick) return;
    if (button_ == GLFW_MOUSE_BUTTON_LEFT) {
        camera_.azimuth_deg = std::remainder(camera_.azimuth_deg - kDegreesPerPixel * moved.x(), 360.F);
        camera_.elevation_deg = std::clamp(camera_.elevation_deg + kDegreesPerPixel * moved.y(), -5.F, 90.F);
        return;
    }
    const float azimuth = camera_.azimuth_deg * static_cast<float>(M_PI) / 180.F;
    const float per_pixel = camera_.distance * 0.54F / std::max(1.F, scene_.height);
    const float right = -moved.x() * per_pixel, ahead = moved.y() * per_pixel;
    camera_.x += -std::sin(azimuth) * right - std::cos(azimuth) * ahead;
    camera_.y += std::cos(azimuth) * right - std::sin(azimuth) * ahead;
}

void Screen::onWheel(double steps) {
    frames_wanted_ = kFramesAfterInput;
    if (scene_.holds(mouse_.x(), mouse_.y()))
        camera_.distance = std::clamp(camera_.distance * std::pow(0.9F, static_cast<float>(steps)), 1.F, 400.F);
}

void Screen::setLook(const Look& look) {
    if (look == look_) return;
    look_ = look;
    applyLook(look);
    if (frames_ > 0) {  // before, the letters are not on the graphics card yet
        ImGui_ImplOpenGL3_DestroyFontsTexture();
        ImGui_ImplOpenGL3_CreateFontsTexture();
    }
    frames_wanted_ = kFramesAfterInput;
}

void Screen::poll() { glfwPollEvents(); }

bool Screen::isOpen() const { return glfwWindowShouldClose(window_) == GLFW_FALSE; }

std::optional<KeyPress> Screen::nextKey() {
    if (keys_.empty()) return std::nullopt;
    const KeyPress key = keys_.front();
    keys_.pop_front();
    return key;
}

std::optional<Eigen::Vector2f> Screen::nextClick() {
    if (clicks_.empty()) return std::nullopt;
    const Eigen::Vector2f at = clicks_.front();
    clicks_.pop_front();
    return at;
}

std::optional<Drag> Screen::nextDrag() {
    if (drags_.empty()) return std::nullopt;
    const Drag drag = drags_.front();
    drags_.pop_front();
    return drag;
}

void Screen::draw(mrpt::opengl::COpenGLScene& scene, const ScreenRect& part, const std::function<void()>& panels) {
    frames_wanted_ = std::max(0, frames_wanted_ - 1);
    scene_ = part;
    glfwGetFramebufferSize(window_, &width_, &height_);
    glDisable(GL_SCISSOR_TEST);
    glViewport(0, 0, width_, height_);
    const float ground = look_.theme == Theme::Light ? 0.93F : 0.03F;
    glClearColor(ground, ground, ground + 0.01F, 1.F);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    const auto view = scene.getViewport();
    lookAt(view->getCamera(), camera_);
    view->render(static_cast<int>(part.width), static_cast<int>(part.height), static_cast<int>(part.x),
                 height_ - static_cast<int>(part.y + part.height));
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
    panels();
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    const std::string file = std::exchange(picture_file_, "");
    if (!file.empty()) writePicture(file);
    glfwSwapBuffers(window_);
    glfwGetFramebufferSize(window_, &width_, &height_);
    ++frames_;
}

/// Read before it is handed to the display: afterwards it may be an earlier one, or black.
void Screen::writePicture(const std::string& file) const {
    mrpt::img::CImage picture(static_cast<unsigned>(width_), static_cast<unsigned>(height_), mrpt::img::CH_RGB);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ROW_LENGTH, static_cast<GLint>(picture.getRowStride() / 3));
    glReadPixels(0, 0, width_, height_, 0x80E0 /* GL_BGR */, GL_UNSIGNED_BYTE, picture.ptrLine<std::uint8_t>(0));
    picture.flipVertical();
    if (!picture.saveToFile(file)) throw std::runtime_error(file + ": cannot write");
}

void Screen::zoom(int steps) { camera_.distance *= std::pow(1.2F, static_cast<float>(steps)); }

}  // namespace lidar_obstacles::apps
