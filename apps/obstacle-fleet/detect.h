// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One recording: from the file to its folder of results.
#pragma once

#include <filesystem>

#include "manifest.h"

namespace lidar_obstacles::fleet {

/// What is the same for all recordings of a run.
struct Detector {
    const Settings& settings;
    DetectorParams params;
    apps::InputChoice choice;
};

/// Detects and follows the obstacles of a recording, as obstacle-replay does, and writes obstacles.csv (the same
/// bytes), scans.csv, tracks.csv, timings.csv and result.json. Where the recording is damaged, what stands before that
/// is kept. Nothing but timings.csv depends on when, where and with what else it runs.
/// @param folder  empty, for the results.
/// @throws PassingError if the recording is not there or not the one of the manifest; OutputError if results cannot be
///     written; else std::exception that says why there are none.
void detectRecording(const Detector& detector, const Recording& recording, const std::filesystem::path& folder);

}  // namespace lidar_obstacles::fleet
