#include "run.h"

#include <chrono>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "beside.h"
#include "common/message_of.h"
#include "common/obstacles_json.h"
#include "common/zone_rows.h"
#include "lidar_obstacles/live/live_detector.h"
#include "lidar_obstacles/live/udp_source.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"
#include "line_output.h"
#include "pose_input.h"
#include "window.h"

namespace lidar_obstacles::apps {
namespace {

using Clock = std::chrono::steady_clock;

void say(const std::string& text) { std::fprintf(stderr, "obstacle-live: %s\n", text.c_str()); }

std::unique_ptr<live::PacketSource> openSource(const Options& options) {
    if (!options.capture.empty())
        return std::make_unique<live::PcapSource>(options.capture, options.pace, options.port);
    auto udp = std::make_unique<live::UdpSource>(options.listen);
    say("listening on " + toString(udp->endpoint()) + ", " + std::to_string(udp->bufferSize() / 1024) +
        " kB for packets that wait");
    return udp;
}

class Run {
  public:
    Run(const Options& options, const DetectorParams& params, const std::atomic<bool>& stop)
        : options_(options), detector_(params), zones_(openZones(options.zones, params.region)), stop_(stop) {
        detector_.logRegisterCallback([](std::string_view text, auto, auto, auto) { say(std::string(text)); });
        if (options.window) window_.emplace(params);
        if (options.serve) server_.emplace(*options.serve);
        if (options.poses) poses_.emplace(*options.poses);
        if (poses_) say("poses on " + toString(poses_->endpoint()));
        if (server_) say("serving results on " + toString(server_->endpoint()));
        auto source = openSource(options);
        if (!options.beside.empty()) beside_.emplace(options);
        for (const SensorBeside& beside : options.beside) say("and beside it to " + toString(beside.listen));
        if (!options.record.empty()) recorder_.emplace(options.record);
        scanner_.emplace(std::move(source), scannerOptions());
    }

