// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Small parts of HTML pages.
#pragma once

#include <string>
#include <vector>

#include "common/html_text.h"

namespace lidar_obstacles::fleet {

using apps::escaped;

/// A page with its style. @param body  HTML.
std::string page(const std::string& title, const std::string& body);
/// Cells are HTML; the first column is to the left, others to the right.
std::string tableHead(const std::vector<std::string>& cells);
std::string tableRow(const std::vector<std::string>& cells);
/// With a link to the page of another recording or run.
std::string link(const std::string& file, const std::string& text);

}  // namespace lidar_obstacles::fleet
