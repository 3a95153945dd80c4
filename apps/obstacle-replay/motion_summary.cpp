#include "motion_summary.h"

#include <algorithm>
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

}  // namespace

void MotionSummary::add(const SequenceResult& found) {
    ++scans_by_pose[lidar_obstacles::toString(found.pose)];
    if (found.deskewing) ++scans_by_deskewing[deskewingOf(found)];
    restarts += found.restarted;
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
