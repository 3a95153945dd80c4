// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Holds the detections of a labelled recording against its truth, scan by scan.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/detections.h"
#include "lidar_obstacles/evaluation/matching.h"
#include "lidar_obstacles/evaluation/tracking_result.h"
#include "lidar_obstacles/evaluation/truth.h"

namespace lidar_obstacles::evaluation {

/// Where box centres have to lie; vehicle frame [m].
struct RegionOfInterest {
    double x_min = 0.0;
    double x_max = 0.0;
    double y_min = 0.0;
    double y_max = 0.0;
};

/// What is asked for, and how it is matched.
struct EvaluationOptions {
    int min_points = 15;      ///< objects with fewer returns are not asked for
    double max_range = 30.0;  ///< farther ones neither, nor are farther detections wrong [m]
    double near = 15.0;       ///< objects as near as this that no box covers are counted [m]
    double fov_deg = 360.0;   ///< the labelled sector, symmetric about +x
    std::optional<RegionOfInterest> roi;
    MatchOptions match;
    std::set<std::string> ignore = {"ignore", "dontcare", "misc"};  ///< types neither wanted nor false
    bool structure = false;        ///< boxes of class structure count too; they claim no road user
    bool match_by_index = false;   ///< scans are told by scan_index instead of by timestamp
    double time_tolerance = 0.04;  ///< a detection belongs to the nearest scan not farther than this [s]
    double skip_first = 0.0;       ///< this much of the beginning is left out [s]
    bool only_scans_with_detections = false;
    std::string target;  ///< a type or group (its object with most usable rows), or `id:N`; "": none
};

/// A recording: what was there and what was found.
struct LabelledSet {
    std::string name;
    std::vector<TruthObject> truth;
    std::vector<Detection> detections;
    std::vector<StaticBox> statics;  ///< detections on them are "structure"; may be empty
    std::vector<EgoPose> ego;        ///< makes scans without any object count, and places `statics`; may be empty
};

/// Errors of a detection against its object: detection - truth.
struct BoxErrors {
    double face = 0.0;    ///< distance of the nearest face, the paper's obstacle distance [m]
    double centre = 0.0;  ///< distance of the centres, seen from above [m]
    double dz = 0.0;      ///< [m]
    double bev_iou = 0.0;
    double iou_3d = 0.0;
    bool heading_valid = false;
    double heading_180 = 0.0;  ///< modulo 180 degrees [rad]
    double heading_90 = 0.0;   ///< modulo 90 degrees: a box turned by a quarter is right [rad]
    bool swapped = false;      ///< length and width exchanged: heading_180 is nearer to 90 degrees than to 0
    bool flipped = false;      ///< front and rear exchanged: the full heading is off by 90 degrees or more
    double length = 0.0;       ///< sizes along the object's axes [m]
    double width = 0.0;
    double height = 0.0;
    std::optional<double> velocity;  ///< over ground, along the vehicle's x axis [m/s]; not set where one is not told
};

/// One object in one scan.
struct ObjectRecord {
    TruthObject object;
    double timestamp = 0.0;
    std::optional<Eigen::Vector2d> ego_velocity;  ///< of the vehicle over ground, its axes [m/s]
    bool counted = false;                         ///< asked for: enough returns, near enough, inside the region
    std::optional<Detection> detection;
    std::optional<BoxErrors> errors;  ///< where there is a detection
};

/// A detection inside the region that no object matched.
struct UnmatchedDetection {
    int scan_index = 0;
    std::string cause;  ///< "fragment", "structure", "overhead", "phantom" or "ignored"
    Detection detection;
};

/// Everything that was counted in one set.
struct SetResult {
    std::string name;
    std::size_t scans = 0;
    std::size_t detections = 0;               ///< inside the region
    std::size_t detections_without_scan = 0;  ///< of no scan of the truth
    std::vector<UnmatchedDetection> unmatched;
    std::vector<ObjectRecord> records;  ///< objects of the three groups with at least one return, in order of scans
    std::string target_id;              ///< object that `target` stands for; "" without target
    TrackingResult tracking;            ///< classes, tracks and velocities as they were told
};

/// Matches every scan (matchBoxes) and says of every detection left over why:
/// * `ignored`: it touches an object that is neither wanted nor false;
/// * `fragment`: more than 30 % of it lie on an object;
/// * `structure`, `overhead`: more than 15 % of it lie on a static box;
/// * `phantom`: anything else.
/// @throws std::runtime_error if there is no scan in truth and ego poses, or no object fits `target`.
SetResult evaluateSet(const LabelledSet& set, const EvaluationOptions& options);

BoxErrors boxErrors(const TruthObject& object, const Detection& detection);

}  // namespace lidar_obstacles::evaluation
