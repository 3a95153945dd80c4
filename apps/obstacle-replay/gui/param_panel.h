// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The parameters as a list from which one is chosen and changed.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lidar_obstacles/params.h"

namespace lidar_obstacles::apps {

/// A parameter in a list.
struct ParamRow {
    std::string section, key;
    std::string value;     ///< as a config file has it
    std::string unit;      ///< "" where it has none
    std::string text;      ///< what it means
    bool changed = false;  ///< it is not the default
};
std::vector<ParamRow> paramRows(const DetectorParams& params);

/// Knows which parameter is chosen; the parameters themselves are given to every call.
class ParamPanel {
  public:
    ParamPanel();

    /// The next (+1) or previous (-1) parameter, around the end.
    void choose(int step);
    /// By its place in paramRows().
    void chooseAt(std::size_t place) { chosen_ = place % names_.size(); }
    std::size_t place() const { return chosen_; }
    /// "section.key" of the chosen one.
    std::string chosen() const { return names_[chosen_]; }
    /// `params` with the chosen one a step up or down: numbers by their decimal place, larger steps with `coarse`, and
    /// never beyond the allowed range; the other truth value; the next choice.
    DetectorParams changed(const DetectorParams& params, int direction, bool coarse) const;
    /// `params` with the chosen one set to its default.
    DetectorParams reset(const DetectorParams& params) const;
    /// `params` with the chosen one set to what the text says. @throws ConfigError
    DetectorParams typed(const DetectorParams& params, const std::string& text) const;

    /// Some lines around the chosen parameter, with value, unit and meaning.
    std::string text(const DetectorParams& params, std::size_t lines) const;
    /// Value of the chosen parameter as a config file has it.
    std::string value(const DetectorParams& params) const;

  private:
    std::vector<std::string> names_;
    std::size_t chosen_ = 0;
};

}  // namespace lidar_obstacles::apps
