// SPDX-License-Identifier: BSD-3-Clause
#include "window.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <thread>
#include <utility>

#include "camera_images.h"
#include "common/message_of.h"
#include "controls.h"
#include "display_check.h"
#include "lidar_obstacles/mrpt_bridge/zones_file.h"
#include "outline_mouse.h"
#include "overlay.h"
#include "panels.h"
#include "param_list.h"
#include "player.h"
#include "state_log.h"
#include "survey.h"
#include "viewer.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

constexpr double kNever = std::numeric_limits<double>::infinity();

ZoneSet zonesOf(const std::string& file) {
    if (file.empty()) return {};
    try {
        return loadZones(file);
    } catch (const ZonesFileError& e) {
        throw UsageError(e.what());
    }
}

/// The parts of a running window.
class ReplayWindow {
  public:
    ReplayWindow(const Options& options, const DetectorParams& params)
        : options_(options),
          store_(options.input, {options.choice.sensor_label, static_cast<std::size_t>(options.from),
                                 static_cast<std::size_t>(options.to), static_cast<std::size_t>(options.every),
                                 options.choice.poseOf(options.choice.sensor_label.value_or("")),
                                 options.choice.options, options.choice.points_in_vehicle}),
          player_(store_, {params, {}, zonesOf(options.zones)},
                  options.show.truth.empty() ? TruthByScan{} : readTruthByScan(options.show.truth)),
          controls_(player_, layersOf(options), options.show.color),
          log_(options.show.log) {
        if (!options.zones.empty()) controls_.setZonesFile(options.zones);
        controls_.setLook(options.show.look);
    }

    void run() {
        if (!store_.waitFor(0)) return failIfNothingToShow();
        viewer_.emplace("obstacle-replay " + fs::path(options_.input).filename().string(), options_.show.width,
                        options_.show.height);
        viewer_->screen().setGrab([this](const Eigen::Vector2f& at) { return outlines_.wants(*viewer_, at); });
        while (viewer_->screen().isOpen()) {
            viewer_->screen().poll();
            const bool keys = pressKeys() || outlines_.move(*viewer_);
            watchCamera();
            const bool other_scan = player_.tick(now());
            if (controls_.view().quit) break;
            if (other_scan) showScan();
            const bool drawn = other_scan || keys || now() >= redraw_at_ || viewer_->screen().wantsFrame();
            if (drawn) draw(other_scan);
            takePictures();
            log_.write({player_, controls_.view(), *viewer_, survey_, bar_, parameters_, images_.shown().get(),
                        outlines_.editor()});
            failIfNothingToShow();
            if (!drawn && !lookAhead()) std::this_thread::sleep_for(5ms);
        }
        viewer_.reset();
    }

  private:
    static double now() {
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    }

    /// Zones that were given are to be seen.
    static LayerSet layersOf(const Options& options) {
        LayerSet layers = options.show.layers;
        if (!options.zones.empty()) layers.set(static_cast<std::size_t>(Layer::Zones));
        return layers;
    }

    bool pressKeys() {
        bool any = false;
        while (const auto key = viewer_->screen().nextKey()) {
            const ViewState before = controls_.view();
            controls_.press(*key, now());
            const ViewState& view = controls_.view();
            if (view.zoom != before.zoom) viewer_->screen().zoom(view.zoom - before.zoom);
            if (view.marks != before.marks) jumpToMark(view.marks - before.marks);
            if (view.deletions != before.deletions) outlines_.deleteCorner();
            if (view.images != before.images) controls_.say(images_.next(store_));
            any = true;
        }
        return any;
    }

    void jumpToMark(int direction) {
        const auto place = nextMark(survey_.history().marks(), player_.aim(), direction);
        if (!place) return controls_.say(direction > 0 ? "no mark after this scan" : "no mark before this scan");
        player_.goTo(*place);
        for (const Mark& m : survey_.history().marks())
            if (m.scan == *place) controls_.say(std::string(toString(m.kind)) + ": " + m.text);
    }

    /// One scan more of the survey, where there is time before the next one is due. True if there was something to do.
    bool lookAhead() {
        if (player_.playing() && player_.speed() > 2.0) return false;
        if (!survey_.step(player_)) return false;
        if (now() < survey_drawn_ + 0.25 && !survey_.complete(player_)) return true;
        survey_drawn_ = now();
        redraw_at_ = 0.0;
        return true;
    }

