// SPDX-License-Identifier: BSD-3-Clause
#include "param_panel.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <type_traits>

#include "common/number_text.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "lidar_obstacles/params_list.h"

namespace lidar_obstacles::apps {
namespace {

std::string nameOf(const ParamInfo& info) { return std::string(info.section) + "." + info.key; }

template <class T>
std::string valueText(T value) {
    if constexpr (std::is_same_v<T, bool>) {
        return value ? "true" : "false";
    } else if constexpr (std::is_enum_v<T>) {
        for (const auto& [word, known] : choices(T{}))
            if (known == value) return std::string(word);
        return "?";
    } else if constexpr (std::is_same_v<T, std::string>) {
        return value;
    } else {
        return shortestText(value);
    }
}

/// A tenth of the value, or a hundredth of the range where that is more, down to a power of ten.
double decimalStep(double value, const ParamInfo& info, bool coarse) {
    const double about = std::max(std::abs(value) / 10.0, info.max / 100.0);
    return std::pow(10.0, std::floor(std::log10(about) + 1e-9) + (coarse ? 1.0 : 0.0));
}

double stepped(double value, int direction, double step, const ParamInfo& info) {
    // whole steps, divided rather than multiplied below 1: 0.3 and not 0.30000000000000004
    const double steps = std::round(value / step + direction);
    const double next = step < 1.0 ? steps / std::round(1.0 / step) : steps * step;
    return std::clamp(next, info.min, info.max);
}

template <class T>
void change(T& value, const ParamInfo& info, int direction, bool coarse) {
    if constexpr (std::is_same_v<T, std::string>) {
        return;  // words can only be typed
    } else if constexpr (std::is_same_v<T, bool>) {
        value = !value;
    } else if constexpr (std::is_enum_v<T>) {
        const auto words = choices(T{});
        const auto at = std::find_if(words.begin(), words.end(), [&](const auto& c) { return c.second == value; });
        const auto count = static_cast<int>(words.size());
        const auto next = (static_cast<int>(at - words.begin()) + direction + count) % count;
        value = words[static_cast<std::size_t>(next)].second;
    } else if constexpr (std::is_same_v<T, int>) {
        const double step = std::max(1.0, coarse ? std::round(0.1 * std::min(info.max, 100.0)) : 1.0);
        value = static_cast<int>(std::clamp(value + direction * step, info.min, info.max));
    } else {
        value = stepped(value, direction, decimalStep(value, info, coarse), info);
    }
}

/// Calls `visit(info, value)` for the parameter of that name.
template <class Params, class Visitor>
void visitParam(Params& params, const std::string& name, Visitor&& visit) {
    forEachParam(params, [&](const ParamInfo& info, auto& value) {
        if (nameOf(info) == name) visit(info, value);
    });
}

}  // namespace

std::vector<ParamRow> paramRows(const DetectorParams& params) {
    std::vector<ParamRow> rows;
    forEachParam(params, [&](const ParamInfo& info, const auto& value) {
        rows.push_back({info.section, info.key, valueText(value), info.unit, info.text, false});
    });
    std::size_t k = 0;
    const DetectorParams defaults;
    forEachParam(defaults, [&](const ParamInfo&, const auto& value) {
        rows[k].changed = rows[k].value != valueText(value);
        ++k;
    });
    return rows;
}

ParamPanel::ParamPanel() {
    const DetectorParams params;
    forEachParam(params, [&](const ParamInfo& info, const auto&) { names_.push_back(nameOf(info)); });
}

void ParamPanel::choose(int step) {
    const auto count = static_cast<int>(names_.size());
    chosen_ = static_cast<std::size_t>(((static_cast<int>(chosen_) + step) % count + count) % count);
}

DetectorParams ParamPanel::changed(const DetectorParams& params, int direction, bool coarse) const {
    DetectorParams other = params;
    visitParam(other, chosen(), [&](const ParamInfo& info, auto& value) { change(value, info, direction, coarse); });
    return other;
}

DetectorParams ParamPanel::reset(const DetectorParams& params) const { return typed(params, value(DetectorParams{})); }

DetectorParams ParamPanel::typed(const DetectorParams& params, const std::string& text) const {
    DetectorParams other = params;
    setParam(other, chosen() + "=" + text);
    return other;
}

std::string ParamPanel::value(const DetectorParams& params) const {
    std::string text;
    visitParam(params, chosen(), [&](const ParamInfo&, const auto& value) { text = valueText(value); });
    return text;
}

std::string ParamPanel::text(const DetectorParams& params, std::size_t lines) const {
    const std::size_t shown = std::min(lines, names_.size());
    const std::size_t first = std::min(chosen_ > shown / 2 ? chosen_ - shown / 2 : 0, names_.size() - shown);
    std::string text;
    std::string meaning;
    std::size_t k = 0;
    forEachParam(params, [&](const ParamInfo& info, const auto& value) {
        const std::size_t at = k++;
        if (at < first || at >= first + shown) return;
        char line[128];
        std::snprintf(line, sizeof line, "%s %-30s %10s %s\n", at == chosen_ ? ">" : " ", names_[at].c_str(),
                      valueText(value).c_str(), info.unit);
        text += line;
        if (at == chosen_) meaning = info.text;
    });
    return text + meaning;
}

}  // namespace lidar_obstacles::apps
