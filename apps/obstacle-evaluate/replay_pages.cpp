// SPDX-License-Identifier: BSD-3-Clause
#include "replay_pages.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "common/interrupt.h"
#include "common/lidar_scans.h"
#include "detector.h"
#include "exports/replay_page.h"
#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/joined_lidars.h"
#include "pictures.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

constexpr int kBefore = 20, kAfter = 10;  ///< scans of a page beside the one it is about
constexpr int kWarmUp = 10;               ///< scans that the detector sees before
constexpr PageLimits kLimits{3'000'000, 100, 40'000};

/// A page that is being written.
struct OpenPage {
    std::size_t place;  ///< of its scan among the worst
    int first, last;    ///< scans
    std::unique_ptr<ReplayPage> page;
    bool done = false;
};

/// The pages of one set, filled while its scans come by.
class SetPages {
  public:
    SetPages(const LidarInput& input, const DetectorParams& params, const evaluation::SetResult& result, bool is_ours)
        : input_(input), params_(params), result_(result), is_ours_(is_ours), detector_(params) {}

    void add(std::size_t place, int scan_index, const fs::path& file) {
        pages_.push_back(
            {place, scan_index - kBefore, scan_index + kAfter, std::make_unique<ReplayPage>(file, kLimits)});
        last_ = std::max(last_, pages_.back().last);
    }
    bool empty() const { return pages_.empty(); }
    void addPose(const StampedPose& pose) { detector_.addPose(pose); }

    /// @return false if no later scan is wanted.
    bool take(int index, const SourceItem& item) {
        if (isInterrupted()) return false;
        const bool wanted = std::any_of(pages_.begin(), pages_.end(), [&](const OpenPage& p) {
            return index >= p.first - kWarmUp && index <= p.last;
        });
        if (wanted) show(index, item);
        for (OpenPage& p : pages_)
            if (index >= p.last) finish(p);
        return index < last_;
    }
    /// Completes the pages that end with the recording. @return their places.
    std::vector<std::size_t> finishAll() {
        std::vector<std::size_t> places;
        for (OpenPage& p : pages_) {
            if (!isInterrupted()) finish(p);
            if (p.done) places.push_back(p.place);
        }
        return places;
    }

  private:
    void show(int index, const SourceItem& item) {
        if (last_seen_ && *last_seen_ + 1 != index) detector_.restart();
        last_seen_ = index;
        PointCloud cloud = namedCloudOf(input_, static_cast<std::size_t>(index), item, params_);
        const SequenceResult found = is_ours_ ? detector_.process(std::move(cloud)) : given(index, std::move(cloud));
        const auto pose = detector_.trajectory().at(found.cloud.timestamp).T_world_vehicle;
        for (OpenPage& p : pages_)
            if (index >= p.first && index <= p.last) p.page->add({static_cast<std::size_t>(index), found, pose});
    }

    SequenceResult given(int index, PointCloud cloud) const {
        SequenceResult found;
        found.detection.obstacles = judgedObstacles(result_, index, cloud);
        found.cloud = std::move(cloud);
        return found;
    }

    void finish(OpenPage& p) {
        if (std::exchange(p.done, true)) return;
        p.page->finish({"obstacle-evaluate " LIDAR_OBSTACLES_VERSION, result_.name,
                        "Scans around scan " + std::to_string(p.last - kAfter) +
                            (is_ours_ ? "; tracks are numbered anew." : "; with the detections that were given.")});
    }

    const LidarInput& input_;
    const DetectorParams& params_;
    const evaluation::SetResult& result_;
    bool is_ours_;
    ObstacleDetector detector_;
    std::vector<OpenPage> pages_;
    int last_ = -1;
    std::optional<int> last_seen_;
};

}  // namespace

std::string replayPageName(std::size_t place) {
    const std::string number = std::to_string(place + 1);
    return "replays/worst_" + std::string(number.size() < 2 ? 1 : 0, '0') + number + ".html";
}

std::vector<std::string> writeReplayPages(const std::vector<evaluation::WorstScan>& scans,
                                          const std::vector<evaluation::SetResult>& results,
                                          const EvaluateOptions& options, const ReplayPagesOf& of) {
    std::vector<std::string> links(scans.size());
    for (std::size_t s = 0; s < options.sets.size(); ++s) {
        const SetFiles& files = options.sets[s];
        if (files.rawlog.empty()) continue;
        const LidarInput input{files.rawlog, options.choice};
        SetPages pages(input, of.params, results[s], files.detections.empty());
        for (std::size_t k = 0; k < scans.size(); ++k) {
            if (scans[k].set != s) continue;
            const fs::path file = of.folder / replayPageName(k);
            fs::create_directories(file.parent_path());
            pages.add(k, scans[k].scan_index, file);
        }
        if (pages.empty()) continue;
        const EgoSource ego = usesPoses(of.params, options.choice.joins())
                                  ? chooseEgoSource(files.rawlog, of.params.ego.source)
                                  : EgoSource{};
        forEachScan(input,
                    [&](std::size_t index, const SourceItem& item, double) {
                        return pages.take(static_cast<int>(index), item);
                    },
                    {ego, [&](const StampedPose& pose) { pages.addPose(pose); }});
        for (const std::size_t k : pages.finishAll())
            links[k] = replayPageName(k) + "#scan=" + std::to_string(scans[k].scan_index);
    }
    return links;
}

}  // namespace lidar_obstacles::apps
