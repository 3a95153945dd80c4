// SPDX-License-Identifier: BSD-3-Clause
#include "detect.h"

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

#include "common/lidar_scans.h"
#include "common/message_of.h"
#include "common/obstacles_csv.h"
#include "common/text_file.h"
#include "isolated.h"
#include "lidar_obstacles/detector.h"
#include "scan_rows.h"
#include "store.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double msBetween(Clock::time_point from, Clock::time_point to) {
    return std::chrono::duration<double, std::milli>(to - from).count();
}

/// Runs what writes results, and tells its errors from those of the recording.
template <typename Write>
void writing(const Write& write) {
    try {
        write();
    } catch (const std::exception& e) {
        throw OutputError(e.what());
    }
}

/// A copy or an old file of that name would give results under a wrong key.
void requireUnchanged(const fs::path& path, const Recording& recording) {
    try {
        const Stamp stamp = stampOf(path, recording.named);
        if (stamp == recording.stamp) return;
        if (stamp.bytes == recording.stamp.bytes && contentOf(path, recording.named) == recording.sha256) return;
    } catch (const std::exception& e) {
        throw PassingError(e.what());
    }
    throw PassingError(path.string() + ": changed since the manifest was made: make it anew");
}

/// The run over the scans, and what is known so far.
class Pass {
  public:
    Pass(const Detector& detector, const apps::LidarInput& input, const fs::path& folder)
        : detector_(detector), input_(input), finder_(detector.params), obstacles_(folder / "obstacles.csv") {
        obstacles_.append(apps::csvHeader());
    }

    void run() {
        const bool uses_poses = usesPoses(detector_.params, input_.choice.joins());
        const EgoSource ego = uses_poses ? chooseEgoSource(input_.rawlog, detector_.params.ego.source) : EgoSource{};
        const auto visit = [this](std::size_t index, const SourceItem& scan, double) {
            add(index, scan);
            return true;
        };
        last_ = Clock::now();
        remarks_ = apps::forEachScan(input_, visit, {ego, [this](const StampedPose& pose) { finder_.addPose(pose); }});
    }

    std::size_t scans() const { return scans_.size(); }

    /// Completes the files. @param damage  why the recording ends early; empty: it does not.
    void finish(const fs::path& folder, const std::string& damage) {
        obstacles_.close();
        findStrange(scans_);
        apps::writeTextFile(folder / "scans.csv", scansCsv(scans_));
        apps::writeTextFile(folder / "tracks.csv", tracksCsv(tracks_));
        apps::writeTextFile(folder / "timings.csv", timingsCsv(times_));
        nlohmann::ordered_json json = {{"status", toString(damage.empty() ? Status::Done : Status::Damaged)},
                                       {"reason", damage},
                                       {"again", false},
                                       {"remarks", remarks_},
                                       {"scans", scans_.size()},
                                       {"returns", returns_},
                                       {"tracks", tracks_.size()},
                                       {"obstacles_sha256", sha256OfFile(folder / "obstacles.csv")}};
        apps::writeTextFile(folder / "result.json",
                            json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    }

  private:
    void add(std::size_t index, const SourceItem& scan) {
        const auto start = Clock::now();
        PointCloud cloud = apps::namedCloudOf(input_, index, scan, detector_.params);
        const auto decoded = Clock::now();
        const SequenceResult found = finder_.process(std::move(cloud));
        const auto detected = Clock::now();
        writing([&] { obstacles_.append(apps::csvRows(found.cloud.timestamp, index, found.detection.obstacles)); });
        scans_.push_back(toRow(index, found));
        returns_ += scans_.back().returns;
        addTracks(scans_.back(), found.detection.obstacles, tracks_);
        times_.push_back(toTimes(index, found.detection));
        times_.back().read_ms = msBetween(last_, start);
        times_.back().decode_ms = msBetween(start, decoded);
        times_.back().detect_ms = msBetween(decoded, detected);
        last_ = Clock::now();
    }

    const Detector& detector_;
    const apps::LidarInput& input_;
    ObstacleDetector finder_;
    apps::TextFile obstacles_;
    std::vector<ScanRow> scans_;
    std::vector<ScanTimes> times_;
    std::map<int, TrackRow> tracks_;
    std::size_t returns_ = 0;
    std::string remarks_;
    Clock::time_point last_;
};

}  // namespace

void detectRecording(const Detector& detector, const Recording& recording, const fs::path& folder) {
    const fs::path path = pathOf(detector.settings, recording.name);
    requireUnchanged(path, recording);
    const apps::LidarInput input{path.string(), detector.choice};
    Pass pass(detector, input, folder);
    std::string damage;
    try {
        pass.run();
    } catch (const std::invalid_argument&) {
        throw;  // parameters that do not fit the sensor
    } catch (const OutputError&) {
        throw;
    } catch (const std::exception& e) {
        if (pass.scans() == 0) throw;
        damage = withName(apps::messageOf(e), detector.settings, recording.name);
    }
    writing([&] { pass.finish(folder, damage); });
}

}  // namespace lidar_obstacles::fleet
