// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the user says of an input besides its name, the same in all tools that read scans.
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace CLI {
class App;
}

namespace lidar_obstacles::apps {

struct InputChoice {
    std::optional<std::string> sensor_label;  ///< name of the lidar, or as JoinedLidars; none: there has to be one only
    /// On the vehicle, whatever the input says, by the name of the lidar; "": of all that are used.
    std::map<std::string, mrpt::poses::CPose3D> sensor_poses;
    /// The points of clouds (CObservationPointCloud) are in the vehicle's frame already: a pose only says where their
    /// rays start.
    bool points_in_vehicle = false;
    InputOptions options;

    /// True if several lidars are used as one.
    bool joins() const;
    /// Where a lidar is said to be; none: what the input says.
    std::optional<mrpt::poses::CPose3D> poseOf(const std::string& lidar) const;
};

/// Adds --sensor-label, --sensor-pose, --points-in-vehicle, --port, --source and --sensor-model. The choice has to
/// outlive the parsing.
void addInputChoice(CLI::App& app, InputChoice& choice);

constexpr double kFarthestSensor = 100.0;  ///< from the origin of the vehicle, along each axis [m]

/// "X,Y,Z,YAW,PITCH,ROLL" in metres and degrees. @throws UsageError naming the option, also where X, Y or Z is beyond
///     `farthest` [m] or an angle beyond 360 degrees.
mrpt::poses::CPose3D readPose(const std::string& option, const std::string& words, double farthest = kFarthestSensor);

/// Puts the sensor of a scan at a place of the vehicle. Its points move with it, or are there already: then they stay,
/// as far as the scan is a cloud of points.
void placeSensor(mrpt::obs::CObservation& scan, const mrpt::poses::CPose3D& T_vehicle_sensor, bool points_in_vehicle);

/// Opens the input; scans get the chosen poses, those of several lidars come joined.
/// @throws as openScanSource; UsageError if a lidar that was named is not in it, several are to be at one place, or
/// points in
///         the vehicle's frame have no place of their sensor.
std::unique_ptr<ScanSource> openInput(const std::string& input, const InputChoice& choice);

/// "'front' (120 scans), 'rear' (119 scans)", or "none".
std::string listLidars(const std::string& input, const InputOptions& options);

/// "no lidar scans in it", and what the source says of what it left out.
std::string noScansIn(const std::string& input, const ScanSource& source);

}  // namespace lidar_obstacles::apps
