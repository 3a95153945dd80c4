// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/row_elevations.h"

#include <cctype>
#include <cstdint>
#include <map>

#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"

namespace lidar_obstacles {
namespace {

/// Letters and figures of a name, in lower case.
std::string plainName(const std::string& name) {
    std::string plain;
    for (const char c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0)
            plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return plain;
}

/// Rows from one elevation on in even steps [deg].
ImageRows evenRows(int rows, double first, double step) {
    ImageRows even;
    for (int row = 0; row < rows; ++row) {
        mrpt::obs::VelodyneCalibration::PerLaserCalib laser{};
        setElevation(laser, first + step * row);
        even.lasers.laser_corrections.push_back(laser);
    }
    return even;
}

std::map<std::string, ImageRows> knownModels() {
    std::map<std::string, ImageRows> known;
    using Name = std::pair<const char*, std::uint8_t>;
    for (const auto& [name, kind] :
         {Name("vlp16", 0x22), Name("puck", 0x22), Name("pucklite", 0x22), Name("puckhires", 0x24),
          Name("hdl32e", 0x21), Name("hdl32", 0x21), Name("vlp32c", 0x28), Name("ultrapuck", 0x28)})
        for (const char* maker : {"", "velodyne"}) known[std::string(maker) + name] = {*calibrationOf(kind), true};
    for (const char* name : {"rslidar16", "robosenserslidar16", "rs16", "robosensers16", "helios16", "rshelios16"})
        known[name] = evenRows(16, -15.0, 2.0);
    for (const char* maker : {"", "hesai", "pandar", "hesaipandar"}) {
        known[std::string(maker) + "xt16"] = evenRows(16, 15.0, -2.0);
        known[std::string(maker) + "xt32"] = evenRows(32, 15.0, -1.0);
    }
    return known;
}

}  // namespace

const ImageRows* imageRows(const std::string& model) {
    static const std::map<std::string, ImageRows> known = knownModels();
    const auto found = known.find(plainName(model));
    return found == known.end() ? nullptr : &found->second;
}

std::string modelsOfRows() {
    return R"("VLP-16", "Puck Hi-Res", "VLP-32C", "HDL-32E", "RS-LiDAR-16", "RS-Helios-16", "XT16" and "XT32")";
}

}  // namespace lidar_obstacles
