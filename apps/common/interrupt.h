// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// SIGINT (Ctrl-C) and SIGTERM as an orderly end: the run stops between two scans and completes its files.
#pragma once

#include <atomic>
#include <cstddef>
#include <optional>

namespace lidar_obstacles::apps {

/// Exit code of a run that was interrupted: 128 + SIGINT, as shells have it.
constexpr int kInterruptedCode = 130;

/// From here on the first SIGINT or SIGTERM only sets interruption(); a second one ends the program at once.
void catchInterrupts();

/// True once a signal has come; only after catchInterrupts().
const std::atomic<bool>& interruption();
inline bool isInterrupted() { return interruption(); }

/// What a tool returns at its end: 0, or after an interruption kInterruptedCode, with "TOOL: interrupted at scan N" on
/// the standard error.
/// @param interrupted_at  number of the first scan that was left out; not set: the run came to its end.
int exitCode(const char* tool, const std::optional<std::size_t>& interrupted_at);

}  // namespace lidar_obstacles::apps
