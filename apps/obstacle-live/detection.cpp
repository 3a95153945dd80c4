// SPDX-License-Identifier: BSD-3-Clause
#include "detection.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "common/zone_rows.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"

namespace lidar_obstacles::apps {
namespace {

std::unique_ptr<live::LiveDetector> openDetector(const DetectorParams& params, const Log& log) {
    auto detector = std::make_unique<live::LiveDetector>(params);
    detector->logRegisterCallback([&log](std::string_view text, auto level, auto, auto) { log.logStr(level, text); });
    return detector;
}

bool isChanged(const std::string& section, const DetectorParams& before, const DetectorParams& after) {
    const std::vector<ParamValue> a = listParams(before), b = listParams(after);
    for (std::size_t k = 0; k < a.size(); ++k)
        if (a[k].section == section && a[k].value != b[k].value) return true;
    return false;
}

}  // namespace

LiveDetection::LiveDetection(const Options& options, const DetectorParams& params, const Log& log)
    : options_(options),
      log_(log),
      params_(params),
      detector_(openDetector(params, log)),
      zones_(openZones(options.zones, params.region)) {}

void LiveDetection::set(const std::vector<std::string>& assignments) {
    DetectorParams params = params_;
    for (const std::string& assignment : assignments) setParam(params, assignment);
    validate(params);
    if (matchesScans(params.ego) && (options_.poses || options_.standing_at))
        throw std::invalid_argument("[ego] source = matching makes the poses: without --poses and --standing-at");
    const bool other_region = isChanged("region", params_, params);
    if (zones_ && other_region && (matchesScans(params.ego) || matchesScans(params_.ego)))
        throw std::invalid_argument("[region] cannot be changed while zones follow poses that are made of the scans");
    auto detector = openDetector(params, log_);
    tryOn(params, *detector);
    for (const StampedPose& pose : poses_) detector->addPose(pose);
    if (zones_ && other_region) zones_.emplace(ZoneSet(zones_->set()), params.region);
    if (isChanged("sensor", params_, params)) health_ = HealthMonitor();  // rings that are left out are not silent
    params_ = params;
    detector_ = std::move(detector);
    first_id_ = next_id_;
    begins_ = true;
}

/// Parameters that do not fit the sensor end a run; here they are refused.
void LiveDetection::tryOn(const DetectorParams& params, const live::LiveDetector& detector) const {
    if (last_scans_.empty() && isChanged("sensor", params_, params))
        throw std::invalid_argument("[sensor] can be changed once a scan has come: they must fit");
    if (last_scans_.empty()) return;
    const auto decoded = detector.decode(last_scans_);
    if (decoded.cloud) detect(*decoded.cloud, params);
}

void LiveDetection::addPose(const StampedPose& pose) {
    constexpr std::size_t kKept = 4096;
    detector_->addPose(pose);
    poses_.push_back(pose);
    if (poses_.size() > kKept) poses_.pop_front();
}

live::JoinedDecode LiveDetection::decode(std::vector<live::LiveScan> scans) {
    live::JoinedDecode decoded = detector_->decode(scans);
    last_scans_ = std::move(scans);
    return decoded;
}

SequenceResult LiveDetection::process(PointCloud cloud, double last_arrival) {
    SequenceResult found = detector_->process(std::move(cloud), live::steadyClock() - last_arrival);
    if (std::exchange(begins_, false)) {  // its matcher made a frame of its own
        found.restarted = true;
        if (found.match) found.match->restarted = true;
    }
    for (Obstacle& o : found.detection.obstacles) {
        if (o.id >= kFirstUntrackedId) continue;  // numbered anew in each scan
        o.id += first_id_;
        next_id_ = std::max(next_id_, o.id + 1);
    }
    const HealthReport& health = health_.update(found);
    if (zones_) zones_->update({found, detector().trajectory(), &health, live::steadyClock() - last_arrival});
    return found;
}

}  // namespace lidar_obstacles::apps
