// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A scenario as data: the track, what drives and stands on it, the sensor.
///
/// Places are told along the track: `s` metres from its start along the middle line, `d` metres to the left of it.
/// Angles are radians here and degrees in the files; a yaw is counter-clockwise from the direction of the track.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "lidar_obstacles/simulation/clutter_spec.h"
#include "lidar_obstacles/simulation/curve.h"
#include "lidar_obstacles/simulation/material.h"

namespace lidar_obstacles::simulation {

/// A scenario that cannot be right. The message names file, line, key, and what was expected.
class ScenarioError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Rotations apply as yaw, then pitch (nose down), then roll (left side up), as MRPT's.
struct Pose6 {
    Eigen::Vector3d position = Eigen::Vector3d::Zero();
    double yaw = 0.0;
    double pitch = 0.0;
    double roll = 0.0;
};

struct TrackSegment {
    double length;  ///< [m]
    double turn;    ///< to the left, over the length
};

struct TrackSpec {
    bool closed = false;      ///< the end is the start
    double width = 10.0;      ///< of the pavement [m]
    double heading = 0.0;     ///< at the start
    double transition = 6.0;  ///< length over which curvature changes [m]
    std::vector<TrackSegment> segments;
    Curve elevation;  ///< z of the middle line over s
    Curve bank;       ///< left side up, over s
};

struct TerrainSpec {
    double reach = 60.0;                ///< to either side of the track [m]
    double cell = 2.0;                  ///< of the mesh [m]
    double roughness = 0.0;             ///< of the ground off the pavement, amplitude [m]
    Curve verge;                        ///< height beside the pavement over the distance from its edge
    Material beside = Material::Grass;  ///< off the pavement
};

/// A rotating lidar as the VLP-16.
struct SensorSpec {
    std::string label = "velodyne";
    int planes = 16;                 ///< of a VLP-16: 16; 8 or 4: the other lasers are silent; 0: all there are
    std::vector<double> elevations;  ///< of another sensor's lasers, see elevationsOf(); empty: a VLP-16
    double rate = 10.0;              ///< turns per second
    Pose6 pose;                      ///< on the vehicle, as the recording tells it
    Pose6 mount_error;               ///< what the recording does not know: the true pose is pose * mount_error
    double range_noise = 0.015;      ///< standard deviation [m]
    double laser_bias = 0.0;   ///< standard deviation of what a laser measures too long or short, always the same [m]
    double min_range = 0.4;    ///< [m]
    double max_range = 100.0;  ///< [m]
    double rain = 0.0;         ///< share of the shots that a drop or dust sends back
    double dropout = 0.0;      ///< share of the shots that are lost, whatever they meet
};

struct Waypoint {
    double t, s, d;
};

/// Fixed to the ground.
struct Standing {
    double s = 0.0, d = 0.0, yaw = 0.0;
};
/// Smoothly through way-points, facing where it goes; standing before the first and after the last.
struct Moving {
    std::vector<Waypoint> waypoints;
    bool follows_ego = false;  ///< the s of the way-points count from the vehicle's own
};
/// One pose per scan, around a vehicle that stands: the nearest point of the box at each of the ranges, in each of
/// the bearings (from the direction of the track), the object turned to each of the yaws.
struct Gridded {
    std::vector<double> ranges, bearings, yaws;

    std::size_t poses() const { return ranges.size() * bearings.size() * yaws.size(); }
};

struct ObjectSpec {
    std::string model;  ///< see modelNames()
    std::variant<Standing, Moving, Gridded> motion;
    std::uint64_t variant = 0;  ///< makes objects of a model differ in size, paint, clothes; 0: as drawn
};

struct EgoSpec {
    std::vector<Waypoint> waypoints;
    double wheelbase = 2.7;  ///< [m]
    double gauge = 1.5;      ///< [m]
};

struct Scenario {
    double duration = 0.0;  ///< [s]; 0: as long as the largest grid has poses
    TrackSpec track;
    TerrainSpec terrain;
    SensorSpec sensor;
    std::vector<SensorSpec> more_sensors;  ///< beside it, of the same rate; each with a label of its own
    EgoSpec ego;
    std::vector<ObjectSpec> objects;  ///< object_id 1, 2 ... in this order
    std::vector<ClutterSpec> clutter;
};

/// How long the scenario takes [s].
double durationOf(const Scenario& scenario);

/// Reads a YAML file. Strict: unknown or repeated keys, missing and bad values are errors.
/// @throws ScenarioError
Scenario loadScenario(const std::string& path);

/// The same from text; `name` stands for the file in messages. @throws ScenarioError
Scenario parseScenario(const std::string& text, const std::string& name);

}  // namespace lidar_obstacles::simulation
