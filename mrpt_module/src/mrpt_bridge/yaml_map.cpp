// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/yaml_map.h"

#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <utility>

#include "scan/place_text.h"

namespace lidar_obstacles {
namespace {

std::string listed(const std::set<std::string>& words) {
    std::string list;
    for (const std::string& w : words) list += (list.empty() ? "" : ", ") + w;
    return list;
}

std::string lineOf(const YAML::Node& node) {
    const YAML::Mark mark = node.Mark();
    return mark.is_null() ? "" : ":" + std::to_string(mark.line + 1);
}

}  // namespace

YamlMap::YamlMap(const YAML::Node& node, std::string path, std::string file)
    : node_(node), path_(std::move(path)), file_(std::move(file)) {
    if (!node_.IsMap()) failAt(node_, "", "must be a mapping (key: value)");
    std::set<std::string> seen;
    for (const auto& entry : node_) {
        if (!entry.first.IsScalar()) failAt(entry.first, "", "keys must be words");
        const std::string& key = entry.first.Scalar();
        if (!seen.insert(key).second) failAt(entry.first, key, "stands here twice");
    }
}

std::string YamlMap::nameOf(const std::string& key) const {
    if (path_.empty() || key.empty()) return path_ + key;
    return path_ + "." + key;
}

void YamlMap::failAt(const YAML::Node& node, const std::string& key, const std::string& message) const {
    const std::string name = nameOf(key);
    throw YamlError(file_ + lineOf(node) + ": " + (name.empty() ? "" : name + ": ") + message);
}

void YamlMap::fail(const std::string& key, const std::string& message) const {
    failAt(!key.empty() && has(key) ? node_[key] : node_, key, message);
}

YAML::Node YamlMap::child(const std::string& key) {
    known_.insert(key);
    if (!has(key)) fail(key, "is missing");
    return node_[key];
}

std::vector<YAML::Node> YamlMap::children(const std::string& key) {
    const YAML::Node node = child(key);
    if (!node.IsSequence()) return {node};
    std::vector<YAML::Node> list(node.begin(), node.end());
    if (list.empty()) fail(key, "must not be empty");
    return list;
}

double YamlMap::toNumber(const YAML::Node& node, const std::string& key, Range range) const {
    const std::string expected = "must be a number from " + numberText(range.low) + " to " + numberText(range.high);
    if (!node.IsScalar()) failAt(node, key, expected);
    const std::string& word = node.Scalar();
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
        failAt(node, key, expected + ", not '" + word + "'");
    if (value < range.low || value > range.high) failAt(node, key, expected + ", not " + word);
    return value;
}

std::string YamlMap::toText(const YAML::Node& node, const std::string& key) const {
    if (!node.IsScalar() || node.Scalar().empty()) failAt(node, key, "must be a word");
    return node.Scalar();
}

double YamlMap::number(const std::string& key, Range range) { return toNumber(child(key), key, range); }

double YamlMap::number(const std::string& key, Range range, double fallback) {
    known_.insert(key);
    return has(key) ? number(key, range) : fallback;
}

std::vector<double> YamlMap::numbers(const std::string& key, Range range) {
    std::vector<double> values;
    for (const YAML::Node& node : children(key)) values.push_back(toNumber(node, key, range));
    return values;
}

bool YamlMap::flag(const std::string& key, bool fallback) {
    known_.insert(key);
    if (!has(key)) return fallback;
    const std::string word = text(key);
    if (word != "true" && word != "false") fail(key, "must be true or false, not '" + word + "'");
    return word == "true";
}

std::string YamlMap::text(const std::string& key) { return toText(child(key), key); }

std::string YamlMap::text(const std::string& key, const std::string& fallback) {
    known_.insert(key);
    return has(key) ? text(key) : fallback;
}

std::vector<std::string> YamlMap::texts(const std::string& key) {
    std::vector<std::string> words;
    for (const YAML::Node& node : children(key)) words.push_back(toText(node, key));
    return words;
}

YamlMap YamlMap::map(const std::string& key) { return {child(key), nameOf(key), file_}; }

std::vector<YamlMap> YamlMap::maps(const std::string& key) {
    const YAML::Node list = child(key);
    if (!list.IsSequence()) fail(key, "must be a list");
    std::vector<YamlMap> result;
    for (std::size_t i = 0; i < list.size(); ++i)
        result.emplace_back(list[i], nameOf(key) + "[" + std::to_string(i) + "]", file_);
    return result;
}

std::vector<std::pair<double, double>> YamlMap::pairs(const std::string& key, Range range) {
    const YAML::Node list = child(key);
    const std::string expected = "must be a list of pairs of numbers, [[x, y], [x, y]]";
    if (!list.IsSequence()) failAt(list, key, expected);
    std::vector<std::pair<double, double>> result;
    for (const YAML::Node& pair : list) {
        if (!pair.IsSequence() || pair.size() != 2) failAt(pair, key, expected);
        result.emplace_back(toNumber(pair[0], key, range), toNumber(pair[1], key, range));
    }
    return result;
}

void YamlMap::finish() const {
    for (const auto& entry : node_) {
        const std::string& key = entry.first.Scalar();
        if (known_.count(key) == 0) failAt(entry.first, key, "unknown key; here are known: " + listed(known_));
    }
}

YamlMap parseYaml(const std::string& text, const std::string& name) {
    try {
        return {YAML::Load(text), "", name};
    } catch (const YAML::ParserException& e) {
        throw YamlError(name + ":" + std::to_string(e.mark.line + 1) + ": not YAML: " + e.msg);
    } catch (const YAML::Exception& e) {
        throw YamlError(name + ": " + e.what());
    }
}

YamlMap loadYaml(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    if (!in) throw YamlError(path + ": cannot read");
    return parseYaml(text, path);
}

}  // namespace lidar_obstacles
