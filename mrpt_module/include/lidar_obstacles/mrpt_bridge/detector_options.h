// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parameters as MRPT's programs load, save and show their options.
#pragma once

#include <mrpt/config/CLoadableOptions.h>

#include "lidar_obstacles/mrpt_bridge/config_file.h"

namespace lidar_obstacles {

/// DetectorParams in a config file that other parts of a program use too, e.g.
///
///     DetectorOptions options;
///     options.loadFromConfigFileName("robot.ini", "front_lidar");   // [front_lidar]
///     ObstacleDetector detector(options.params);                    // grid.resolution = 0.1 ...
///
/// A section's keys are named as in `--set`: the section of config.ini, a dot, the key. With an empty section name the
/// sections are those of config.ini itself. A key that is not there keeps its value, as with all of MRPT's options;
/// what is there is read as strictly as by loadParams(). MRPT reads the file, so its variables work, a key that is
/// there twice is not noticed, and errors name no line.
struct DetectorOptions : public mrpt::config::CLoadableOptions {
    DetectorParams params;

    /// @throws ConfigError if the section is not there, holds an unknown key (the message offers the nearest one) or a
    ///     value that is bad or out of range, or if the values do not go together; `params` is unchanged then. With an
    ///     empty section name, other sections of the file are passed over.
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source, const std::string& section) override;

    /// Writes all parameters, each with its meaning; what is read back is the same, bit for bit.
    void saveToConfigFile(mrpt::config::CConfigFileBase& target, const std::string& section) const override;

    /// The text of a config.ini with these values (dumpParams()).
    void dumpToTextStream(std::ostream& out) const override;
};

}  // namespace lidar_obstacles
