// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacle-track: a tracker for any detector's boxes. Parses, wires, reports.
#include <algorithm>
#include <cstdio>
#include <string>

#include "common/obstacles_csv.h"
#include "common/read_params.h"
#include "common/text_file.h"
#include "input.h"
#include "lidar_obstacles/tracking.h"
#include "options.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;

/// Poses from a file, or one that never changes.
class Ego {
  public:
    Ego(const std::vector<StampedPose>& poses, const EgoParams& params) : trajectory_(params) {
        for (const StampedPose& pose : poses) trajectory_.add(pose);
    }

    std::optional<Eigen::Isometry3d> at(double time) const {
        if (trajectory_.empty()) return Eigen::Isometry3d::Identity();
        return trajectory_.at(time).T_world_vehicle;
    }
    bool brokenBetween(double from, double to) const {
        return !trajectory_.empty() && trajectory_.brokenBetween(from, to);
    }

  private:
    Trajectory trajectory_;
};

class Run {
  public:
    Run(const DetectorParams& params, Ego ego)
        : params_(params.tracking), tracker_(params.tracking), ego_(std::move(ego)) {}

    /// The rows of one scan.
    std::string add(ScanRows& scan) {
        if (last_time_ && ego_.brokenBetween(*last_time_, scan.timestamp)) {
            tracker_.forget();
            ++breaks_;
        }
        last_time_ = scan.timestamp;
        TrackingScan input;
        input.time = scan.timestamp;
        const auto pose = ego_.at(scan.timestamp);
        input.poses_known = pose.has_value();
        if (pose) input.T_world_vehicle = *pose;
        for (std::size_t k = 0; k < scan.boxes.size(); ++k) {
            const double time = scan.timestamp + scan.time_offsets[k];
            input.boxes.push_back(seenBox(scan.boxes[k], time, ego_.at(time).value_or(input.T_world_vehicle)));
        }
        if (params_.stamp != TrackStamp::Seen) {
            input.told_for = scan.timestamp;
            input.T_world_told = input.T_world_vehicle;
        }
        unseen_ += scan.unseen;
        const auto& rows = tracker_.update(input);
        for (const TrackedBox& row : rows) tracks_ = std::max(tracks_, row.id + 1);
        rows_ += rows.size();
        return csvRows(scan.timestamp, static_cast<std::size_t>(scan.scan_index), trackedObstacles(rows, scan.boxes));
    }

    void print(std::size_t scans, const std::string& output) const {
        std::printf("%zu scans, %zu rows, %d tracks: see %s\n", scans, rows_, tracks_, output.c_str());
        if (unseen_ > 0)
            std::printf("%zu rows left out: what another tracker told of things it did not see\n", unseen_);
        if (breaks_ > 0) std::printf("the poses broke off %zu times: all tracks began anew\n", breaks_);
    }

  private:
    TrackingParams params_;
    Tracker tracker_;
    Ego ego_;
    std::optional<double> last_time_;
    std::size_t rows_ = 0;
    std::size_t breaks_ = 0;
    std::size_t unseen_ = 0;
    int tracks_ = 0;
};

int run(const Options& options) {
    const DetectorParams params = readParams(options.config, options.set);
    EgoRows ego;
    if (!options.ego.empty()) {
        ego = readEgo(options.ego);
        if (ego.scans.empty()) throw std::runtime_error(options.ego + ": no poses in it");
    }
    std::vector<ScanRows> scans = readDetections(options.detections, std::move(ego.scans));
    TextFile file(options.output);
    file.append(csvHeader());
    Run tracking(params, Ego(ego.poses, params.ego));
    for (ScanRows& scan : scans) file.append(tracking.add(scan));
    file.close();
    tracking.print(scans.size(), options.output);
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("obstacle-track", [&] {
        const auto options = parseOptions(argc, argv);
        return options ? run(*options) : 0;
    });
}
