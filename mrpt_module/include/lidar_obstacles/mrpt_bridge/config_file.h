// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// config.ini <-> DetectorParams, strictly: whatever is not exactly right is an error that says where and why.
///
/// Syntax: `[section]` and `key = value` lines; sections and keys in any case; `#`, `;` or `//` starts a comment, on
/// a line of its own or after a value. A file names every parameter once. No variables, no includes.
#pragma once

#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "lidar_obstacles/params.h"

namespace lidar_obstacles {

/// A config file or an assignment that is not right. `what()` reads `config.ini:12: [grid] resolution = 0,2: not a
/// number (0.02 .. 2 m)`: file, line, section, key, value and what is wrong with it, as far as each applies.
class ConfigError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Reads all parameters from a config file.
///
/// @throws ConfigError if the file cannot be read, is no ini file, names an unknown section or key (the message
///     offers the nearest known one), holds a bad or out-of-range value, names a key twice or leaves one out (a
///     default is never taken silently), or if the values do not go together (validate()).
DetectorParams loadParams(const std::string& file);

/// The same from a text in memory; `name` stands for the file in messages.
DetectorParams parseParams(const std::string& text, const std::string& name);

/// Changes one parameter: "section.key=value", as strict as the file. Whether the values go together is not looked
/// at: call validate() after the last change.
///
/// @throws ConfigError; `params` is unchanged then.
void setParam(DetectorParams& params, const std::string& assignment);

/// The text of a config file with these values: every key with its meaning, unit, range or choices, default and
/// section of the paper. `parseParams(dumpParams(p), "")` gives `p` back, bit for bit.
std::string dumpParams(const DetectorParams& params);

/// The name nearest to a misspelt word, if it is near enough to be meant; "" if none is.
std::string nearestName(const std::string& word, const std::vector<std::string>& names);

/// One parameter as plain data; an enumeration as its word.
struct ParamValue {
    std::string section;
    std::string key;
    std::variant<bool, int, double, std::string> value;
};

/// All parameters in the order of the config file, e.g. for a report of a run.
std::vector<ParamValue> listParams(const DetectorParams& params);

}  // namespace lidar_obstacles
