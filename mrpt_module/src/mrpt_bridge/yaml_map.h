// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Strict reading of YAML: every key is asked for or is an error, every error says where.
#pragma once

#include <yaml-cpp/yaml.h>

#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lidar_obstacles {

/// A file that cannot be right. The message names file, line, key, and what was expected.
class YamlError : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/// Allowed numbers, both ends included.
struct Range {
    double low;
    double high;
};

/// A mapping of a file. `path` is what messages call it: "objects[2].path".
class YamlMap {
  public:
    /// @throws YamlError if the node is no mapping or repeats a key.
    YamlMap(const YAML::Node& node, std::string path, std::string file);

    bool has(const std::string& key) const { return static_cast<bool>(node_[key]); }
    double number(const std::string& key, Range range);  ///< required
    double number(const std::string& key, Range range, double fallback);
    std::vector<double> numbers(const std::string& key, Range range);  ///< one number or a list
    bool flag(const std::string& key, bool fallback);
    std::string text(const std::string& key);
    std::string text(const std::string& key, const std::string& fallback);
    std::vector<std::string> texts(const std::string& key);  ///< one word or a list
    YamlMap map(const std::string& key);
    std::vector<YamlMap> maps(const std::string& key);  ///< a list of mappings
    /// A list of pairs of numbers, [[1, 2], [3, 4]].
    std::vector<std::pair<double, double>> pairs(const std::string& key, Range range);

    /// @throws YamlError if a key was never asked for.
    void finish() const;
    /// For what only the caller knows to be wrong; `key` may be empty.
    [[noreturn]] void fail(const std::string& key, const std::string& message) const;

  private:
    YAML::Node child(const std::string& key);
    std::vector<YAML::Node> children(const std::string& key);
    std::string nameOf(const std::string& key) const;
    double toNumber(const YAML::Node& node, const std::string& key, Range range) const;
    std::string toText(const YAML::Node& node, const std::string& key) const;
    [[noreturn]] void failAt(const YAML::Node& node, const std::string& key, const std::string& message) const;

    YAML::Node node_;
    std::string path_;
    std::string file_;
    std::set<std::string> known_;
};

/// The mapping that a file is. @throws YamlError if it cannot be read, or is no YAML or no mapping.
YamlMap loadYaml(const std::string& path);
/// The same from text; `name` stands for the file in messages.
YamlMap parseYaml(const std::string& text, const std::string& name);

}  // namespace lidar_obstacles
