// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Values of parameters as text (used by config_file.cpp only).
#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "lidar_obstacles/params_list.h"
#include "scan/place_text.h"

namespace lidar_obstacles::detail {

inline std::string_view trim(std::string_view s) {
    const auto first = s.find_first_not_of(" \t\r\v\f");
    if (first == std::string_view::npos) return {};
    return s.substr(first, s.find_last_not_of(" \t\r\v\f") - first + 1);
}

inline std::string lower(std::string_view s) {
    std::string out(s);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

/// A value as it stands in a config file.
template <class T>
std::string toText(const T& value) {
    if constexpr (std::is_same_v<T, std::string>) {
        return value;
    } else if constexpr (std::is_same_v<T, bool>) {
        return value ? "true" : "false";
    } else if constexpr (std::is_enum_v<T>) {
        for (const auto& [word, known] : choices(T{})) {
            if (known == value) return std::string(word);
        }
        throw std::invalid_argument("parameter with a value that is none of its choices");
    } else {
        return numberText(value);
    }
}

/// What a parameter may be: "0.05 .. 1 m", "true | false", "ground | rays" or "text".
template <class T>
std::string allowed(const ParamInfo& info, const T&) {
    if constexpr (std::is_same_v<T, std::string>) {
        return "text";
    } else if constexpr (std::is_same_v<T, bool>) {
        return "true | false";
    } else if constexpr (std::is_enum_v<T>) {
        std::string words;
        for (const auto& choice : choices(T{})) words += (words.empty() ? "" : " | ") + std::string(choice.first);
        return words;
    } else {
        const std::string unit = *info.unit ? std::string(" ") + info.unit : "";
        return numberText(info.min) + " .. " + numberText(info.max) + unit;
    }
}

/// Reads a value of the parameter's type; on failure leaves it alone and returns what is wrong.
template <class T>
std::optional<std::string> readValue(const ParamInfo& info, std::string_view text, T& value) {
    const std::string choice = " (" + allowed(info, value) + ")";
    if (text.empty()) return "no value" + choice;
    if constexpr (std::is_same_v<T, std::string>) {
        value = text;
    } else if constexpr (std::is_same_v<T, bool>) {
        const std::string word = lower(text);
        const bool yes = word == "true" || word == "yes" || word == "on" || word == "1";
        if (!yes && word != "false" && word != "no" && word != "off" && word != "0")
            return "not a truth value" + choice;
        value = yes;
    } else if constexpr (std::is_enum_v<T>) {
        for (const auto& [word, meaning] : choices(T{})) {
            if (word == lower(text)) return value = meaning, std::nullopt;
        }
        return "not one of the choices" + choice;
    } else {
        T number{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        const bool integer = std::is_same_v<T, int>;
        if (error == std::errc::result_out_of_range) return "out of range" + choice;
        if (error != std::errc() || end != text.data() + text.size()) {
            return (integer ? "not an integer" : "not a number") + choice;
        }
        if (!(number >= info.min && number <= info.max)) return "out of range" + choice;  // NaN is out of range too
        value = number;
    }
    return std::nullopt;
}

}  // namespace lidar_obstacles::detail
