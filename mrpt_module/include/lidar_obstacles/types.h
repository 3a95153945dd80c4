/// @file
/// The data types of the module: what goes in, what every stage leaves behind, what comes out.
///
/// Frame: everything is told in the **vehicle frame** (MRPT's robot frame): x forward, y left, z up, metres,
/// `sensorPose` already applied. A yaw is counter-clockwise from +x, in [-pi, pi). The yaw of a box from one scan holds
/// modulo 180 degrees: which end is the front is not seen.
///
///          x (forward)                       occupancy grid, seen from above
///          ^                                  y ^  row height-1
///          |   yaw > 0 turns left               |  +--+--+--+--+
///     +----|----+                               |  |  |  |  |  |   cell (col, row) covers
///     |    |    |                               |  +--+--+--+--+   [x0 + col*res, x0 + (col+1)*res) x
///  y <-----o    |                               |  |  |  |  |  |   [y0 + row*res, y0 + (row+1)*res)
///     |         |                               |  +--+--+--+--+
///     +---------+                       origin (x0, y0) --------> x   (x0, y0) = lower-left corner
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lidar_obstacles {

/// Neighbourhood of a scan: for each ring (row, 0 = lowest elevation) and azimuth column the index of a return,
/// or -1. Columns run with rising column number in the direction the sensor turns and close to a full circle:
/// the last column is the neighbour of the first. Where two returns share a place the nearer one is listed.
/// Empty (`rings == 0`) for sources without ring numbers.
struct OrganizedView {
    int rings = 0;
    int columns = 0;
    std::vector<std::int32_t> index;      ///< rings x columns, row-major; -1 where there is no return
    std::vector<std::int32_t> column_of;  ///< column of each return of the cloud, also of those not listed in `index`

    bool empty() const { return rings == 0 || columns == 0; }
    std::int32_t at(int ring, int column) const { return index[static_cast<std::size_t>(ring) * columns + column]; }
    std::int32_t& at(int ring, int column) { return index[static_cast<std::size_t>(ring) * columns + column]; }
    /// `column` shifted by `step` around the circle.
    int wrap(int column) const {
        if (column >= 0 && column < columns) return column;
        return (column % columns + columns) % columns;
    }
};

/// One sensor of a cloud that several made: where its rays start, and which returns and rings are its own. The first
/// sensor has the first of them, each other one those behind the one before.
struct SensorRays {
    Eigen::Vector3f origin = Eigen::Vector3f::Zero();  ///< [m]
    Eigen::Vector3f up = Eigen::Vector3f::UnitZ();     ///< what its rings count along, unit length
    std::int32_t end = 0;                              ///< past its last return
    int end_ring = 0;                                  ///< past its highest ring
    int first_ring = 0;                                ///< its lowest
};

/// One lidar scan: N returns in the vehicle frame, all finite (the border drops the others).
/// `ring`, `intensity` and `time_offset` hold N entries each, or none where the source does not tell.
///
/// What several sensors saw at a time is one cloud too (joinedCloud() in joined_cloud.h): the rings of each sensor are
/// its own, columns look in the same direction from each.
struct PointCloud {
    double timestamp = 0.0;                                   ///< seconds since the epoch of the scan's first firing
    std::vector<Eigen::Vector3f> xyz;                         ///< [m]
    std::vector<std::uint16_t> ring;                          ///< 0 = lowest elevation
    std::vector<float> intensity;                             ///< 0 .. 1
    std::vector<float> time_offset;                           ///< seconds after `timestamp`
    OrganizedView view;                                       ///< ring x azimuth index; empty for sources without rings
    Eigen::Vector3f sensor_origin = Eigen::Vector3f::Zero();  ///< where the rays start
    Eigen::Vector3f sensor_up = Eigen::Vector3f::UnitZ();     ///< the sensor's z axis, unit length
    std::vector<SensorRays> sensors;  ///< of a joined cloud; `sensor_origin` is in their middle. Empty: one sensor

    std::size_t size() const { return xyz.size(); }
    bool empty() const { return xyz.empty(); }

    /// Number of the sensor of return i, from 0.
    std::size_t sensorOf(std::int32_t i) const {
        std::size_t s = 0;
        while (s + 1 < sensors.size() && i >= sensors[s].end) ++s;
        return s;
    }
    /// Where the ray of return i starts [m].
    const Eigen::Vector3f& originOf(std::int32_t i) const {
        return sensors.empty() ? sensor_origin : sensors[sensorOf(i)].origin;
    }
    /// All sensors; the one there is where the cloud was not joined.
    std::vector<SensorRays> allSensors() const {
        if (!sensors.empty()) return sensors;
        return {{sensor_origin, sensor_up, static_cast<std::int32_t>(size()), view.rings}};
    }
    /// The rings of the sensor that a ring belongs to: from this one, up to before endRing().
    int firstRing(int of_ring) const {
        int first = 0;
        for (const SensorRays& s : sensors) first = of_ring >= s.end_ring ? s.end_ring : first;
        return first;
    }
    int endRing(int of_ring) const {
        for (const SensorRays& s : sensors)
            if (of_ring < s.end_ring) return s.end_ring;
        return view.rings;
    }
    /// Where the rays of a ring start [m].
    const Eigen::Vector3f& originOfRing(int of_ring) const {
        for (const SensorRays& s : sensors)
            if (of_ring < s.end_ring) return s.origin;
        return sensor_origin;
    }
};

/// z = offset + slope . (x, y): one patch of ground.
struct GroundPlane {
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    double offset = 0.0;
    int support = 0;  ///< seed returns it was fitted to; 0: borrowed from a neighbour

    double heightAt(double x, double y) const { return offset + slope.x() * x + slope.y() * y; }
};

enum class GroundEvidence : std::uint8_t { None, Weak, Good };

/// The ground under one scan: one plane per azimuth sector and range band, and their mean normal.
/// `evidence == None`: no plane could be supported; nothing is labelled ground and the planes lie where the
/// vehicle frame has z = 0 (a hint, not a finding).
struct GroundModel {
    GroundEvidence evidence = GroundEvidence::None;
    std::vector<GroundPlane> planes;  ///< sectors x bands; empty means z = 0
    int sectors = 0;                  ///< azimuth sectors, counted counter-clockwise from -pi
    std::vector<double> band_limits;  ///< outer horizontal range of each band but the last [m], rising
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< mean normal, weighted by support, unit length
    Eigen::Vector2d center = Eigen::Vector2d::Zero();   ///< sectors and ranges are counted from here (the sensor)
    std::vector<std::uint8_t> is_ground;                ///< one label per return
    std::vector<float> height;                          ///< height of each return above the local ground [m]

    /// z of the ground at (x, y) [m].
    double heightAt(double x, double y) const;
};

enum class CellState : std::uint8_t { Unknown = 0, Free = 1, Occupied = 2 };

/// 2D occupancy grid on the ground plane; cell (col, row) as drawn above has the number row * width + col. Only what
/// was seen is listed, so that work follows the occupied area and not the size of the grid; `stateImage`
/// (grid_image.h) draws all cells.
struct OccupancyGrid {
    Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower-left corner [m]
    double resolution = 0.0;                           ///< cell size [m]
    int width = 0;                                     ///< columns
    int height = 0;                                    ///< rows
    std::vector<std::int32_t> occupied;                ///< numbers of the occupied cells, rising
    std::vector<std::int32_t> free;                    ///< of the free ones, may repeat; occupied wins over free
    std::vector<std::int32_t> place_of_candidate;      ///< place in `occupied` of each candidate's cell; -1: not there

    bool empty() const { return width == 0 || height == 0; }
    /// Cell that holds (x, y), by floor; false where it lies outside.
    bool cellAt(double x, double y, int& col, int& row) const;
    Eigen::Vector2d cellCenter(int col, int row) const {
        return origin + resolution * Eigen::Vector2d(col + 0.5, row + 0.5);
    }
    Eigen::Vector2d cellCenter(std::int32_t cell) const { return cellCenter(cell % width, cell / width); }
};

/// What an obstacle is. `Structure` stands and is no road user: walls, vegetation, poles, rails. `Unknown` is compact,
/// but not to be told.
enum class ObstacleClass : std::uint8_t { Unknown, Vehicle, Pedestrian, Cyclist, Structure };

/// How probable it is that an object is of each class; sums to 1. Places are those of ObstacleClass.
using ClassProbabilities = std::array<float, 5>;

/// A connected component of occupied cells: the returns that fell into them.
struct Cluster {
    std::vector<std::int32_t> points;            ///< indices into the cloud
    float bottom = 0.0f;                         ///< height of the lowest return above the ground [m]
    float top = 0.0f;                            ///< of the highest, followed upwards beyond the region's limit [m]
    float max_top = 0.0f;                        ///< where the next plane passed above it [m]; infinite if none did
    ObstacleClass cls = ObstacleClass::Unknown;  ///< the most probable one
    ClassProbabilities probability{};            ///< all zero where nobody asked
    std::vector<Eigen::Vector2f> cells;  ///< centres of its cells [m]; set where a hull is to be fitted (addCells)
};

/// Why a cluster did not become a candidate for a road user.
enum class RejectReason : std::uint8_t { TooFewPoints, TooSmall, TooLow, TooLarge, Floating };

struct RejectedCluster {
    Cluster cluster;
    RejectReason reason = RejectReason::TooFewPoints;
    double measured = 0.0;  ///< what was measured against `limit`
    double limit = 0.0;
};

/// What the recognizer tells apart: the five classes as whole objects, and what is no whole object.
enum class Category : std::uint8_t {
    Unknown,
    Vehicle,
    Pedestrian,
    Cyclist,
    Structure,
    VehiclePart,  ///< of a vehicle of which more was seen
    PersonPart,   ///< of a person or rider
    Mixture,      ///< more than one thing
    Count
};
constexpr std::size_t kCategories = static_cast<std::size_t>(Category::Count);
using CategoryProbabilities = std::array<float, kCategories>;

/// How a group fits what earlier scans let expect there: both cover the same returns or do not.
struct ExpectedMatch {
    int object = -1;               ///< which of the objects expected; -1: none
    int inside = 0;                ///< the group's returns in its box
    int in_box = 0;                ///< all returns in its box
    ClassProbabilities classes{};  ///< of that object
};

/// What may be one object: a piece, or two hypotheses joined (merge_tree.h).
struct Hypothesis {
    std::vector<std::int32_t> points;  ///< indices into the cloud
    std::array<int, 2> part{-1, -1};   ///< hypotheses that it is made of; -1: it is a piece
    int parent = -1;                   ///< hypothesis that it is part of; -1: none
    int pieces = 1;                    ///< that it is made of
    float gap = 0.0f;                  ///< between its parts, as the scan could resolve it [m]
    float next_gap = 10.0f;            ///< to the nearest other one [m]; 10 where none is within reach
    ExpectedMatch expected;            ///< from earlier scans
    CategoryProbabilities category{};  ///< what it is
    ClassProbabilities probability{};  ///< of its class: parts count for theirs, mixtures are unknown
    float whole = 0.0f;                ///< probability that it is one object, all of it and nothing else
    float cut = 0.0f;                  ///< returns in whole objects, if it and its parts are cut in the best way
    bool chosen = false;               ///< in the best cut: it became a group
};

/// What the grouping found: groups that get a box each; what small boxes follow: structure, and what is likely several
/// things; and what was sorted out: ground, what can be passed under, noise, each with its reason.
struct Clusters {
    std::vector<Cluster> accepted;
    std::vector<Cluster> structure;
    std::vector<RejectedCluster> rejected;
};

/// Upright box: `size` = (length along yaw, width, height); length >= width where there is no heading.
struct OrientedBox {
    Eigen::Vector3d center = Eigen::Vector3d::Zero();
    Eigen::Vector3d size = Eigen::Vector3d::Zero();
    double yaw = 0.0;
};

/// What earlier scans let expect in this one: a track, where it should be by now.
struct ExpectedObject {
    OrientedBox box;   ///< vehicle frame [m]
    double std = 0.0;  ///< of its place [m]
    ClassProbabilities classes{};
};

/// What gave an obstacle its heading.
enum class HeadingRule : std::uint8_t {
    None,      ///< too small or too few returns
    Plane,     ///< vertical plane(s) through its returns (Sec. III)
    TwoSides,  ///< triangle A, B, C of the convex hull of its cells (Sec. IV)
    Line       ///< RANSAC line through its cells (Sec. IV)
};

/// Faces of a box, as bits.
enum Face : std::uint8_t { kFront = 1, kBack = 2, kLeft = 4, kRight = 8 };

/// What a tracker knows of an obstacle beyond this scan (tracking.h).
struct TrackState {
    double age = 0.0;  ///< since the track began, up to its last sight [s]; 0: seen once, or not yet sure
    bool seen = true;  ///< false: predicted, no box of this scan belongs to it
    std::optional<Eigen::Vector2d> velocity;  ///< over ground, vehicle axes [m/s]; not set where it is not known
    Eigen::Vector2d velocity_std = Eigen::Vector2d::Zero();  ///< [m/s]
    Eigen::Vector2d center_std = Eigen::Vector2d::Zero();    ///< of the box's centre, vehicle axes [m]
    double yaw_std = 0.0;                                    ///< [rad]
    bool moving = false;
    bool direction_known = false;  ///< true: `yaw` is where its front points; false: modulo 180 degrees
    double time_offset = 0.0;      ///< the box is as of this long after the scan's timestamp [s]
};

struct Obstacle {
    int id = 0;
    ObstacleClass cls = ObstacleClass::Unknown;
    ClassProbabilities probability{};  ///< of the classes; all zero where they were told by size
    OrientedBox box;
    OrientedBox seen_box;        ///< without what completion added
    bool heading_valid = false;  ///< false: `box.yaw` only says how the box is drawn
    double heading_std = 0.0;    ///< standard deviation of the heading from the face fit [rad]; 0 if not valid
    int num_points = 0;
    int num_rings = 0;                     ///< planes that hit it; 0 where the source has no rings
    double max_height = 0.0;               ///< box.size.z() is what was hit; it may be as high as this [m]
    HeadingRule rule = HeadingRule::None;  ///< what gave the heading
    std::uint8_t faces = 0;                ///< Face bits: those with returns on them
    std::vector<Eigen::Vector2d> hull;     ///< convex hull of its cells [m], where one was made
    std::vector<Eigen::Vector2d> marks;    ///< TwoSides: A, B, C, D; Line, Plane: both ends of it [m]
    std::vector<std::int32_t> points;      ///< its returns (indices into the cloud)
    std::optional<TrackState> track;       ///< set by a tracker; `id` is the track's then
};

/// Wall time of one stage of a run [ms].
struct StageTime {
    const char* stage = "";
    double ms = 0.0;
};

/// Every intermediate of one run: nothing is dropped without a trace.
struct DetectionResult {
    GroundModel ground;
    std::vector<std::int32_t> candidates;  ///< returns that may be obstacles (above ground, inside the region)
    std::vector<std::int32_t> filtered;    ///< those that the 3D filter took out of them
    OccupancyGrid grid;
    std::vector<Cluster> pieces;         ///< connected components of the grid (Fig. 2)
    std::vector<Hypothesis> hypotheses;  ///< pieces and what may be made of them, with their scores
    Clusters clusters;
    std::vector<Obstacle> obstacles;
    std::vector<StageTime> timing;
};

/// Throws std::invalid_argument if a coordinate is not finite (or beyond 100 km), the per-return vectors do not fit
/// each other, the view names rings, columns or returns that do not exist, or the sensors do not share all of them.
void validate(const PointCloud& cloud);

/// "vehicle", "pedestrian", "cyclist", "structure" or "unknown".
const char* toString(ObstacleClass c);
/// "too_few_points", "too_small", "too_low", "too_large" or "floating".
const char* toString(RejectReason r);
/// "none", "plane", "two_sides" or "line".
const char* toString(HeadingRule r);
/// Letters of the faces: F(ront), B(ack), L(eft), R(ight), in this order; "-" for none.
std::string facesText(std::uint8_t faces);
/// "none", "weak" or "good".
const char* toString(GroundEvidence e);
/// Into [-pi, pi).
double normalizeAngle(double rad);

}  // namespace lidar_obstacles
