// SPDX-License-Identifier: BSD-3-Clause
#include "replay.h"

#include <algorithm>
#include <chrono>

#include "common/interrupt.h"
#include "common/message_of.h"
#include "common/progress_bar.h"
#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/joined_lidars.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"
#include "lidar_obstacles/own_body_learner.h"
#include "reading_report.h"

namespace lidar_obstacles::apps {
namespace {

using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::string listLidars(const Options& options) { return apps::listLidars(options.input, options.choice.options); }

/// The scans of one lidar, in order.
class LidarScans {
  public:
    LidarScans(ScanSource& source, const Options& options) : source_(source), options_(options) {}

    /// The next scan; nullopt at the end or at damage. One whose points are missing has its number, but is not given.
    /// @throws UsageError at the first scan of a second lidar.
    std::optional<SourceItem> next() {
        while (auto item = source_.next()) {
            if (!item->observation || !isLidarScan(*item->observation)) continue;
            const auto& wanted = options_.choice.sensor_label;
            if (wanted && item->lidar != *wanted) continue;
            if (!label_) label_ = item->lidar;
            if (item->lidar != *label_) {
                throw UsageError(options_.input +
                                 ": several lidars, choose one with --sensor-label: " + listLidars(options_));
            }
            ++count_;
            if (item->is_gap) continue;
            ++given_;
            return item;
        }
        return std::nullopt;
    }

    std::size_t count() const { return count_; }
    /// True if there were scans, but the points of none.
    bool hasGapsOnly() const { return count_ > 0 && given_ == 0; }
    std::string label() const { return label_.value_or(""); }

  private:
    ScanSource& source_;
    const Options& options_;
    std::optional<std::string> label_;
    std::size_t count_ = 0;
    std::size_t given_ = 0;
};

/// Where poses come from; none where nothing would use them.
EgoSource egoSourceFor(const Options& options, const DetectorParams& params) {
    const bool are_used = usesPoses(params, options.choice.joins());
    return are_used ? chooseEgoSource(options.input, params.ego.source) : EgoSource{};
}

class Replay {
  public:
    Replay(ScanSource& source, const Options& options, const DetectorParams& params, Outputs& outputs)
        : detector_(params),
          zones_(openZones(options.zones, params.region)),
          source_(source, egoSourceFor(options, params), [this](const auto& pose) { detector_.addPose(pose); }),
          options_(options),
          params_(params),
          outputs_(outputs) {}

    Summary run() {
        LidarScans scans(source_, options_);
        ProgressBar progress;
        const auto end = static_cast<std::size_t>(options_.to) + 1;
        while (scans.count() < end) {
            if (isInterrupted()) {
                summary_.interrupted_at = scans.count();
                break;
            }
            const auto scan = scans.next();
            if (!scan) break;
            const std::size_t index = scans.count() - 1;
            if (isSelected(index) && !process(*scan, index)) break;
            const double share = static_cast<double>(scans.count()) / static_cast<double>(end);
            progress.update(std::max(source_.progress(), share), summary_.scans);
        }
        summary_.scans_in_input = scans.count();
        summary_.sensor_label = scans.label();
        if (source_.status() == SourceStatus::Damaged) summary_.damage = source_.message();
        summary_.remarks = source_.remarks();
        addRemark(summary_.remarks, reading_.text());
        addRemark(summary_.remarks, summary_.watched.healthText());
        summary_.moved = in_place_.moved();
        summary_.in_place = in_place_.learnt();
        remarkOnGround();
        if (!options_.learn_own_body) remarkOnOwnBody();
        summary_.motion.source = source_.ego();
        if (isRead(source_.ego().kind)) summary_.motion.poses = source_.poses();
        addRemark(summary_.remarks, summary_.motion.missing(params_));
        summary_.motion.refused_poses = source_.refused();
        requireScans(scans);
        return std::move(summary_);
    }

  private:
    bool isSelected(std::size_t index) const {
        const auto from = static_cast<std::size_t>(options_.from);
        return index >= from && index <= static_cast<std::size_t>(options_.to) &&
               (index - from) % static_cast<std::size_t>(options_.every) == 0;
    }

