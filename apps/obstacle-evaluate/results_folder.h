// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The output folder: what an earlier evaluation left in it is never beside the results of the next one.
#pragma once

#include <string>
#include <vector>

#include "batch.h"
#include "options.h"

namespace lidar_obstacles::apps {

/// Takes away what an earlier evaluation left in options.output, and notes in `written.txt` there what this one will
/// write, for the next. Only files that an evaluation wrote are touched, and never one that a job reads.
/// @throws std::runtime_error if the note cannot be written.
void beginResults(const EvaluateOptions& options, const std::vector<Job>& jobs);

}  // namespace lidar_obstacles::apps
