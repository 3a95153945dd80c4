// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/config_file.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <numeric>
#include <optional>
#include <string_view>
#include <utility>

#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/params_list.h"
#include "lidar_obstacles/searched_place.h"
#include "mrpt_bridge/config_values.h"

namespace lidar_obstacles {

using namespace detail;

namespace {

constexpr std::size_t kMaxFileSize = 1 << 20;  // anything larger is no config file

std::string_view withoutComment(std::string_view line) {
    return line.substr(0, std::min({line.find('#'), line.find(';'), line.find("//")}));
}

/// Levenshtein distance.
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t substitute = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = std::exchange(row[j], std::min({substitute, row[j] + 1, row[j - 1] + 1}));
        }
    }
    return row[b.size()];
}

/// The known name nearest to a wrong one; of two equally near ones that of the section that was named.
std::string nearest(const std::string& section, const std::string& key) {
    std::string best;
    std::size_t best_distance = std::string::npos;
    const DetectorParams params;
    forEachParam(params, [&](const ParamInfo& info, const auto&) {
        const std::size_t distance = editDistance(key, info.key) + (section == info.section ? 0 : 1);
        if (distance >= best_distance) return;
        best_distance = distance;
        best = section == info.section ? info.key : std::string("[") + info.section + "] " + info.key;
    });
    return best;
}

std::string nearestSection(const std::string& section) {
    std::string best;
    std::size_t best_distance = std::string::npos;
    const DetectorParams params;
    forEachParam(params, [&](const ParamInfo& info, const auto&) {
        const std::size_t distance = editDistance(section, info.section);
        if (distance < best_distance) best_distance = distance, best = info.section;
    });
    return best;
}

bool isSection(const std::string& name) {
    bool found = false;
    const DetectorParams params;
    forEachParam(params, [&](const ParamInfo& info, const auto&) { found = found || name == info.section; });
    return found;
}

/// The text of places as it is kept. @throws std::invalid_argument
std::string placesText(const std::string& key, const std::string& text) {
    if (key == "excluded") return toText(ExcludedPlaces(text));
    return toText(key == "outline" ? searchedOutline(text) : OwnBody(text));
}

/// Places of the region as they are kept: the text of the file where one is named (@FILE), lines that begin with # left
/// out. @return what is wrong, if anything.
std::optional<std::string> settlePlaces(const std::string& key, std::string& value) {
    const std::string file = value.front() == '@' ? value.substr(1) : "";
    std::string text = value;
    if (!file.empty()) {
        std::ifstream in(file);
        if (!in) return file + ": cannot open";
        text.clear();
        for (std::string line; std::getline(in, line);)
            if (line.empty() || line.front() != '#') text += line + ' ';
    }
    try {
        value = placesText(key, text);
        return std::nullopt;
    } catch (const std::invalid_argument& e) {
        return (file.empty() ? "" : file + ": ") + e.what();
    }
}

/// Sets one parameter by its lower-case name; returns what is wrong, if anything.
std::optional<std::string> assign(DetectorParams& params, const std::string& section, const std::string& key,
                                  std::string_view value) {
    bool known = false;
    std::optional<std::string> problem;
    forEachParam(params, [&](const ParamInfo& info, auto& member) {
        if (section != info.section || key != info.key) return;
        known = true;
        auto read = member;
        problem = readValue(info, value, read);
        if constexpr (std::is_same_v<std::decay_t<decltype(member)>, std::string>)
            if (!problem && section == "region") problem = settlePlaces(key, read);  // all texts there are places
        if (!problem) member = std::move(read);
    });
    if (!known) problem = "unknown key; did you mean '" + nearest(section, key) + "'?";
    return problem;
}

/// Reads an ini text line by line.
class Parser {
  public:
    Parser(const std::string& text, std::string name) : text_(text), name_(std::move(name)) {}

