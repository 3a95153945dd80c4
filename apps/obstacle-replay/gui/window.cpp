#include "window.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <thread>
#include <utility>

#include "common/message_of.h"
#include "controls.h"
#include "display_check.h"
#include "display_window.h"
#include "overlay.h"
#include "player.h"
#include "state_log.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// The parts of a running window.
class ReplayWindow {
  public:
    ReplayWindow(const Options& options, const DetectorParams& params)
        : options_(options),
          store_(options.input, {options.choice.sensor_label, static_cast<std::size_t>(options.from),
                                 static_cast<std::size_t>(options.to), static_cast<std::size_t>(options.every),
                                 options.choice.poseOf(options.choice.sensor_label.value_or("")),
                                 options.choice.options, options.choice.points_in_vehicle}),
          player_(store_, {params, {}},
                  options.show.truth.empty() ? TruthByScan{} : readTruthByScan(options.show.truth)),
          controls_(player_, options.show.layers, options.show.color),
          overlay_(layers_.scene()),
          log_(options.show.log) {}

    void run() {
        if (!store_.waitFor(0)) return failIfNothingToShow();
        window_.emplace("obstacle-replay " + fs::path(options_.input).filename().string(), options_.show.width,
                        options_.show.height, layers_.scene());
        while (window_->isOpen()) {
            changed_ = pressKeys() || changed_;
            changed_ = watchCamera() || changed_;
            other_scan_ = other_scan_ || player_.tick(now());  // while the last one is being drawn
            if (controls_.view().quit) break;
            if ((other_scan_ || changed_ || now() >= redraw_at_) && isDrawn()) draw();
            takePictures();
            if (!other_scan_) log_.write(player_, controls_.view(), layers_, *window_);
            failIfNothingToShow();
            std::this_thread::sleep_for(other_scan_ ? 1ms : 5ms);
        }
        window_.reset();
    }

  private:
    static double now() {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }

    bool pressKeys() {
        bool any = false;
        while (const auto key = window_->nextKey()) {
            const ViewState before = controls_.view();
            controls_.press(*key, now());
            const ViewState& view = controls_.view();
            if (view.zoom != before.zoom) zoom(view.zoom - before.zoom);
            any = true;
        }
        return any;
    }

    void zoom(int steps) {
        CameraPlace place = window_->camera();
        place.distance *= std::pow(1.2F, static_cast<float>(steps));
        placed_.distance = place.distance;
        window_->setCamera(place);
    }

    /// A camera that is not where it was put was moved with the mouse. One that a key has just chosen is put there
    /// with the next picture: until then it may stand anywhere. True if the picture is to be drawn anew.
    bool watchCamera() {
        const CameraPlace at = window_->camera();
        const bool put = is_placed_ && placed_as_ != CameraMode::Free && placed_as_ == controls_.view().camera;
        const bool moved = put && (std::abs(at.azimuth_deg - placed_.azimuth_deg) > 0.01F ||
                                   std::abs(at.elevation_deg - placed_.elevation_deg) > 0.01F ||
                                   std::abs(at.x - placed_.x) + std::abs(at.y - placed_.y) > 0.01F);
        if (moved) controls_.cameraMoved();
        return moved || at.distance != drawn_distance_;
    }

    void placeCamera(bool other_scan) {
        const CameraMode mode = controls_.view().camera;
        const bool switched = !is_placed_ || mode != placed_as_;
        placed_as_ = mode;
        if (mode == CameraMode::Free || !(switched || other_scan)) return;
        const CameraView& v = options_.view;
        CameraPlace place{
            static_cast<float>(v.target.x()),  static_cast<float>(v.target.y()),    0.F,
            static_cast<float>(v.azimuth_deg), static_cast<float>(v.elevation_deg), static_cast<float>(v.distance)};
        if (mode == CameraMode::Top) place = {5.F, 0.F, 0.F, 180.F, 90.F, 60.F};
        if (player_.shown()) place.z = static_cast<float>(player_.shown()->result.ground.heightAt(place.x, place.y));
        if (!switched) place.distance = window_->camera().distance;
        placed_ = place;
        is_placed_ = true;
        window_->setCamera(place);
    }

    /// True when what was changed last has been drawn, or the window does not draw at the moment: scans that nobody
    /// sees would only take the time from those that are drawn.
    bool isDrawn() const { return window_->frames() != frames_before_ || now() > changed_at_ + 0.3; }

    void draw() {
        const bool other_scan = std::exchange(other_scan_, false);
        changed_ = false;
        placeCamera(other_scan);
        const ViewState& view = controls_.view();
        const OverlayTexts texts = overlayTexts(player_, controls_, fs::path(options_.input).filename().string());
        redraw_at_ = store_.complete() ? kNever : now() + 0.2;  // how far the file is read
        drawn_distance_ = window_->camera().distance;
        window_->change([&] {
            frames_before_ = window_->frames();
            setClipDistances(*layers_.scene(), drawn_distance_);
            if (other_scan) layers_.setScan(player_.shown());
            layers_.setPointColor(view.color);
            layers_.setVisible(view.layers);
            overlay_.write(texts);
        });
        changed_at_ = now();
    }

    void takePictures() {
        if (pictures_ == controls_.view().screenshots) return;
        pictures_ = controls_.view().screenshots;
        try {
            const std::string file = freeName();
            window_->savePicture(file);
            controls_.say("screenshot: " + file);
        } catch (const std::exception& e) {
            controls_.say(messageOf(e));
        }
        redraw_at_ = 0.0;
    }

    std::string freeName() const {
        for (int k = 0;; ++k) {
            char name[64];
            std::snprintf(name, sizeof name, "screenshot_%06zu_%d.png", player_.shown()->scan_index, k);
            if (!fs::exists(name)) return name;
        }
    }

    void failIfNothingToShow() const {
        if (!store_.complete() || store_.problem().empty()) return;
        if (store_.problemOfUsage()) throw UsageError(store_.problem());
        if (store_.size() == 0) throw std::runtime_error(store_.problem());
    }

    const Options& options_;
    ScanStore store_;
    Player player_;
    Controls controls_;
    SceneLayers layers_;
    Overlay overlay_;
    StateLog log_;
    std::optional<DisplayWindow> window_;
    CameraPlace placed_;
    CameraMode placed_as_ = CameraMode::Free;
    bool is_placed_ = false;
    float drawn_distance_ = 0;
    double redraw_at_ = 0.0;
    bool changed_ = false;                                                     ///< something but the scan; to be drawn
    bool other_scan_ = false;                                                  ///< is to be drawn
    std::uint64_t frames_before_ = std::numeric_limits<std::uint64_t>::max();  ///< drawn before the last change
    double changed_at_ = 0.0;
    int pictures_ = 0;
};

}  // namespace

void showWindow(const Options& options, const DetectorParams& params) {
    if (!displayAnswers()) {
        const char* name = std::getenv("DISPLAY");
        const std::string why = name && *name ? std::string(name) + " does not answer" : "DISPLAY is not set";
        throw UsageError("--gui: no display (" + why + "); --record DIR or --record FILE.mp4 needs none");
    }
    ReplayWindow(options, params).run();
}

}  // namespace lidar_obstacles::apps
