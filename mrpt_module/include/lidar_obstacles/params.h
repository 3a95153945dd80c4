/// @file
/// One plain struct per stage, the default beside each member. `params_list.h` names every member once more,
/// with unit, range and the paper's section; loading, dumping and checking all walk that list.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace lidar_obstacles {

/// What is taken from an observation (applied at the border, mrpt_bridge/observations.h).
struct SensorParams {
    int planes = 0;            ///< keep this many planes of the sensor's (decimation); 0: all
    int rings = 0;             ///< planes of the sensor; 0: from calibration or highest laser_id + 1
    double min_range = 0.4;    ///< nearer returns are dropped [m]
    double max_range = 120.0;  ///< farther returns are dropped [m]
};

/// Ground segmentation (Sec. III.A; Zermas et al. 2017).
struct GroundParams {
    int sectors = 12;                ///< azimuth sectors, each with planes of its own
    double max_slope_deg = 9.0;      ///< steepest ground relative to the vehicle [deg]
    double max_step = 0.35;          ///< largest height step between neighbouring ground seeds [m]
    double threshold = 0.20;         ///< returns lower than this above the plane are ground [m]
    double threshold_per_metre = 0.004;  ///< growth of the threshold with range [m/m]
    int iterations = 3;              ///< refits of each plane
    int min_seeds = 30;              ///< fewer seeds on the plane of the scan: no evidence
};

/// Region of interest (Sec. III.A).
struct RegionParams {
    double max_height = 2.5;   ///< returns higher above the ground are not obstacles (bridges, signs) [m]
    double front = 60.0;       ///< [m]
    double rear = 60.0;        ///< [m]
    double lateral = 30.0;     ///< to either side [m]
    double own_front = 1.0;    ///< own vehicle: extent ahead of the origin [m]
    double own_rear = 1.0;     ///< [m]
    double own_lateral = 0.6;  ///< [m]
};

/// What makes a cell free (Sec. III.A; the rest is unknown).
enum class FreeSpace : std::uint8_t { Ground, Rays };

/// Occupancy grid (Sec. III.A).
struct GridParams {
    double resolution = 0.2;             ///< cell size [m]
    double min_fraction = 0.15;          ///< of the returns one plane would leave on a wall as wide as the cell
    int max_threshold = 3;               ///< the count threshold never asks for more
    FreeSpace free = FreeSpace::Ground;  ///< `ground`: cells with ground returns; `rays`: carved along each ray
};

struct DetectorParams {
    SensorParams sensor;
    GroundParams ground;
    RegionParams region;
    GridParams grid;
};

/// Throws std::invalid_argument naming section, key, value and the allowed range of the first bad value.
void validate(const DetectorParams& params);

}  // namespace lidar_obstacles