    DetectorParams run() {
        std::string_view rest = text_;
        if (rest.substr(0, 3) == "\xEF\xBB\xBF") rest.remove_prefix(3);  // byte order mark
        while (!rest.empty()) {
            ++line_;
            const std::size_t end = std::min(rest.find('\n'), rest.size());
            readLine(trim(withoutComment(rest.substr(0, end))));
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
        requireAll();
        return params_;
    }

  private:
    [[noreturn]] void fail(const std::string& message) const {
        throw ConfigError(name_ + ":" + std::to_string(line_) + ": " + message);
    }

    void readLine(std::string_view line) {
        if (line.empty()) return;
        if (line.front() == '[') {
            if (line.back() != ']') fail(std::string(line) + ": section without ']'");
            section_ = lower(trim(line.substr(1, line.size() - 2)));
            if (!isSection(section_)) {
                fail(std::string(line) + ": unknown section; did you mean '[" + nearestSection(section_) + "]'?");
            }
            return;
        }
        const std::size_t equals = line.find('=');
        if (equals == std::string_view::npos) fail(std::string(line) + ": neither [section] nor key = value");
        readAssignment(trim(line.substr(0, equals)), trim(line.substr(equals + 1)));
    }

    void readAssignment(std::string_view name, std::string_view value) {
        const std::string what = std::string(name) + " = " + std::string(value) + ": ";
        if (name.empty()) fail(what + "no key before '='");
        if (section_.empty()) fail(what + "key before the first [section]");
        const std::string key = lower(name);
        const std::string place = "[" + section_ + "] " + what;
        const auto [first, is_new] = line_of_.try_emplace({section_, key}, line_);
        if (!is_new) fail(place + "key given twice, first in line " + std::to_string(first->second));
        if (const auto problem = assign(params_, section_, key, value)) fail(place + *problem);
    }

    void requireAll() const {
        std::string missing;
        forEachParam(params_, [&](const ParamInfo& info, const auto&) {
            if (line_of_.count({info.section, info.key})) return;
            missing += (missing.empty() ? "[" : ", [") + std::string(info.section) + "] " + info.key;
        });
        if (!missing.empty()) throw ConfigError(name_ + ": missing " + missing);
    }

    const std::string& text_;
    const std::string name_;
    DetectorParams params_;
    std::string section_;
    int line_ = 0;
    std::map<std::pair<std::string, std::string>, int> line_of_;
};

std::string readFile(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) throw ConfigError(file + ": cannot open the config file");
    std::string text(kMaxFileSize + 1, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (in.bad() || (in.fail() && !in.eof())) throw ConfigError(file + ": cannot read the config file");
    text.resize(static_cast<std::size_t>(in.gcount()));
    if (text.size() > kMaxFileSize) throw ConfigError(file + ": larger than 1 MiB, not a config file");
    return text;
}

/// The comment above a key in a config file.
template <class T>
std::string describe(const ParamInfo& info, const T& default_value) {
    std::string text =
        std::string("# ") + info.text + "\n#   " + allowed(info, default_value) + "; default " + toText(default_value);
    if (*info.source) text += std::string("; ") + info.source;
    return text + "\n";
}

}  // namespace

std::string nearestName(const std::string& word, const std::vector<std::string>& names) {
    std::string best;
    std::size_t best_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const std::string& name : names) {
        const std::size_t distance = editDistance(word, name);
        if (distance < best_distance) best_distance = distance, best = name;
    }
    return best;
}

DetectorParams parseParams(const std::string& text, const std::string& name) {
    const DetectorParams params = Parser(text, name).run();
    try {
        validate(params);
    } catch (const std::invalid_argument& e) {
        throw ConfigError(name + ": " + e.what());
    }
    return params;
}

DetectorParams loadParams(const std::string& file) { return parseParams(readFile(file), file); }

void setParam(DetectorParams& params, const std::string& assignment) {
    const std::size_t equals = assignment.find('=');
    const std::size_t dot = assignment.find('.');
    if (equals == std::string::npos || dot == std::string::npos || dot > equals) {
        throw ConfigError("'" + assignment + "': not of the form section.key=value");
    }
    const std::string_view text = assignment;
    const std::string section = lower(trim(text.substr(0, dot)));
    const std::string key = lower(trim(text.substr(dot + 1, equals - dot - 1)));
    const std::string_view value = trim(text.substr(equals + 1));
    const std::string place = "[" + section + "] " + key + " = " + std::string(value) + ": ";
    if (!isSection(section)) {
        throw ConfigError(place + "unknown section; did you mean '[" + nearestSection(section) + "]'?");
    }
    if (const auto problem = assign(params, section, key, value)) throw ConfigError(place + *problem);
}

std::string dumpParams(const DetectorParams& params) {
    std::map<std::pair<std::string, std::string>, std::string> comment;
    const DetectorParams defaults;
    forEachParam(defaults, [&](const ParamInfo& info, const auto& value) {
        comment[{info.section, info.key}] = describe(info, value);
    });
    std::string text = "# Parameters of lidar_obstacles. Written by `obstacle-replay --print-config`.\n";
    std::string section;
    forEachParam(params, [&](const ParamInfo& info, const auto& value) {
        if (section != info.section) text += std::string("\n[") + (section = info.section) + "]\n";
        text += comment[{info.section, info.key}] + info.key + " = " + toText(value) + "\n";
    });
    return text;
}

std::vector<ParamValue> listParams(const DetectorParams& params) {
    std::vector<ParamValue> list;
    forEachParam(params, [&](const ParamInfo& info, const auto& value) {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_enum_v<T>) {
            list.push_back({info.section, info.key, toText(value)});
        } else {
            list.push_back({info.section, info.key, value});
        }
    });
    return list;
}

}  // namespace lidar_obstacles
