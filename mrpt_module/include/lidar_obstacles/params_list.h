// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The one list of all parameters. Loading a config file, writing one, the check for unknown keys and range checks
/// walk it, so that a parameter is named in two places only: its struct and here.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "lidar_obstacles/params.h"

namespace lidar_obstacles {

struct ParamInfo {
    const char* section;
    const char* key;
    const char* unit;    ///< "" where the value has none
    const char* source;  ///< section of the paper, or "" where it is ours
    const char* text;    ///< one line
    double min;          ///< smallest allowed value (numbers only)
    double max;          ///< largest allowed value (numbers only)
};

/// The words of an enumeration as they stand in a config file: `choices(FreeSpace{})`.
inline constexpr std::array<std::pair<std::string_view, FreeSpace>, 2> choices(FreeSpace) {
    return {{{"ground", FreeSpace::Ground}, {"rays", FreeSpace::Rays}}};
}

inline constexpr std::array<std::pair<std::string_view, BoxMethod>, 2> choices(BoxMethod) {
    return {{{"plane", BoxMethod::Plane}, {"faces", BoxMethod::Faces}}};
}

inline constexpr std::array<std::pair<std::string_view, Algorithm>, 3> choices(Algorithm) {
    return {{{"16-plane", Algorithm::Planes16}, {"8-plane", Algorithm::Planes8}, {"auto", Algorithm::Auto}}};
}

inline constexpr std::array<std::pair<std::string_view, LinePoints>, 2> choices(LinePoints) {
    return {{{"cells", LinePoints::Cells}, {"returns", LinePoints::Returns}}};
}

inline constexpr std::array<std::pair<std::string_view, Completion>, 2> choices(Completion) {
    return {{{"none", Completion::None}, {"prior", Completion::Prior}}};
}

inline constexpr std::array<std::pair<std::string_view, FilterMode>, 3> choices(FilterMode) {
    return {{{"off", FilterMode::Off}, {"spurious", FilterMode::Spurious}, {"static", FilterMode::Static}}};
}

inline constexpr std::array<std::pair<std::string_view, BeyondRange>, 2> choices(BeyondRange) {
    return {{{"keep", BeyondRange::Keep}, {"drop", BeyondRange::Drop}}};
}

inline constexpr std::array<std::pair<std::string_view, TrackStamp>, 3> choices(TrackStamp) {
    return {{{"seen", TrackStamp::Seen}, {"scan", TrackStamp::Scan}, {"now", TrackStamp::Now}}};
}

/// Calls `visit(ParamInfo, value&)` for every parameter in the order of config.ini. A value is a bool, an int, a
/// double, a string (a name or a file) or an enumeration with `choices()`. `Params` is DetectorParams, const or not.
template <class Params, class Visitor>
// NOLINTNEXTLINE(readability-function-size): one list, a line for each parameter
void forEachParam(Params& p, Visitor&& visit) {
    visit(ParamInfo{"pipeline", "algorithm", "", "Sec. III, IV",
                    "16-plane: vertical planes; 8-plane: convex hulls on a fine grid; auto: per obstacle", 0, 0},
          p.pipeline.algorithm);
    visit(ParamInfo{"pipeline", "bare_paper", "", "Sec. III, IV",
                    "the paper by itself: its clustering, gates and fits, nothing of ours", 0, 1},
          p.pipeline.bare_paper);
    visit(ParamInfo{"pipeline", "auto_min_planes", "", "",
                    "auto fits a plane to what so many rings hit, a hull to the rest", 1, 128},
          p.pipeline.auto_min_planes);
    visit(ParamInfo{"pipeline", "auto_min_height", "m", "", "... and over at least this height", 0, 3},
          p.pipeline.auto_min_height);

    visit(ParamInfo{"sensor", "planes", "", "Sec. V", "keep this many rings (decimation); 0: all", 0, 128},
          p.sensor.planes);
    visit(ParamInfo{"sensor", "rings", "", "", "rings of the sensor; 0: from the observation", 0, 128}, p.sensor.rings);
    visit(ParamInfo{"sensor", "min_range", "m", "", "nearer returns are dropped", 0, 10}, p.sensor.min_range);
    visit(ParamInfo{"sensor", "max_range", "m", "", "farther returns are dropped", 1, 300}, p.sensor.max_range);

    visit(
        ParamInfo{
            "ego", "source", "", "",
            "poses of the vehicle: auto, none, matching (from the scans themselves) or the label of an observation", 0,
            0},
        p.ego.source);
    visit(ParamInfo{"ego", "max_gap", "s", "", "poses farther apart are not interpolated", 0.01, 10}, p.ego.max_gap);
    visit(ParamInfo{"ego", "max_extrapolation", "s", "", "beyond the last pose, at constant velocity", 0, 1},
          p.ego.max_extrapolation);
    visit(ParamInfo{"ego", "max_speed", "m/s", "", "faster from one pose to the next: a jump", 1, 200},
          p.ego.max_speed);
    visit(ParamInfo{"ego", "max_turn_deg", "deg/s", "", "heading turns faster from one pose to the next: a jump", 10,
                    1000},
          p.ego.max_turn_deg);
    visit(ParamInfo{"deskew", "enabled", "", "",
                    "move each return to the scan's reference time; needs poses and point times", 0, 1},
          p.deskew.enabled);
    visit(ParamInfo{"deskew", "mend_seam", "", "",
                    "put together what moved between the first and the last returns of a scan", 0, 1},
          p.deskew.mend_seam);

    visit(ParamInfo{"ground", "sectors", "", "Sec. III.A", "number of directions in which the ground is fitted", 4, 72},
          p.ground.sectors);
    visit(ParamInfo{"ground", "max_slope_deg", "deg", "Sec. III.A", "steepest ground relative to the vehicle", 1, 30},
          p.ground.max_slope_deg);
    visit(ParamInfo{"ground", "threshold", "m", "Sec. III.A", "returns lower than this above the plane are ground",
                    0.02, 1},
          p.ground.threshold);
    visit(ParamInfo{"ground", "threshold_per_metre", "m/m", "", "growth of the threshold with range", 0, 0.1},
          p.ground.threshold_per_metre);
    visit(ParamInfo{"ground", "ransac_iterations", "", "Sec. III.A", "hypotheses for the plane of the whole scan", 1,
                    10000},
          p.ground.ransac_iterations);
    visit(ParamInfo{"ground", "iterations", "", "Sec. III.A", "least-squares fits of its surface", 1, 20},
          p.ground.iterations);
    visit(ParamInfo{"ground", "min_seeds", "", "", "with fewer ground points on its plane none is told", 3, 10000},
          p.ground.min_seeds);
    visit(ParamInfo{"ground", "seed", "", "", "seed of the random numbers", 0, 2147483647}, p.ground.seed);

    visit(ParamInfo{"ground", "standing_runs", "", "",
                    "take back short runs that stand out of the ground on their ring", 0, 1},
          p.ground.standing_runs);
    visit(ParamInfo{"low", "enabled", "", "", "look for steps, drops and missing ground near the vehicle", 0, 1},
          p.low.enabled);
    visit(ParamInfo{"low", "min_step", "m", "", "steps up and down of less are driven over", 0.03, 0.5},
          p.low.min_step);
    visit(ParamInfo{"low", "range", "m", "", "searched around the sensor", 1, 30}, p.low.range);

    visit(ParamInfo{"region", "max_height", "m", "Sec. III.A",
                    "higher returns above the ground are no obstacles (bridges, signs)", 0.3, 10},
          p.region.max_height);
    visit(ParamInfo{"region", "front", "m", "Sec. III.A", "extent of the grid ahead", 1, 300}, p.region.front);
    visit(ParamInfo{"region", "rear", "m", "Sec. III.A", "extent of the grid behind", 1, 300}, p.region.rear);
    visit(ParamInfo{"region", "lateral", "m", "Sec. III.A", "extent of the grid to either side", 1, 300},
          p.region.lateral);
    visit(ParamInfo{"region", "outline", "", "",
                    "of this extent only what lies in it is searched: none (all), or polygon(..) and box(..) as of "
                    "own_body, @FILE",
                    0, 0},
          p.region.outline);
    visit(ParamInfo{"region", "excluded", "", "",
                    "not searched: none; polygon(..) and box(..) as of own_body; sector(azimuth from, to) [deg], "
                    "counter-clockwise from ahead; @FILE",
                    0, 0},
          p.region.excluded);
    visit(ParamInfo{"region", "own_body", "", "",
                    "own vehicle, no obstacle: none; box(x from, to, y from, to [, z from, to]) and polygon(x y, x y, "
                    "..) [m], several in a row; @FILE that holds such a text (obstacle-replay --learn-own-body)",
                    0, 0},
          p.region.own_body);

    visit(ParamInfo{"octomap", "mode", "", "",
                    "3D filter before the grid; spurious: rain, dust, mixed pixels; static: what a map knows", 0, 0},
          p.octomap.mode);
    visit(ParamInfo{"octomap", "resolution", "m", "", "edge of a voxel (a map has its own)", 0.05, 2},
          p.octomap.resolution);
    visit(ParamInfo{"octomap", "range", "m", "", "reach of the filter around the sensor", 1, 300}, p.octomap.range);
    visit(ParamInfo{"octomap", "beyond", "", "", "returns beyond that reach", 0, 0}, p.octomap.beyond);
    visit(ParamInfo{"octomap", "min_neighbours", "", "",
                    "spurious: so many near returns of the same scan support a return", 1, 8},
          p.octomap.min_neighbours);
    visit(ParamInfo{"octomap", "neighbour_distance", "m", "", "near: up to this distance, next to the sensor", 0, 2},
          p.octomap.neighbour_distance);
    visit(ParamInfo{"octomap", "neighbour_per_metre", "m/m", "", "growth of that distance with range", 0, 0.2},
          p.octomap.neighbour_per_metre);
    visit(ParamInfo{"octomap", "history", "", "", "spurious: scans that a voxel remembers", 1, 32}, p.octomap.history);
    visit(ParamInfo{"octomap", "min_hits", "", "", "spurious: a voxel hit in so many of them supports a return", 1, 32},
          p.octomap.min_hits);
    visit(ParamInfo{"octomap", "max_voxels", "", "", "spurious: the map never holds more", 1000, 10000000},
          p.octomap.max_voxels);
    visit(ParamInfo{"octomap", "map", "", "", "static: the map (.bt, .ot) that octomap-build wrote, or none", 0, 0},
          p.octomap.map);
    visit(
        ParamInfo{"octomap", "min_probability", "", "", "static: voxels at least so likely occupied are known", 0.5, 1},
        p.octomap.min_probability);
    visit(ParamInfo{"octomap", "margin", "m", "", "static: a return this near to a known voxel belongs to it", 0, 1},
          p.octomap.margin);

    visit(ParamInfo{"grid", "resolution", "m", "Sec. III.A", "cell size of the 16-plane algorithm", 0.02, 2},
          p.grid.resolution);
    visit(
        ParamInfo{"grid", "fine_resolution", "m", "Sec. IV", "cell size of the 8-plane algorithm and of auto", 0.02, 2},
        p.grid.fine_resolution);
    visit(ParamInfo{"grid", "min_fraction", "", "Sec. III.A",
                    "count threshold as a share of what one ring leaves on a wall across a cell", 0, 1},
          p.grid.min_fraction);
    visit(ParamInfo{"grid", "max_threshold", "", "Sec. III.A", "the count threshold never asks for more", 1, 100},
          p.grid.max_threshold);
    visit(ParamInfo{"grid", "free", "", "Sec. III.A", "ground | rays: what makes a cell free", 0, 0}, p.grid.free);
    visit(ParamInfo{"grid", "scans", "", "", "returns of so many scans fill it, ego motion undone; 1: one scan alone",
                    1, 20},
          p.grid.scans);

    visit(ParamInfo{"clustering", "closing", "m", "Sec. III.A",
                    "closing makes cells neighbours up to this far apart, next to the sensor", 0, 2},
          p.clustering.closing);
    visit(ParamInfo{"clustering", "closing_per_metre", "m/m", "", "growth of that distance with range", 0, 0.2},
          p.clustering.closing_per_metre);
    visit(ParamInfo{"clustering", "link_per_metre", "m/m", "",
                    "along a scan line, returns are one surface up to this gap per metre of range", 0, 0.3},
          p.clustering.link_per_metre);
    visit(ParamInfo{"clustering", "link_max", "m", "", "longest such gap", 0, 5}, p.clustering.link_max);
    visit(ParamInfo{"clustering", "link_columns", "", "", "how far along the scan line, in azimuth steps", 0, 50},
          p.clustering.link_columns);

    visit(ParamInfo{"grouping", "max_gap", "m", "", "pieces of one object are this near, across the line of sight", 0,
                    10},
          p.grouping.max_gap);
    visit(ParamInfo{"grouping", "max_depth", "m", "", "... and along it", 0, 10}, p.grouping.max_depth);
    visit(ParamInfo{"grouping", "max_length", "m", "", "of the largest vehicle, an articulated bus", 1, 50},
          p.grouping.max_length);
    visit(ParamInfo{"grouping", "max_width", "m", "", "of the largest vehicle", 0.5, 20}, p.grouping.max_width);
    visit(ParamInfo{"recognizer", "model", "", "", "built-in, or a file written by obstacle-train", 0, 0},
          p.recognizer.model);

    visit(ParamInfo{"gates", "min_points", "", "Sec. III.A", "with fewer returns the class is unknown", 1, 1000},
          p.gates.min_points);
    visit(ParamInfo{"gates", "min_top", "m", "Sec. III.A", "lower clusters are ground leftovers and kerbs", 0, 2},
          p.gates.min_top);
    visit(ParamInfo{"gates", "max_bottom", "m", "",
                    "what hangs higher, with beams seen to pass below it, can be passed under", 0.2, 5},
          p.gates.max_bottom);
    visit(ParamInfo{"gates", "min_extent", "m", "Sec. III.A", "bare_paper only: shorter clusters are too small", 0, 2},
          p.gates.min_extent);
    visit(ParamInfo{"gates", "max_length", "m", "Sec. III.A", "bare_paper only: longer clusters are too large", 1, 50},
          p.gates.max_length);
    visit(ParamInfo{"gates", "max_width", "m", "Sec. III.A", "bare_paper only: wider clusters are too large", 0.5, 20},
          p.gates.max_width);
    visit(ParamInfo{"gates", "min_points_vehicle", "", "", "a vehicle of fewer returns is called unknown", 0, 1000},
          p.gates.min_points_vehicle);
    visit(
        ParamInfo{"gates", "min_points_pedestrian", "", "", "a pedestrian of fewer returns is called unknown", 0, 1000},
        p.gates.min_points_pedestrian);
    visit(ParamInfo{"gates", "min_points_cyclist", "", "", "a cyclist of fewer returns is called unknown", 0, 1000},
          p.gates.min_points_cyclist);
    visit(ParamInfo{"gates", "min_probability", "", "", "a road user that is less probable is called unknown", 0, 1},
          p.gates.min_probability);
    visit(ParamInfo{"gates", "max_length_vehicle", "m", "",
                    "a vehicle whose seen part is longer is called unknown; 0: no limit of your own", 0, 50},
          p.gates.max_length_vehicle);
    visit(ParamInfo{"gates", "max_length_pedestrian", "m", "", "the same of a pedestrian", 0, 50},
          p.gates.max_length_pedestrian);
    visit(ParamInfo{"gates", "max_length_cyclist", "m", "", "the same of a cyclist", 0, 50},
          p.gates.max_length_cyclist);

    visit(ParamInfo{"plane_fit", "method", "", "Sec. III.A",
                    "plane: one plane by RANSAC, as the paper; faces: both seen faces at once", 0, 0},
          p.plane_fit.method);
    visit(ParamInfo{"plane_fit", "inlier_distance", "m", "Sec. III.A", "returns this near to the plane lie on it", 0.01,
                    1},
          p.plane_fit.inlier_distance);
    visit(ParamInfo{"plane_fit", "ransac_iterations", "", "Sec. III.A", "hypotheses per cluster (method = plane)", 1,
                    10000},
          p.plane_fit.ransac_iterations);
    visit(ParamInfo{"plane_fit", "seed", "", "", "seed of the random numbers", 0, 2147483647}, p.plane_fit.seed);
    visit(ParamInfo{"plane_fit", "max_facing_deg", "deg", "Sec. III.A",
                    "the plane's normal may turn this far from the line of sight (method = plane)", 10, 90},
          p.plane_fit.max_facing_deg);
    visit(ParamInfo{"plane_fit", "edge_limit", "m", "",
                    "returns farther from the faces than this all count the same (method = faces)", 0.05, 2},
          p.plane_fit.edge_limit);

    visit(ParamInfo{"hull_fit", "two_sides", "m", "Sec. IV",
                    "two sides are seen where both dimensions of the hull exceed this", 0.1, 3},
          p.hull_fit.two_sides);
    visit(ParamInfo{"hull_fit", "corner", "m", "Sec. IV",
                    "two sides are seen where the hull's corner stands out this far to the sensor", 0, 3},
          p.hull_fit.corner);
    visit(
        ParamInfo{"hull_fit", "person", "m", "Sec. IV", "no heading where both dimensions of the hull are below", 0, 3},
        p.hull_fit.person);
    visit(ParamInfo{"hull_fit", "line_from", "", "Sec. IV",
                    "cells | returns: what RANSAC searches a line in where one side is seen", 0, 0},
          p.hull_fit.line_from);
    visit(ParamInfo{"hull_fit", "inlier_distance", "m", "Sec. IV", "cells this near to the line lie on it", 0.01, 1},
          p.hull_fit.inlier_distance);
    visit(ParamInfo{"hull_fit", "ransac_iterations", "", "Sec. IV", "hypotheses per cluster", 1, 10000},
          p.hull_fit.ransac_iterations);
    visit(ParamInfo{"hull_fit", "seed", "", "", "seed of the random numbers", 0, 2147483647}, p.hull_fit.seed);
    visit(ParamInfo{"hull_fit", "refine", "", "", "turn boxes to fit the cells near their seen sides best", 0, 1},
          p.hull_fit.refine);

    visit(ParamInfo{"box", "face_distance", "m", "", "returns this near to a seen face lie on it", 0.01, 1},
          p.box.face_distance);
    visit(ParamInfo{"box", "tall", "m", "", "higher vehicles may be wider than a car", 1, 5}, p.box.tall);
    visit(ParamInfo{"box", "min_rear_width", "m", "", "a narrower face is no whole rear", 0, 3}, p.box.min_rear_width);
    visit(ParamInfo{"box", "max_car_width", "m", "", "a wider face is a side, not the rear of a car", 1, 5},
          p.box.max_car_width);
    visit(ParamInfo{"box", "max_rear_width", "m", "", "a wider face is a side, not a rear", 1, 5},
          p.box.max_rear_width);
    visit(ParamInfo{"box", "min_vehicle_length", "m", "", "a shorter face is no whole side", 1, 8},
          p.box.min_vehicle_length);
    visit(ParamInfo{"box", "completion", "", "",
                    "none: boxes enclose what is seen; prior: the unseen part of vehicles grows to their usual size", 0,
                    0},
          p.box.completion);
    visit(ParamInfo{"box", "car_length", "m", "", "usual length of a car", 1, 10}, p.box.car_length);
    visit(ParamInfo{"box", "car_width", "m", "", "usual width of a car", 0.5, 4}, p.box.car_width);
    visit(ParamInfo{"box", "tall_length", "m", "", "usual length of a tall vehicle", 1, 20}, p.box.tall_length);
    visit(ParamInfo{"box", "tall_width", "m", "", "usual width of a tall vehicle", 0.5, 4}, p.box.tall_width);

    visit(ParamInfo{"tracking", "enabled", "", "", "follow boxes over the scans of a sequence", 0, 1},
          p.tracking.enabled);
    visit(ParamInfo{"tracking", "grouping", "", "", "tracks help to group the returns of the next scan", 0, 1},
          p.tracking.grouping);
    visit(ParamInfo{"tracking", "stamp", "", "",
                    "boxes as of when the laser saw them, of the scan's timestamp, or of now (live)", 0, 0},
          p.tracking.stamp);
    visit(ParamInfo{"tracking", "max_hidden", "s", "", "what is hidden longer is given up", 0, 60},
          p.tracking.max_hidden);
    visit(ParamInfo{"tracking", "max_gap", "s", "", "scans farther apart: all tracks begin anew", 0.05, 60},
          p.tracking.max_gap);
    visit(ParamInfo{"tracking", "face_std", "m", "", "error of a seen face, next to the sensor", 0.005, 1},
          p.tracking.face_std);
    visit(ParamInfo{"tracking", "face_std_per_metre", "m/m", "", "growth of that error with range", 0, 0.1},
          p.tracking.face_std_per_metre);
    visit(
        ParamInfo{"tracking", "heading_std_deg", "deg", "", "error assumed of headings that come without one", 0.1, 45},
        p.tracking.heading_std_deg);
}

}  // namespace lidar_obstacles