    /// One scan; false if the observation cannot be right, with the reason in `summary_.damage`.
    bool process(const SourceItem& scan, std::size_t index) {
        const auto start = Clock::now();
        std::optional<PointCloud> cloud;
        try {
            DecodeStats stats;
            cloud = toPointCloud(scan, params_.sensor, &stats);
            reading_.add(stats, *cloud);
        } catch (const std::invalid_argument&) {
            throw;  // parameters that do not fit the sensor: not the input's fault
        } catch (const std::exception& e) {
            summary_.damage = options_.input + ": object " + std::to_string(source_.objects() - 1) + " (scan " +
                              std::to_string(index) + "): " + messageOf(e);
            return false;
        }
        const double decode_ms = msSince(start);
        SequenceResult found = detector_.process(std::move(*cloud));
        watch(found, index);
        keepChosen(options_.classes, found.detection.obstacles);
        const double total_ms = msSince(start);
        in_place_.add(found.cloud, returnsToWatch(found));
        outputs_.add(summary_.scans, index, {found, health_.report(), zones_ ? &*zones_ : nullptr}, detector_);
        sees_space_ = sees_space_ || found.cloud.view.rings != 1;
        at_origin_ = at_origin_ && found.cloud.sensor_origin.norm() < 0.01f;
        summary_.motion.add(found);
        summary_.add(found.cloud, found.detection, decode_ms, total_ms);
        return true;
    }

    /// Zones see all obstacles, also those that are not written.
    void watch(SequenceResult& found, std::size_t index) {
        const auto start = Clock::now();
        const HealthReport& health = health_.update(found);
        found.detection.timing.push_back({"health", msSince(start)});
        if (zones_) {
            const auto began = Clock::now();
            zones_->update({found, detector_.trajectory(), &health, std::nullopt});
            found.detection.timing.push_back({"zones", msSince(began)});
        }
        summary_.watched.add(index, zones_ ? &*zones_ : nullptr, health);
    }

    /// What is neither ground nor, unless the body is to be learnt anew, left out as the own body already.
    std::vector<std::int32_t> returnsToWatch(const SequenceResult& found) const {
        if (!options_.learn_own_body) return found.detection.candidates;
        std::vector<std::int32_t> returns;
        for (std::size_t i = 0; i < found.cloud.size(); ++i)
            if (found.detection.ground.is_ground[i] == 0) returns.push_back(static_cast<std::int32_t>(i));
        return returns;
    }

    /// A sensor that is told upside down or far too low sees no ground where it is looked for.
    void remarkOnGround() {
        if (!sees_space_ || summary_.ground.size() != 1 || summary_.ground.count("none") == 0) return;
        std::string remark =
            "no ground in any scan: does the sensor sit as the input says? --sensor-pose tells where it does";
        if (at_origin_ && !options_.choice.points_in_vehicle)
            remark += "; if the points are in the vehicle's frame already, say so with --points-in-vehicle";
        addRemark(summary_.remarks, remark);
    }

    void remarkOnOwnBody() {
        const std::vector<OwnPart>& parts = summary_.in_place.parts();
        if (parts.empty()) return;
        addRemark(summary_.remarks, "something stands at the same place of the vehicle all the time, its own body? " +
                                        lidar_obstacles::toText(OwnBody(std::vector<OwnPart>{parts.front()})) +
                                        (parts.size() > 1 ? " and more" : "") +
                                        "; --learn-own-body makes a mask of it");
    }

    void requireScans(const LidarScans& scans) const {
        if (summary_.scans > 0 || summary_.interrupted_at) return;
        if (!summary_.damage.empty()) throw std::runtime_error(summary_.damage);
        if (scans.hasGapsOnly()) throw std::runtime_error(options_.input + ": " + source_.remarks());
        if (summary_.scans_in_input > 0) {
            throw UsageError(options_.input + ": --from, --to and --every leave none of its scans");
        }
        const auto& wanted = options_.choice.sensor_label;
        if (!wanted) throw std::runtime_error(noScansIn(options_.input, source_));
        throw UsageError(options_.input + ": no lidar '" + *wanted + "'; there are: " + listLidars(options_));
    }

    ObstacleDetector detector_;
    HealthMonitor health_;
    std::optional<ZoneMonitor> zones_;
    PoseFeed source_;
    const Options& options_;
    const DetectorParams& params_;
    Outputs& outputs_;
    OwnBodyLearner in_place_;
    ReadingReport reading_;
    bool sees_space_ = false;  ///< not one plane only
    bool at_origin_ = true;    ///< all rays start where the vehicle's frame does: the input does not know better
    Summary summary_;
};

}  // namespace

Summary replay(ScanSource& source, const Options& options, const DetectorParams& params, Outputs& outputs) {
    try {
        return Replay(source, options, params, outputs).run();
    } catch (const UsageError&) {
        outputs.discard();
        throw;
    } catch (const std::invalid_argument&) {
        outputs.discard();
        throw;
    } catch (const std::exception&) {
        if (outputs.scans() == 0) outputs.discard();
        throw;
    }
}

}  // namespace lidar_obstacles::apps
