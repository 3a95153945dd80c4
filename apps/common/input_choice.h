/// @file
/// What the user says of an input besides its name, the same in all tools that read scans.
#pragma once

#include <mrpt/poses/CPose3D.h>

#include <memory>
#include <optional>
#include <string>

#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace CLI {
class App;
}

namespace lidar_obstacles::apps {

struct InputChoice {
    std::optional<std::string> sensor_label;          ///< name of the lidar; none: there has to be one only
    std::optional<mrpt::poses::CPose3D> sensor_pose;  ///< on the vehicle, whatever the input says
    InputOptions options;
};

/// Adds --sensor-label, --sensor-pose, --port, --source and --sensor-model. The choice has to outlive the parsing.
void addInputChoice(CLI::App& app, InputChoice& choice);

/// "X,Y,Z,YAW,PITCH,ROLL" in metres and degrees. @throws UsageError naming the option.
mrpt::poses::CPose3D readPose(const std::string& option, const std::string& words);

/// Opens the input; scans of the chosen lidar (of all, if none is chosen) get the chosen pose.
/// @throws as openScanSource.
std::unique_ptr<ScanSource> openInput(const std::string& input, const InputChoice& choice);

/// "no lidar scans in it", and what the source says of what it left out.
std::string noScansIn(const std::string& input, const ScanSource& source);

}  // namespace lidar_obstacles::apps