    /// A camera that is not where it was put was moved with the mouse, or by the table.
    void watchCamera() {
        const CameraPlace& at = viewer_->screen().camera();
        const bool put = is_placed_ && placed_as_ != CameraMode::Free && placed_as_ == controls_.view().camera;
        const bool moved = put && (std::abs(at.azimuth_deg - placed_.azimuth_deg) > 0.01F ||
                                   std::abs(at.elevation_deg - placed_.elevation_deg) > 0.01F ||
                                   std::abs(at.x - placed_.x) + std::abs(at.y - placed_.y) > 0.01F);
        if (moved || viewer_->tookCamera()) controls_.cameraMoved();
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
        if (mode == CameraMode::Top) place = kFromAbove;
        if (player_.shown()) place.z = static_cast<float>(player_.shown()->result.ground.heightAt(place.x, place.y));
        if (!switched) place.distance = viewer_->screen().camera().distance;
        placed_ = place;
        is_placed_ = true;
        viewer_->screen().setCamera(place);
    }

    /// Numbers of tracks begin anew after a jump: the chosen one is found again by its place, as far as surveyed.
    void showScan() {
        const Obstacle* before = viewer_->chosenObstacle();
        const auto known = before ? survey_.history().at(shown_at_, before->box.center.head<2>()) : chosen_known_;
        if (known) chosen_known_ = known;
        if (!viewer_->chosen()) chosen_known_.reset();
        viewer_->setScan(player_.shown());
        shown_at_ = player_.position();
        if (!chosen_known_) return;
        for (const Obstacle& o : player_.shown()->result.obstacles)
            if (survey_.history().at(shown_at_, o.box.center.head<2>()) == chosen_known_) viewer_->choose(o.id);
    }

    void draw(bool other_scan) {
        placeCamera(other_scan);
        const OverlayTexts texts = overlayTexts(player_, controls_, fs::path(options_.input).filename().string());
        redraw_at_ = store_.complete() ? kNever : now() + 0.2;  // how far the file is read
        parameters_ = {};
        viewer_->draw(
            {controls_.view(),
             {texts.state, texts.times, texts.layers, texts.bottom, controls_.view().help ? texts.middle : ""},
             [this](const Obstacle& o) -> const auto& { return survey_.of(o, player_); },
             [this] { parameters_ = drawParameters(player_.setup().params, controls_.panel(), param_shown_); },
             [this](const ScreenRect& at) { drawTimeline(player_, survey_, at, bar_); },
             player_.shown() ? images_.beside(store_, player_.position()) : nullptr,
             controls_.view().outlines ? &outlines_.editor() : nullptr});
        placed_.distance = viewer_->screen().camera().distance;
    }

    void takePictures() {
        if (pictures_ == controls_.view().screenshots) return;
        pictures_ = controls_.view().screenshots;
        try {
            const std::string file = freeName();
            viewer_->screen().savePicture(file);
            draw(false);
            controls_.say("screenshot: " + file);
        } catch (const std::exception& e) {
            controls_.say(messageOf(e));
        }
        redraw_at_ = 0.0;
    }

    std::string freeName() const {
        char stem[40];
        std::snprintf(stem, sizeof stem, "screenshot_%06zu", player_.shown()->scan_index);
        return freePictureName(stem);
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
    Survey survey_{options_.show.truth_fov_deg};
    CameraImages images_;
    OutlineMouse outlines_{player_, controls_};
    StateLog log_;
    std::optional<Viewer> viewer_;
    std::size_t shown_at_ = 0;         ///< place of the scan that is shown
    std::optional<int> chosen_known_;  ///< number of the chosen obstacle in the survey
    ScreenRect bar_;                   ///< of the timeline
    DrawnParameters parameters_;
    std::size_t param_shown_ = std::numeric_limits<std::size_t>::max();
    CameraPlace placed_;
    CameraMode placed_as_ = CameraMode::Free;
    bool is_placed_ = false;
    double redraw_at_ = 0.0;
    double survey_drawn_ = 0.0;
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
