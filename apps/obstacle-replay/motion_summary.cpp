// SPDX-License-Identifier: BSD-3-Clause
#include "motion_summary.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace lidar_obstacles::apps {
namespace {

/// "done", "no_point_times", or what was wrong with the poses.
std::string deskewingOf(const SequenceResult& found) {
    if (*found.deskewing == Deskewing::Done) return "done";
    return *found.deskewing == Deskewing::NoPointTimes ? "no_point_times" : toString(found.deskew_poses);
}

const char* toString(FilterMode mode) {
    return mode == FilterMode::Off ? "off" : mode == FilterMode::Spurious ? "spurious" : "static";
}

/// The middle one, in thousandths; 0 for none.
double medianOf(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return std::round(1e3 * *middle) / 1e3;
}

std::size_t countOf(const std::map<std::string, std::size_t>& counts, const char* word) {
    const auto it = counts.find(word);
    return it == counts.end() ? 0 : it->second;
}

}  // namespace

std::string MotionSummary::text() const {
    std::size_t scans = 0;
    for (const auto& [found, count] : scans_by_pose) scans += count;
    const std::size_t with_pose = countOf(scans_by_pose, "at") + countOf(scans_by_pose, "extrapolated");
    if (source.kind == EgoKind::None) return "";
    char text[240];
    if (source.kind == EgoKind::Matching)
        std::snprintf(text, sizeof text,
                      "poses: from the scans themselves, for %zu of %zu; median residual %.3f m, %.0f %% of the "
                      "returns laid on known surfaces; %zu scans bridged, %zu lost",
                      with_pose, scans, medianOf(residuals), 100.0 * medianOf(overlaps),
                      countOf(scans_by_match, "bridged"), countOf(scans_by_match, "lost"));
    else
        std::snprintf(text, sizeof text, "poses: %zu of '%s' (%s), for %zu of %zu scans", poses, source.label.c_str(),
                      toString(source.kind), with_pose, scans);
    return text;
}

std::string MotionSummary::missing(const DetectorParams& params) const {
    const bool any = countOf(scans_by_pose, "at") + countOf(scans_by_pose, "extrapolated") > 0;
    const bool sequence = scans_by_pose.empty() ? false : scans_by_pose.size() > 1 || scans_by_pose.begin()->second > 1;
    if (any || !sequence || !params.tracking.enabled) return "";
    const std::string without = "no scan has a pose of the vehicle: tracks have no velocities";
    return source.kind == EgoKind::Matching ? without
                                            : without + "; --set ego.source=matching makes poses of the scans";
}

void MotionSummary::add(const SequenceResult& found) {
    ++scans_by_pose[lidar_obstacles::toString(found.pose)];
    if (found.deskewing) ++scans_by_deskewing[deskewingOf(found)];
    restarts += found.restarted;
    if (found.match) {
        poses += found.match->poses.size();
        ++scans_by_match[lidar_obstacles::toString(found.match->state)];
        if (!found.match->poses.empty()) {
            residuals.push_back(found.match->residual);
            overlaps.push_back(found.match->overlap);
        }
    }
    mended_scans += found.mended;
    filtered_scans += found.filtered;
    filtered_returns += found.detection.filtered.size();
    most_voxels = std::max(most_voxels, found.filter_voxels);
    multi_scans += found.earlier_scans > 0;
}

void addMotion(nlohmann::ordered_json& json, const MotionSummary& summary, const DetectorParams& params) {
    using Json = nlohmann::ordered_json;
    const bool any = summary.source.kind != EgoKind::None;
    json["ego"] = {{"source", any ? Json(summary.source.label) : Json()},
                   {"kind", toString(summary.source.kind)},
                   {"poses", summary.poses},
                   {"refused_poses", summary.refused_poses},
                   {"scans", Json(summary.scans_by_pose)},
                   {"restarts", summary.restarts}};
    if (summary.source.kind == EgoKind::Matching)
        json["ego"]["matching"] = {{"scans", Json(summary.scans_by_match)},
                                   {"median_residual", medianOf(summary.residuals)},
                                   {"median_overlap", medianOf(summary.overlaps)}};
    json["deskew"] = {{"enabled", params.deskew.enabled},
                      {"scans", params.deskew.enabled ? Json(summary.scans_by_deskewing) : Json::object()},
                      {"mended_seams", summary.mended_scans}};
    json["octomap"] = {{"mode", toString(params.octomap.mode)},
                       {"scans", summary.filtered_scans},
                       {"filtered_returns", summary.filtered_returns},
                       {"most_voxels", summary.most_voxels}};
    json["multi_scan_grid"] = {{"scans_per_grid", params.grid.scans}, {"scans", summary.multi_scans}};
}

}  // namespace lidar_obstacles::apps
