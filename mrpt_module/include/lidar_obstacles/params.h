// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One plain struct per stage, the default beside each member. `params_list.h` names every member once more,
/// with unit, range and the paper's section; loading, dumping and checking all walk that list.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lidar_obstacles {

/// Which of the paper's two algorithms fits the boxes.
enum class Algorithm : std::uint8_t { Planes16, Planes8, Auto };

struct PipelineParams {
    Algorithm algorithm = Algorithm::Auto;  ///< `16-plane` (Sec. III), `8-plane` (Sec. IV), `auto`: per obstacle
    bool bare_paper = false;                ///< the paper by itself, without what we added (barePaper)
    int auto_min_planes = 2;                ///< auto: a plane is fitted to what at least so many rings hit ...
    double auto_min_height = 0.3;           ///< ... over at least this height [m]
};

/// What is taken from an observation (applied at the border, mrpt_bridge/observations.h).
struct SensorParams {
    int planes = 0;          ///< keep this many of the sensor's rings (decimation); the paper calls them planes; 0: all
    int rings = 0;           ///< rings of the sensor; 0: from calibration or highest laser_id + 1
    double min_range = 0.4;  ///< nearer returns are dropped [m]
    double max_range = 120.0;  ///< farther returns are dropped [m]
};

/// Where the vehicle's own motion comes from, and how far its poses are trusted (motion.h).
struct EgoParams {
    /// `auto`, `none`, the label of an observation (mrpt_bridge/ego_motion.h), or `matching`: from the scans
    /// themselves (scan_matching.h).
    std::string source = "auto";
    double max_gap = 0.5;             ///< poses farther apart are not interpolated [s]
    double max_extrapolation = 0.15;  ///< beyond the last pose [s]
    double max_speed = 70.0;          ///< faster from one pose to the next: a jump [m/s]
    double max_turn_deg = 200.0;      ///< heading turns faster: a jump [deg/s]
};

/// Each return to the scan's reference time (deskew.h).
struct DeskewParams {
    bool enabled = false;   ///< needs poses, and a source with point times
    bool mend_seam = true;  ///< put together what moved between the first and the last returns (seam.h)
};

/// Ground segmentation (Sec. III.A; Zermas et al. 2017).
struct GroundParams {
    int sectors = 24;                  ///< directions in which the height of the ground is told
    double max_slope_deg = 9.0;        ///< steepest ground relative to the vehicle [deg]
    double threshold = 0.15;           ///< returns lower than this above the plane are ground [m]
    double threshold_per_metre = 0.0;  ///< growth of the threshold with range [m/m]
    int ransac_iterations = 80;        ///< hypotheses for the plane of the whole scan
    int iterations = 4;                ///< least-squares fits of its surface
    int min_seeds = 30;                ///< fewer seeds on the plane of the scan: no evidence
    int seed = 1;                      ///< of the random numbers
    bool standing_runs = true;         ///< take back short runs that stand out of the ground on their ring
};

/// What is too low for an obstacle, and where the ground ends, near the vehicle (low_things.h).
struct LowParams {
    bool enabled = false;    ///< look for it; boxes do not depend on it
    double min_step = 0.08;  ///< steps up and down of less are driven over [m]
    double range = 8.0;      ///< searched around the sensor [m]
};

/// Region of interest (Sec. III.A).
struct RegionParams {
    double max_height = 2.5;        ///< returns higher above the ground are not obstacles (bridges, signs) [m]
    double front = 60.0;            ///< [m]
    double rear = 60.0;             ///< [m]
    double lateral = 40.0;          ///< to either side [m]
    std::string outline = "none";   ///< of these only what lies in it is searched (searched_place.h); none: all [m]
    std::string excluded = "none";  ///< places that are not searched (searched_place.h) [m], [deg]
    std::string own_body = "box(-1, 1, -0.6, 0.6)";  ///< own vehicle, whose returns are none (own_body.h) [m]
};

/// What makes a cell free (Sec. III.A; the rest is unknown).
enum class FreeSpace : std::uint8_t { Ground, Rays };

/// Occupancy grid (Sec. III.A).
struct GridParams {
    double resolution = 0.2;             ///< cell size of the 16-plane algorithm [m]
    double fine_resolution = 0.05;       ///< cell size of the 8-plane algorithm and of `auto` (Sec. IV) [m]
    double min_fraction = 0.15;          ///< of the returns that one ring leaves on a wall across a cell
    int max_threshold = 3;               ///< the count threshold never asks for more
    FreeSpace free = FreeSpace::Ground;  ///< `ground`: cells with ground returns; `rays`: carved along each ray
    int scans = 1;                       ///< returns of so many scans fill it, ego motion undone; 1: this one alone
};

