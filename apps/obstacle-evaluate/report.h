// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// report.html: one file that shows everything, for people.
#pragma once

#include <string>
#include <vector>

#include "common/html_text.h"
#include "lidar_obstacles/evaluation/metrics.h"
#include "lidar_obstacles/evaluation/worst_scans.h"
#include "options.h"
#include "pictures.h"
#include "plots.h"

namespace lidar_obstacles::apps {

/// What a report is made of.
struct ReportContent {
    std::string title;
    std::string introduction;  ///< HTML; may be empty
    const evaluation::Metrics* metrics = nullptr;
    std::vector<Plot> plots;
    std::vector<evaluation::WorstScan> worst;
    std::vector<ScanPictures> pictures;  ///< one per worst scan
    std::vector<std::string> replays;    ///< links to the pages that play them, "" where there is none
    std::vector<evaluation::SetResult> const* results = nullptr;
};

/// What is said where options.plots is false.
extern const char* const kNoPlots;

/// A complete page, without network; only what the links to replays lead to is in files beside it.
std::string reportHtml(const ReportContent& content, const EvaluateOptions& options, const Variant& variant);

/// The part of a page that shows the worst scans; "" without any.
/// @param folder  the replays' links are relative to it, seen from the page: "" or "8_plane/".
std::string worstScansHtml(const ReportContent& content, const std::string& folder = "");

/// Head of a page up to the title, and its end.
std::string pageHead(const std::string& title);
std::string pageEnd();

}  // namespace lidar_obstacles::apps