    RunResult operator()() {
        while (!scanner_->ended()) {
            if (stop_ || isOver() || !result_.error.empty()) stopScanners();
            try {
                const auto scan = scanner_->next(0.1);
                if (scan && result_.error.empty()) process(*scan);  // what comes after an error is recorded only
                if (!scan && result_.error.empty()) missScan();
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
        live::JoinedDecode decoded = detector_.decode(scans);
        for (const std::string& reason : decoded.undecodable)
            if (++result_.statistics.undecodable == 1) say(reason + " (told once, then counted)");
        return std::move(decoded.cloud);
    }

    void process(const live::LiveScan& scan) {
        if (options_.standing_at) stand(mrpt::Clock::toDouble(scan.observation->timestamp));
        auto cloud = decode(scan);
        if (!cloud) return;
        fetchPoses();
        SequenceResult found = detector_.process(std::move(*cloud), live::wallClock() - scan.last_arrival);
        watch(found, live::wallClock() - scan.last_arrival);
        keepChosen(options_.classes, found.detection.obstacles);
        const std::vector<Obstacle>& obstacles = found.detection.obstacles;
        const double latency_ms = 1e3 * (live::wallClock() - scan.last_arrival);
        Statistics& s = result_.statistics;
        s.latency.add(latency_ms);
        for (const StageTime& stage : found.detection.timing)
            if (std::string_view(stage.stage) == "track") s.tracking.add(stage.ms);
        if (found.match) ++(found.match->state == MatchState::Lost ? s.match_lost : s.matched);
        ++s.detected;
        s.obstacles += obstacles.size();
        last_line_ = live::wallClock();
        clock_offset_ = found.cloud.timestamp - last_line_;
        send(jsonLine(found.cloud.timestamp, scan.index, obstacles,
                      {latency_ms, &health_.report(), zones_ ? &*zones_ : nullptr}));
        if (window_) window_->show(found, detector_.detector(), zones_ ? &*zones_ : nullptr);
    }

    void send(const std::string& line) {
        if (server_) server_->send(line);
        if (options_.to_stdout) writeToStdout(line, stop_);
    }

    /// Health and zones; they see all obstacles, also those that are not written.
    void watch(const SequenceResult& found, double latency) {
        const HealthReport& health = health_.update(found);
        const std::string text = toText(health);
        if (health.ok() != last_health_.empty()) {
            say(health.ok() ? "health: well again" : "health: " + text);
            last_health_ = text;
        }
        if (zones_) zones_->update({found, detector_.detector().trajectory(), &health, latency});
        result_.statistics.watched.add(result_.statistics.detected, zones_ ? &*zones_ : nullptr, health);
    }

    /// Scans stay away: zones are unknown, and who reads them is told so, again and again.
    void missScan() {
        constexpr double kPatience = 0.4;  // [s]
        const double now = live::wallClock();
        if (!zones_ || now - last_line_ < kPatience || (!options_.capture.empty() && !clock_offset_)) return;
        last_line_ = now;
        const double time = now + clock_offset_.value_or(0.0);
        zones_->missScan(time);
        send(zonesLine(time, *zones_));
    }

    /// What has come up to now; what comes later serves the next scan.
    void fetchPoses() {
        if (!poses_) return;
        poses_->fetch([this](const StampedPose& pose) { detector_.addPose(pose); });
        Statistics& s = result_.statistics;
        if (s.poses_refused == 0 && poses_->refused() > 0)
            say("no pose: " + poses_->whyRefused() + " (told once, then counted)");
        s.poses = poses_->taken();
        s.poses_refused = poses_->refused();
    }

    /// The vehicle is where it always was, from the beginning of this scan and of those beside it to their ends.
    void stand(double time) {
        StampedPose pose = *options_.standing_at;
        const double apart = beside_ ? SensorsBeside::kApart : 0.0;
        for (const double at : {time - apart, time + apart + kLongestScan}) {
            pose.time = at;
            detector_.addPose(pose);
        }
    }

    /// Reports of the stream, and counts from time to time.
    void tell() {
        for (const std::string& text : scanner_->takeReports()) say(text);
        if (beside_)
            for (const std::string& text : beside_->takeReports()) say(text);
        if (recorder_ && !record_failed_ && !recorder_->error().empty()) {
            record_failed_ = true;
            say(recorder_->error() + "; the recording ends here");
        }
        if (options_.report_every <= 0.0 || elapsed() < next_report_) return;
        next_report_ = elapsed() + options_.report_every;
        say(summaryLine(statistics()));
    }

    const Statistics& statistics() {
        Statistics& s = result_.statistics;
        s.counts = scanner_->counts();
        s.recording = recorder_.has_value();
        if (beside_) s.missing_beside = beside_->missing();
        if (recorder_) s.recorded = recorder_->written();
        if (recorder_) s.record_dropped = recorder_->dropped();
        if (server_) s.clients_cut_off = server_->cutOff();
        s.seconds = elapsed();
        return s;
    }

    void finish() {
        if (result_.error.empty()) result_.error = scanner_->damage();
        try {
            if (recorder_) recorder_->finish();
        } catch (const std::exception& e) {
            result_.error = messageOf(e);
        }
        for (const std::string& text : scanner_->takeReports()) say(text);
        say(summaryLine(statistics()));
    }

    const Options& options_;
    live::LiveDetector detector_;
    HealthMonitor health_;
    std::optional<ZoneMonitor> zones_;
    std::string last_health_;               ///< that was told
    double last_line_ = live::wallClock();  ///< when the last line with zones went out [s]
    std::optional<double> clock_offset_;    ///< from this machine's clock to the stamps of the scans [s]
    const std::atomic<bool>& stop_;
    const Clock::time_point start_ = Clock::now();
    double next_report_ = options_.report_every;
    bool record_failed_ = false;  ///< and told
    RunResult result_;
    std::optional<Window> window_;
    std::optional<LineServer> server_;
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
