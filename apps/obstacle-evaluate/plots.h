// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is plotted.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/metrics.h"

namespace lidar_obstacles::apps {

/// A plot of a report.
struct Plot {
    std::string title;
    std::string svg;    ///< an svg element
    bool wide = false;  ///< over the whole width of the page
};

/// Recall and mean errors by range with their intervals, and every error over range. Scripts and SVG files stay in
/// `folder`.
/// @throws std::runtime_error if gnuplot fails.
std::vector<Plot> plotMetrics(const std::vector<evaluation::SetResult>& sets, const evaluation::Metrics& metrics,
                              const std::filesystem::path& folder);

/// The paper's figure (Sec. V): distance, relative heading and velocity of the target over time, measured and true, as
/// `<stem>.svg` and `<stem>.png`. Headings are told modulo 180 degrees next to the truth; velocities along the
/// vehicle's x axis, relative to the vehicle where its poses are known, else over ground.
/// @throws std::runtime_error if gnuplot fails.
std::optional<Plot> plotTarget(const evaluation::SetResult& set, const std::string& title,
                               const std::filesystem::path& stem);

}  // namespace lidar_obstacles::apps
