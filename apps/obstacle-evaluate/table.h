// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The figures as a table for the terminal.
#pragma once

#include <string>

#include "lidar_obstacles/evaluation/metrics.h"

namespace lidar_obstacles::apps {

/// Lines of at most 150 characters. Error columns read: mean signed / mean abs / median abs / p95 abs.
std::string tableText(const evaluation::Metrics& metrics);

}  // namespace lidar_obstacles::apps
