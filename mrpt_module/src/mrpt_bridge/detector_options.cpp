// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/detector_options.h"

#include <mrpt/config/CConfigFileBase.h>

#include <ostream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "lidar_obstacles/params_list.h"
#include "mrpt_bridge/config_values.h"

namespace lidar_obstacles {

using namespace detail;

namespace {

using mrpt::config::CConfigFileBase;

/// What stands behind a value: MRPT takes off what begins with `//`.
std::string valueOf(const CConfigFileBase& source, const std::string& section, const std::string& key) {
    const std::string text = source.read_string(section, key, "");
    return std::string(trim(std::string_view(text).substr(0, text.find_first_of("#;"))));
}

/// The sections of a file that this one means.
std::vector<std::string> sectionsOf(const CConfigFileBase& source, const std::string& section) {
    std::vector<std::string> all, ours;
    source.getAllSections(all);
    std::set<std::string> known;
    const DetectorParams params;
    forEachParam(params, [&](const ParamInfo& info, const auto&) { known.insert(info.section); });
    for (const std::string& name : all)
        if (section.empty() ? known.count(lower(name)) > 0 : lower(name) == lower(section)) ours.push_back(name);
    if (!ours.empty()) return ours;
    throw ConfigError(section.empty() ? "no section of lidar_obstacles in the config file"
                                      : "no section [" + section + "] in the config file");
}

/// An error with the section that it is in; that of config.ini stands in the text.
ConfigError placed(const std::string& section, const std::string& text) {
    return ConfigError(section.empty() ? text : "in section [" + section + "]: " + text);
}

/// Reads what stands in one section of the file. @param section  as it was asked for.
void readKeys(const CConfigFileBase& source, const std::string& section, const std::string& name,
              DetectorParams& params) {
    std::vector<std::string> keys;
    source.getAllKeys(name, keys);
    for (const std::string& key : keys) {
        const std::string path = section.empty() ? name + "." + key : key;
        try {
            setParam(params, path + "=" + valueOf(source, name, key));
        } catch (const ConfigError& e) {
            throw placed(section, e.what());
        }
    }
}

}  // namespace

void DetectorOptions::loadFromConfigFile(const CConfigFileBase& source, const std::string& section) {
    DetectorParams read = params;
    for (const std::string& name : sectionsOf(source, section)) readKeys(source, section, name, read);
    try {
        validate(read);
    } catch (const std::invalid_argument& e) {
        throw placed(section, e.what());
    }
    params = read;
}

void DetectorOptions::saveToConfigFile(CConfigFileBase& target, const std::string& section) const {
    forEachParam(params, [&](const ParamInfo& info, const auto& value) {
        const std::string in = section.empty() ? info.section : section;
        const std::string key = section.empty() ? info.key : std::string(info.section) + "." + info.key;
        target.write(in, key, toText(value), -1, -1, info.text);
    });
}

void DetectorOptions::dumpToTextStream(std::ostream& out) const { out << dumpParams(params); }

}  // namespace lidar_obstacles
