// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// octomap-build: a map of what stands still, from a rawlog with poses. Parses, wires, reports.
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/address_space.h"
#include "common/interrupt.h"
#include "common/lidar_scans.h"
#include "common/progress_bar.h"
#include "common/read_params.h"
#include "common/rereadable_input.h"
#include "common/run_app.h"
#include "lidar_obstacles/deskew.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"
#include "lidar_obstacles/static_map.h"
#include "options.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;

EgoSource requirePoses(const Options& options, const DetectorParams& params) {
    EgoSource source = chooseEgoSource(options.input, params.ego.source);
    if (source.kind == EgoKind::None) throw UsageError(options.input + ": no poses of the vehicle in it");
    if (source.kind == EgoKind::Matching)
        throw UsageError(
            "[ego] source = matching: its poses begin anew in each run; a map needs poses that others share");
    if (source.kind == EgoKind::Imu)
        throw UsageError(options.input + ": '" + source.label + "' tells rotations only; a map needs positions");
    return source;
}

/// Inserts the selected scans whose motion is known into a map.
class Build {
  public:
    Build(const Options& options, const DetectorParams& params)
        : options_(options),
          input_{options.input, options.choice},
          params_(params),
          trajectory_(params.ego),
          map_(params.octomap.resolution, params.octomap.range) {}

    void addPose(const StampedPose& pose) { trajectory_.add(pose); }

    void run(PoseFeed& feed) {
        ProgressBar progress;
        while (const auto item = feed.next()) {
            if (isInterrupted()) break;
            if (!item->observation || !isLidarScan(*item->observation)) continue;
            if (options_.choice.sensor_label && item->lidar != *options_.choice.sensor_label) continue;
            const long index = seen_++;
            if (index > options_.to) break;
            if (index < options_.from || (index - options_.from) % options_.every != 0) continue;
            if (!item->is_gap) insert(*item, static_cast<std::size_t>(index));
            progress.update(feed.progress(), inserted_);
        }
        if (isInterrupted()) interrupted_at_ = static_cast<std::size_t>(seen_);
        if (inserted_ == 0 && interrupted_at_) return;
        if (inserted_ == 0)
            throw std::runtime_error(options_.input + ": no scan with a pose among those asked for" +
                                     (bad_ > 0 ? "; " + badScans() : ""));
        map_.save(options_.output);
    }

    void print(const EgoSource& ego) const {
        std::printf("%zu scans by the poses of '%s' (%zu without a pose left out), %zu nodes of %g m: see %s\n",
                    inserted_, ego.label.c_str(), lost_, map_.size(), params_.octomap.resolution,
                    options_.output.c_str());
    }

    /// Scans that cannot be right, in one line; empty if there are none.
    std::string badScans() const {
        if (bad_ == 0) return "";
        return std::to_string(bad_) + " scans that cannot be right left out, the first: " + first_bad_;
    }

    std::size_t inserted() const { return inserted_; }
    /// Number of the first scan that was left out because of a signal.
    const std::optional<std::size_t>& interruptedAt() const { return interrupted_at_; }

  private:
    /// Nothing of a scan that cannot be right, which is counted.
    std::optional<PointCloud> cloudOf(const SourceItem& item, std::size_t index) {
        try {
            return namedCloudOf(input_, index, item, params_);
        } catch (const std::runtime_error& e) {  // not parameters that do not fit the sensor
            if (bad_++ == 0) first_bad_ = e.what();
            return std::nullopt;
        }
    }

    void insert(const SourceItem& item, std::size_t index) {
        std::optional<PointCloud> cloud = cloudOf(item, index);
        if (!cloud) return;
        const Deskewed scan = deskew(std::move(*cloud), trajectory_);
        const PoseAt pose = trajectory_.at(scan.cloud.timestamp);
        trajectory_.forgetBefore(scan.cloud.timestamp - 2.0);
        if (!pose.T_world_vehicle || scan.how == Deskewing::NoMotion) {
            ++lost_;
            return;
        }
        map_.insert(scan.cloud, *pose.T_world_vehicle);
        ++inserted_;
    }

    const Options& options_;
    const LidarInput input_;
    const DetectorParams& params_;
    Trajectory trajectory_;
    StaticMapBuilder map_;
    long seen_ = 0;  ///< scans of the lidar
    std::size_t inserted_ = 0;
    std::size_t lost_ = 0;   ///< without a pose
    std::size_t bad_ = 0;    ///< that cannot be right
    std::string first_bad_;  ///< which, and why
    std::optional<std::size_t> interrupted_at_;
};

int run(const Options& options) {
    const DetectorParams params = readParams(options.config, options.set);
    const EgoSource ego = requirePoses(options, params);
    const auto source = openInput(options.input, options.choice);
    Build build(options, params);
    PoseFeed feed(*source, ego, [&](const StampedPose& pose) { build.addPose(pose); });
    build.run(feed);
    if (!feed.remarks().empty()) std::fprintf(stderr, "octomap-build: %s\n", feed.remarks().c_str());
    if (build.inserted() > 0) build.print(ego);
    const std::string bad = build.badScans();
    if (feed.status() == SourceStatus::Damaged)
        throw std::runtime_error((bad.empty() ? "" : bad + "; ") + feed.message());
    if (!bad.empty() && !build.interruptedAt()) throw std::runtime_error(bad);
    if (!bad.empty()) std::fprintf(stderr, "octomap-build: %s\n", bad.c_str());
    return exitCode("octomap-build", build.interruptedAt());
}

}  // namespace

int main(int argc, char** argv) {
    return runApp("octomap-build", [&] {
        capAddressSpace();
        auto options = parseOptions(argc, argv);
        if (!options) return 0;
        const RereadableInput input(options->input);
        options->input = input.path();
        catchInterrupts();
        return run(*options);
    });
}
