// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Ground truth as it stands in CSV files: labelled objects, static clutter, the vehicle's poses.
///
/// All readers are strict: a column that is missing or named twice, a row with another number of cells, a cell that is
/// not what its column holds are a CsvError that names file, line, column and what was expected. Columns are found by
/// their names; further ones are allowed.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::evaluation {

/// A CSV file that is not right. `what()` reads `drive_gt.csv:12: x: 'abc' is not a number`.
class CsvError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// What metrics are told for; a type that is none of these is Other and never asked for.
enum class Group : std::uint8_t { Vehicle, Pedestrian, Cyclist, Other };

constexpr std::array<Group, 3> kGroups = {Group::Vehicle, Group::Pedestrian, Group::Cyclist};

/// "vehicle", "pedestrian", "cyclist" or "other".
const char* toString(Group group);

/// The group of a type of the truth ("van", "car", "truck", "person", "rider" ...) or of a class of a detection, in
/// lower case.
Group groupOf(const std::string& type);

/// The class whose boxes a group is of; of Other: Unknown.
ObstacleClass classOf(Group group);

/// Which pose of an object a detection is held against.
enum class TruthPose : std::uint8_t {
    Reference,    ///< at the scan's timestamp: for a tracker that predicts to it
    MidScan,      ///< columns x_mid ...
    Observed,     ///< columns x_obs ...: when the laser saw it, told in the vehicle frame of that instant
    EgoCorrected  ///< the same instant, told in the vehicle frame of the timestamp: for detections that undo ego motion
};

/// One labelled object in one scan; vehicle frame.
struct TruthObject {
    double timestamp = 0.0;  ///< of the scan [s]
    int scan_index = 0;
    std::string object_id;
    std::string type;  ///< lower case
    Group group = Group::Other;
    OrientedBox box;                     ///< NaN where the set has no pose of an object without returns
    Eigen::Vector2d velocity{0.0, 0.0};  ///< over ground, vehicle axes [m/s]; NaN where the set does not tell
    int num_points = 0;                  ///< returns of the scan on it
    double range = 0.0;                  ///< from the vehicle's origin to its nearest point, seen from above [m]
    double occluded = 0.0;  ///< as the set tells it: a share (simulated) or a level 0 .. 3 (KITTI); 0: not told
};

/// Reads a `*_gt.csv`. A set without the columns of `pose` (KITTI has one pose per scan) gives its plain ones.
/// @param points_column  where num_points comes from; `num_points` where the set has no such column.
/// @throws CsvError; std::runtime_error naming the file if it cannot be read.
std::vector<TruthObject> readTruth(const std::string& file, TruthPose pose,
                                   const std::string& points_column = "num_points");

/// Something that stands and was not labelled as an object; world frame.
struct StaticBox {
    std::string type;  ///< e.g. "wall", "pole"; "overhead": bridges and signs above the road
    OrientedBox box;
};

/// Reads a `*_static.csv`. @throws as readTruth.
std::vector<StaticBox> readStaticBoxes(const std::string& file);

/// The vehicle in the world at a scan's timestamp.
struct EgoPose {
    double timestamp = 0.0;
    int scan_index = 0;
    Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< world frame [m]
    Eigen::Vector3d rpy = Eigen::Vector3d::Zero();       ///< roll, pitch, yaw [rad]
};

/// Reads a `*_ego.csv`: one row per scan. @throws as readTruth.
std::vector<EgoPose> readEgoPoses(const std::string& file);

/// The vehicle's velocity over ground in its own axes at each pose [m/s], from the poses before and after it; NaN where
/// these are more than a second away or have the same time.
/// @param poses  by time.
std::vector<Eigen::Vector2d> egoVelocities(const std::vector<EgoPose>& poses);

/// The static boxes whose centres lie within `reach` [m] of the vehicle, in its frame.
std::vector<StaticBox> staticBoxesNear(const std::vector<StaticBox>& boxes, const EgoPose& ego, double reach);

}  // namespace lidar_obstacles::evaluation