/// What the 3D filter takes out before the grid.
enum class FilterMode : std::uint8_t { Off, Spurious, Static };

/// What happens to returns that the 3D filter knows nothing about.
enum class BeyondRange : std::uint8_t { Keep, Drop };

/// The 3D filter between region and grid (voxel_filter.h, static_map.h).
struct OctomapParams {
    FilterMode mode = FilterMode::Off;       ///< `spurious`: rain, dust, mixed pixels; `static`: what a map knows
    double resolution = 0.2;                 ///< edge of a voxel; `static` takes the map's [m]
    double range = 40.0;                     ///< reach of the filter around the sensor [m]
    BeyondRange beyond = BeyondRange::Keep;  ///< returns beyond that reach
    int min_neighbours = 2;                  ///< spurious: so many near returns of the same scan support a return ...
    double neighbour_distance = 0.05;        ///< ... this near, next to the sensor [m]
    double neighbour_per_metre = 0.04;       ///< growth of that distance with range [m/m]
    int history = 10;                        ///< spurious: scans that a voxel remembers (M)
    int min_hits = 7;                        ///< spurious: a voxel hit in so many of them supports a return (N)
    int max_voxels = 200000;                 ///< spurious: the map never holds more
    std::string map = "none";                ///< static: file of the map (.bt, .ot), written by octomap-build
    double min_probability = 0.6;            ///< static: voxels at least so likely occupied are known
    double margin = 0.1;                     ///< static: a return this near to a known voxel belongs to it [m]
};

/// Morphology and connected components (Sec. III.A, Fig. 2).
struct ClusteringParams {
    double closing = 0.05;             ///< closing makes cells neighbours up to this far apart, next to the sensor [m]
    double closing_per_metre = 0.015;  ///< growth of that distance with range [m/m]
    double link_per_metre = 0.03;      ///< along a scan line, returns are one surface up to this gap [m per m of range]
    double link_max = 1.0;             ///< longest such gap [m]
    int link_columns = 6;              ///< how far along the scan line, in azimuth steps
};

/// Which pieces may be one object (merge_tree.h).
struct GroupingParams {
    double max_gap = 2.5;      ///< pieces of one object are this near, across the line of sight [m]
    double max_depth = 4.5;    ///< ... and along it [m]
    double max_length = 19.0;  ///< of the largest vehicle, an articulated bus [m]
    double max_width = 3.6;    ///< [m]
};

/// What is no obstacle (Sec. III.A). `min_extent`, `max_length` and `max_width` serve the bare paper only; the limits
/// by class and `min_probability` serve all but it: they remove nothing, but say what is called a road user
/// (toldClass).
struct GateParams {
    int min_points = 5;        ///< returns
    double min_top = 0.35;     ///< lower ones are ground leftovers and kerbs [m]
    double max_bottom = 1.0;   ///< what hangs higher, with beams seen to pass below it, is passed under [m]
    double min_extent = 0.15;  ///< larger side [m]
    double max_length = 14.0;  ///< larger side [m]
    double max_width = 3.6;    ///< smaller side [m]

    int min_points_vehicle = 0;          ///< returns of what is called a vehicle
    int min_points_pedestrian = 0;       ///< ... a pedestrian
    int min_points_cyclist = 0;          ///< ... a cyclist
    double min_probability = 0.0;        ///< of what is called a road user
    double max_length_vehicle = 0.0;     ///< longer side, as far as it is seen, of what is called a vehicle; 0: any [m]
    double max_length_pedestrian = 0.0;  ///< ... a pedestrian [m]
    double max_length_cyclist = 0.0;     ///< ... a cyclist [m]
};

/// How the 16-plane algorithm finds the direction of a box.
enum class BoxMethod : std::uint8_t { Plane, Faces };

/// Random search for the line (the vertical plane seen from above) that most points lie on.
struct RansacParams {
    double inlier_distance = 0.15;  ///< points this near to the line lie on it [m]
    int iterations = 60;            ///< hypotheses per cluster
    int seed = 1;                   ///< of the random numbers
    double max_facing_deg = 65.0;   ///< its normal may turn this far from the line of sight [deg]
};

