// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Zones from a YAML file.
#pragma once

#include <stdexcept>
#include <string>

#include "lidar_obstacles/zones.h"

namespace lidar_obstacles {

/// A file of zones that cannot be right. The message names file, line, key, and what was expected.
class ZonesFileError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Reads a file, see docs/zones.md. Strict: unknown or repeated keys, missing and bad values, polygons whose sides
/// cross, two zones of a name are errors. @throws ZonesFileError
ZoneSet loadZones(const std::string& path);

/// The same from text; `name` stands for the file in messages. @throws ZonesFileError
ZoneSet parseZones(const std::string& text, const std::string& name);

/// The text of a file that reads back as the same zones; keys that are as usual are left out.
std::string zonesText(const ZoneSet& set);

}  // namespace lidar_obstacles
