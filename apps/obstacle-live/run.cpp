// SPDX-License-Identifier: BSD-3-Clause
#include "run.h"

#include <chrono>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "beside.h"
#include "common/message_of.h"
#include "detection.h"
#include "lidar_obstacles/live/udp_source.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"
#include "line_output.h"
#include "log.h"
#include "pose_input.h"
#include "scan_silence.h"
#include "window.h"

namespace lidar_obstacles::apps {
namespace {

using Clock = std::chrono::steady_clock;

std::unique_ptr<live::PacketSource> openSource(const Options& options, const Log& log) {
    if (!options.capture.empty())
        return std::make_unique<live::PcapSource>(options.capture, options.pace, options.port);
    auto udp = std::make_unique<live::UdpSource>(options.listen);
    log.say("listening on " + toString(udp->endpoint()) + ", " + std::to_string(udp->bufferSize() / 1024) +
            " kB for packets that wait");
    return udp;
}

class Run {
  public:
    Run(const Options& options, const DetectorParams& params, const std::atomic<bool>& stop)
        : options_(options), detection_(options, params, log_), stop_(stop) {
        if (options.window) window_.emplace(params, options.look);
        if (options.serve) server_.emplace(*options.serve);
        if (options.poses) poses_.emplace(*options.poses);
        if (poses_) log_.say("poses on " + toString(poses_->endpoint()));
        if (server_) log_.say("serving results on " + server_->place());
        auto source = openSource(options, log_);
        if (!options.beside.empty()) beside_.emplace(options);
        for (const SensorBeside& beside : options.beside) log_.say("and beside it to " + toString(beside.listen));
        if (!options.record.empty()) recorder_.emplace(options.record);
        scanner_.emplace(std::move(source), scannerOptions());
    }

    RunResult operator()() {
        while (!scanner_->ended()) {
            if (stop_ || isOver() || !result_.error.empty()) stopScanners();
            try {
                const auto scan = scanner_->next(0.1);
                if (!result_.error.empty()) continue;  // what comes after an error is recorded only
                obeyClients();
                obeyWindow();
                if (scan) take(*scan);
                if (!scan || !detecting_) missScan();
            } catch (const std::invalid_argument&) {
                throw;
            } catch (const std::exception& e) {  // the socket, the detector, or nobody reads the results
                result_.error = messageOf(e);
            }
            tell();
        }
        finish();
        return std::move(result_);
    }

  private:
    live::ScannerOptions scannerOptions() {
        live::ScannerOptions o;
        o.stream = options_.stream;
        o.queue = static_cast<std::size_t>(options_.queue);
        o.may_drop = options_.capture.empty() || options_.pace == live::Pace::Real;
        o.recorder = recorder_ ? &*recorder_ : nullptr;
        return o;
    }

    void stopScanners() {
        scanner_->stop();
        if (beside_) beside_->stop();
    }

    bool isOver() const {
        return (options_.duration > 0.0 && elapsed() >= options_.duration) || (window_ && !window_->isOpen());
    }
    double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

    /// The scan's cloud, with what further sensors saw. A scan that cannot be right is left out, which is told once and
    /// counted; nothing if none is left.
    std::optional<PointCloud> decode(const live::LiveScan& scan) {
        std::vector<live::LiveScan> scans{scan};
        if (beside_)
            for (live::LiveScan& other : beside_->at(mrpt::Clock::toDouble(scan.observation->timestamp)))
                scans.push_back(std::move(other));
        live::JoinedDecode decoded = detection_.decode(std::move(scans));
        for (const std::string& reason : decoded.undecodable)
            if (++result_.statistics.undecodable == 1) log_.warn(reason + " (told once, then counted)");
        return std::move(decoded.cloud);
    }

    void take(const live::LiveScan& scan) {
        if (options_.standing_at) stand(mrpt::Clock::toDouble(scan.observation->timestamp));
        fetchPoses();
        if (detecting_)
            process(scan);
        else
            ++result_.statistics.not_searched;
    }

    void process(const live::LiveScan& scan) {
        auto cloud = decode(scan);
        if (!cloud) return;
        SequenceResult found = detection_.process(std::move(*cloud), scan.last_arrival);
        watch();
        const double now = live::steadyClock(), latency_ms = 1e3 * (now - scan.last_arrival);
        silence_.end(now, found.cloud.timestamp);
        send(messageOf({found, scan.index, latency_ms, detection_.zones(), detection_.health(), options_.classes},
                       wanted()));
        keepChosen(options_.classes, found.detection.obstacles);
        count(found, latency_ms);
        if (window_) window_->show(found, detection_.detector(), detection_.params(), detection_.zones());
    }

    void count(const SequenceResult& found, double latency_ms) {
        Statistics& s = result_.statistics;
        s.latency.add(latency_ms);
        for (const StageTime& stage : found.detection.timing)
            if (std::string_view(stage.stage) == "track") s.tracking.add(stage.ms);
        if (found.match) ++(found.match->state == MatchState::Lost ? s.match_lost : s.matched);
        ++s.detected;
        s.obstacles += found.detection.obstacles.size();
    }

    Parts wanted() const {
        return (server_ ? server_->wanted() : Parts()) | (options_.to_stdout ? usualParts() : Parts());
    }

    void send(Message message) {
        if (options_.to_stdout) writeToStdout(message.line(usualParts()), stop_);
        if (server_) server_->publish(std::move(message));
    }

