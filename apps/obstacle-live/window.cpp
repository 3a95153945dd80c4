// SPDX-License-Identifier: BSD-3-Clause
#include "window.h"

#include <stdexcept>

#ifdef LIDAR_OBSTACLES_HAS_GUI
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <future>
#include <limits>
#include <mutex>
#include <thread>
#include <utility>

#include "common/message_of.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "overlay.h"
#include "param_list.h"
#include "shown_scan.h"
#include "viewer.h"
#endif

namespace lidar_obstacles::apps {

#ifdef LIDAR_OBSTACLES_HAS_GUI

struct Window::Impl : ParamsInUse {
    Impl(const DetectorParams& p, const Look& look) : in_use(p), edited(p) { controls.setLook(look); }

    const DetectorParams& params() const override { return edited; }
    void setParams(const DetectorParams& params) override;

    void run(std::promise<void>& opened);
    void loop(Viewer& viewer);
    void pressKeys(Viewer& viewer);
    void followCamera(Viewer& viewer);
    void draw(Viewer& viewer);
    void takeAnswer();
    void takePicture(Viewer& viewer);

    TrackTails tails;       ///< of the thread that detects
    std::size_t scans = 0;  ///< likewise
    History history{60.0};  ///< under the lock
    std::mutex mutex;
    std::shared_ptr<ShownScan> next;  ///< to be shown; under the lock
    DetectorParams in_use;            ///< by the detector; under the lock, as are those below
    std::vector<std::string> asked;   ///< changes that nobody has taken yet
    bool waiting = false;             ///< for the answer to some
    std::string refusal;              ///< that has not been shown
    DetectorParams edited;            ///< in the window's thread
    std::shared_ptr<const ShownScan> shown = std::make_shared<ShownScan>();
    std::atomic<bool> open{true};
    std::atomic<bool> stop{false};
    Controls controls{*this, usualLayers() | LayerSet().set(static_cast<std::size_t>(Layer::Zones)),
                      PointColor::Height};
    CameraMode placed_as = CameraMode::Free;
    std::vector<HistoryPoint> points;  ///< of the chosen obstacle
    std::size_t param_shown = std::numeric_limits<std::size_t>::max();
    std::thread thread;
};

void Window::Impl::run(std::promise<void>& opened) {
    std::unique_ptr<Viewer> viewer;
    try {
        viewer = std::make_unique<Viewer>("obstacle-live", 1000, 700);
    } catch (...) {
        open = false;
        return opened.set_exception(std::current_exception());
    }
    opened.set_value();
    loop(*viewer);
    open = false;
}

void Window::Impl::loop(Viewer& viewer) {
    while (viewer.screen().isOpen() && !stop && !controls.view().quit) {
        viewer.screen().poll();
        takeAnswer();
        pressKeys(viewer);
        std::shared_ptr<ShownScan> scan;
        {
            const std::lock_guard lock(mutex);
            scan = std::exchange(next, nullptr);
        }
        if (scan) viewer.setScan(shown = scan);
        followCamera(viewer);
        if (scan || viewer.screen().wantsFrame())
            draw(viewer);
        else
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
}

/// Asks the detector's thread for what differs from the parameters in the window.
void Window::Impl::setParams(const DetectorParams& params) {
    validate(params);
    const std::vector<ParamRow> before = paramRows(edited), after = paramRows(params);
    const std::lock_guard lock(mutex);
    for (std::size_t k = 0; k < after.size(); ++k)
        if (after[k].value != before[k].value)
            asked.push_back(after[k].section + "." + after[k].key + "=" + after[k].value);
    waiting = !asked.empty();
    edited = params;
}

void Window::Impl::takeAnswer() {
    const std::lock_guard lock(mutex);
    if (!waiting) edited = in_use;
    if (!refusal.empty()) controls.say(std::exchange(refusal, ""));
}

void Window::Impl::pressKeys(Viewer& viewer) {
    while (const auto key = viewer.screen().nextKey()) {
        const ViewState before = controls.view();
        controls.press(*key, 0.0);
        const int zoom = controls.view().zoom - before.zoom;
        if (zoom != 0) viewer.screen().zoom(zoom);
        if (controls.view().screenshots != before.screenshots) takePicture(viewer);
    }
}

/// A key puts the camera once; from then on it is where mouse and table leave it.
void Window::Impl::followCamera(Viewer& viewer) {
    if (viewer.tookCamera()) {
        controls.cameraMoved();
        placed_as = CameraMode::Free;
    }
    const CameraMode mode = controls.view().camera;
    if (mode == placed_as) return;
    placed_as = mode;
    if (mode == CameraMode::Follow) viewer.screen().setCamera({8.F, 0.F, 0.F, 180.F, 32.F, 38.F});
    if (mode == CameraMode::Top) viewer.screen().setCamera(kFromAbove);
}

void Window::Impl::draw(Viewer& viewer) {
    const ShownScan* scan = shown.get();
    const ViewState& view = controls.view();
    SceneTexts texts;
    texts.state = scan->cloud.size() > 0 ? "scan " + std::to_string(scan->scan_index) + ", " +
                                               recordingTime(scan->cloud.timestamp) + "\n" + countsText(*scan)
                                         : "no scan yet";
    texts.times = timesText(*scan);
    texts.layers = "h: help\n" + layersText(view.layers, view.color);
    texts.bottom = view.message;
    if (view.help) texts.help = helpText(false);
    viewer.draw({view, texts,
                 [this](const Obstacle& o) -> const auto& {
                     const std::lock_guard lock(mutex);
                     return points = history.of(o.id);
                 },
                 [this] { drawParameters(edited, controls.panel(), param_shown); }});
}

void Window::Impl::takePicture(Viewer& viewer) {
    try {
        const std::string file = freePictureName("screenshot_live");
        viewer.screen().savePicture(file);
        draw(viewer);
        controls.say("screenshot: " + file);
    } catch (const std::exception& e) {
        controls.say(messageOf(e));
    }
}

Window::Window(const DetectorParams& params, const Look& look) {
    const char* display = std::getenv("DISPLAY");
    if (!display || !*display) throw std::runtime_error("--window needs a display: DISPLAY is not set");
    impl_ = std::make_unique<Impl>(params, look);
    std::promise<void> opened;
    impl_->thread = std::thread([&, impl = impl_.get()] { impl->run(opened); });
    try {
        opened.get_future().get();
    } catch (const std::exception& e) {
        impl_->thread.join();
        throw std::runtime_error(std::string("--window: cannot open display ") + display + ": " + e.what());
    }
}

Window::~Window() {
    impl_->stop = true;
    if (impl_->thread.joinable()) impl_->thread.join();
}

bool Window::isOpen() const { return impl_->open; }

void Window::show(const SequenceResult& found, const ObstacleDetector& detector, const DetectorParams& params,
                  const ZoneMonitor* zones) {
    if (!isOpen()) return;
    auto scan = std::make_shared<ShownScan>();
    scan->scan_index = impl_->scans++;
    if (zones) scan->zones = outlinesOf(*zones, found, detector.trajectory());
    impl_->tails.add(found, detector.trajectory());
    scan->tails = impl_->tails.tails();
    scan->take(found, detector, params);
    const std::lock_guard lock(impl_->mutex);
    impl_->in_use = params;
    impl_->history.add(scan->result, scan->cloud.timestamp);
    impl_->next = std::move(scan);
}

std::vector<std::string> Window::takeAssignments() {
    const std::lock_guard lock(impl_->mutex);
    return std::exchange(impl_->asked, {});
}

void Window::answer(const DetectorParams& params, const std::string& refusal) {
    const std::lock_guard lock(impl_->mutex);
    impl_->in_use = params;
    impl_->refusal = refusal;
    impl_->waiting = !impl_->asked.empty();
}

#else

struct Window::Impl {};

Window::Window(const DetectorParams&, const Look&) {
    throw std::runtime_error("--window: this tool was built without windows (Dear ImGui and GLFW)");
}
Window::~Window() = default;
bool Window::isOpen() const { return false; }
void Window::show(const SequenceResult&, const ObstacleDetector&, const DetectorParams&, const ZoneMonitor*) {}
std::vector<std::string> Window::takeAssignments() { return {}; }
void Window::answer(const DetectorParams&, const std::string&) {}

#endif

}  // namespace lidar_obstacles::apps