/// Vertical plane (Sec. III.A, Fig. 3).
struct PlaneFitParams {
    BoxMethod method = BoxMethod::Faces;  ///< `plane`: the paper's; `faces`: both seen faces at once
    double inlier_distance = 0.15;        ///< returns this near to the plane lie on it [m]
    int ransac_iterations = 60;           ///< hypotheses per cluster
    int seed = 1;                         ///< of the random numbers
    double max_facing_deg = 65.0;         ///< the plane's normal may turn this far from the line of sight [deg]
    double edge_limit = 0.3;              ///< returns farther from the faces than this all count the same [m]
};

/// What RANSAC searches a line in, where one side is seen (Sec. IV).
enum class LinePoints : std::uint8_t { Cells, Returns };

/// Convex hull on the fine grid (Sec. IV, Fig. 5).
struct HullFitParams {
    double two_sides = 0.5;                    ///< two sides are seen where both dimensions of the hull exceed this [m]
    double corner = 0.2;                       ///< ... and its corner stands out this far towards the sensor [m]
    double person = 0.8;                       ///< no heading where both dimensions are below [m]
    LinePoints line_from = LinePoints::Cells;  ///< one side: RANSAC on the `cells` (paper) or the projected `returns`
    double inlier_distance = 0.1;              ///< cells this near to the line lie on it [m]
    int ransac_iterations = 60;                ///< hypotheses per cluster
    int seed = 1;                              ///< of the random numbers
    bool refine = true;                        ///< turn both cases to fit the cells near the seen sides best
};

/// What to do about the sides that are not seen.
enum class Completion : std::uint8_t { None, Prior };

/// From an orientation to a 3D box (Sec. III.A and IV).
struct BoxParams {
    double face_distance = 0.15;                ///< returns this near to a seen face lie on it [m]
    double tall = 2.2;                          ///< higher vehicles may be wider than a car [m]
    double min_rear_width = 1.5;                ///< a narrower face is no whole rear [m]
    double max_car_width = 2.1;                 ///< a wider face is a side, not the rear of a car [m]
    double max_rear_width = 2.6;                ///< the same for a tall vehicle [m]
    double min_vehicle_length = 3.2;            ///< a shorter face is no whole side [m]
    Completion completion = Completion::Prior;  ///< `none`: the paper; `prior`: grow vehicles to their usual size
    double car_length = 4.1;                    ///< usual length of a car [m]
    double car_width = 1.7;                     ///< usual width of a car [m]
    double tall_length = 5.5;                   ///< usual length of a tall vehicle, as far as it is unseen [m]
    double tall_width = 2.1;                    ///< usual width of a tall vehicle [m]
};

/// What tells what a group is (recognizer.h).
struct RecognizerParams {
    std::string model = "built-in";  ///< or a file written by obstacle-train
};

/// At which instant a tracked box is told.
enum class TrackStamp : std::uint8_t { Seen, Scan, Now };

/// Tracks over the scans of a sequence (tracking.h).
struct TrackingParams {
    bool enabled = true;                  ///< boxes get numbers that last, velocities and steady sizes
    bool grouping = true;                 ///< what is followed helps to group the next scan's returns
    TrackStamp stamp = TrackStamp::Seen;  ///< `seen`: as the laser saw it, `scan`: at the timestamp, `now`: at output
    double max_hidden = 3.0;              ///< what is hidden longer is given up [s]
    double max_gap = 2.0;                 ///< scans farther apart: everything begins anew [s]
    double face_std = 0.05;               ///< error of a seen face, next to the sensor [m]
    double face_std_per_metre = 0.002;    ///< growth of that error with range [m/m]
    double heading_std_deg = 3.0;         ///< error of headings that come without one [deg]
};

struct DetectorParams {
    PipelineParams pipeline;
    SensorParams sensor;
    EgoParams ego;
    DeskewParams deskew;
    GroundParams ground;
    LowParams low;
    RegionParams region;
    OctomapParams octomap;
    GridParams grid;
    ClusteringParams clustering;
    GroupingParams grouping;
    RecognizerParams recognizer;
    GateParams gates;
    PlaneFitParams plane_fit;
    HullFitParams hull_fit;
    BoxParams box;
    TrackingParams tracking;
};

/// The same parameters with everything switched off that the paper does not have: its clustering and gates, its fits of
/// Sec. III and IV, boxes that enclose what is seen. `pipeline.bare_paper` runs detect() with them.
DetectorParams barePaper(DetectorParams params);

/// The same parameters with this algorithm.
inline DetectorParams withAlgorithm(Algorithm algorithm, DetectorParams params = {}) {
    params.pipeline.algorithm = algorithm;
    return params;
}

/// Throws std::invalid_argument naming section, key, value and the allowed range (or what is wrong) of the first bad
/// value.
void validate(const DetectorParams& params);

}  // namespace lidar_obstacles