    void obeyClients() {
        if (server_) server_->obey([this](const Request& request) { obey(request); });
    }

    /// What was changed in the window, which says so where it cannot be done.
    void obeyWindow() {
        const std::vector<std::string> asked = window_ ? window_->takeAssignments() : std::vector<std::string>();
        if (asked.empty()) return;
        std::string refusal;
        try {
            detection_.set(asked);
            for (const std::string& assignment : asked) log_.say("the window changed " + assignment);
        } catch (const std::exception& e) {
            refusal = messageOf(e);
        }
        window_->answer(detection_.params(), refusal);
    }

    /// @throws if it cannot be done; nothing is changed then.
    void obey(const Request& request) {
        if (const auto* set = std::get_if<SetParameters>(&request)) {
            detection_.set(set->assignments);
            for (const std::string& assignment : set->assignments) log_.say("a client changed " + assignment);
        } else if (const auto* detection = std::get_if<Detection>(&request)) {
            if (detecting_ != detection->on) log_.say(detection->on ? "a client started it" : "a client stopped it");
            detecting_ = detection->on;
        }
    }

    /// Tells what became of the health; zones and health have seen all obstacles, also those that are not written.
    void watch() {
        const HealthReport& health = detection_.health();
        const std::string text = toText(health);
        if (health.ok() != last_health_.empty()) {
            if (health.ok())
                log_.say("health: well again");
            else
                log_.warn("health: " + text);
            last_health_ = text;
        }
        result_.statistics.watched.add(result_.statistics.detected, detection_.zones(), health);
    }

    /// Scans stay away: zones are unknown, and who reads them is told so, again and again.
    void missScan() {
        ZoneMonitor* const zones = detection_.zones();
        if (zones == nullptr) return;
        const auto without_scans = options_.capture.empty() ? std::optional(live::wallClock()) : std::nullopt;
        const auto time = silence_.tell(live::steadyClock(), without_scans);
        if (!time) return;
        zones->missScan(*time);
        send(messageOf(*time, *zones));
    }

    /// What has come up to now; what comes later serves the next scan.
    void fetchPoses() {
        Statistics& s = result_.statistics;
        const auto take = [this](const StampedPose& pose) { detection_.addPose(pose); };
        if (server_)
            server_->takePoses([&](const StampedPose& pose) {
                take(pose);
                ++s.poses_of_clients;
            });
        if (!poses_) return;
        poses_->fetch(take);
        if (s.poses_refused == 0 && poses_->refused() > 0)
            log_.warn("no pose: " + poses_->whyRefused() + " (told once, then counted)");
        s.poses = poses_->taken();
        s.poses_refused = poses_->refused();
    }

    /// The vehicle is where it always was, from the beginning of this scan and of those beside it to their ends.
    void stand(double time) {
        StampedPose pose = *options_.standing_at;
        const double apart = beside_ ? SensorsBeside::kApart : 0.0;
        for (const double at : {time - apart, time + apart + kLongestScan}) {
            pose.time = at;
            detection_.addPose(pose);
        }
    }

    /// Reports of the stream, and counts from time to time.
    void tell() {
        for (const std::string& text : scanner_->takeReports()) log_.warn(text);
        if (beside_)
            for (const std::string& text : beside_->takeReports()) log_.warn(text);
        if (server_)
            for (const std::string& text : server_->takeReports()) log_.warn(text);
        if (recorder_ && !record_failed_ && !recorder_->error().empty()) {
            record_failed_ = true;
            log_.warn(recorder_->error() + "; the recording ends here");
        }
        if (options_.report_every <= 0.0 || elapsed() < next_report_) return;
        next_report_ = elapsed() + options_.report_every;
        log_.say(summaryLine(statistics()));
    }

    const Statistics& statistics() {
        Statistics& s = result_.statistics;
        s.counts = scanner_->counts();
        s.recording = recorder_.has_value();
        if (beside_) s.missing_beside = beside_->missing();
        if (recorder_) s.recorded = recorder_->written();
        if (recorder_) s.record_dropped = recorder_->dropped();
        if (server_) s.clients = server_->counts();
        s.seconds = elapsed();
        return s;
    }

    void finish() {
        if (result_.error.empty()) result_.error = scanner_->damage();
        if (server_) server_->finish();
        try {
            if (recorder_) recorder_->finish();
        } catch (const std::exception& e) {
            result_.error = messageOf(e);
        }
        for (const std::string& text : scanner_->takeReports()) log_.warn(text);
        log_.say(summaryLine(statistics()));
    }

    const Options& options_;
    const Log log_;
    LiveDetection detection_;
    bool detecting_ = true;    ///< until a client stops it
    std::string last_health_;  ///< that was told
    ScanSilence silence_{live::steadyClock()};
    const std::atomic<bool>& stop_;
    const Clock::time_point start_ = Clock::now();
    double next_report_ = options_.report_every;
    bool record_failed_ = false;  ///< and told
    RunResult result_;
    std::optional<Window> window_;
    std::optional<ClientServer> server_;
    std::optional<PoseInput> poses_;
    std::optional<live::Recorder> recorder_;
    std::optional<SensorsBeside> beside_;
    std::optional<live::LiveScanner> scanner_;  // after the recorder that its thread uses
};

}  // namespace

RunResult run(const Options& options, const DetectorParams& params, const std::atomic<bool>& stop) {
    return Run(options, params, stop)();
}

}  // namespace lidar_obstacles::apps
