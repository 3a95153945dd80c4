// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The recordings of a folder or a list.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lidar_obstacles::fleet {

/// True for NAME.rawlog, .pcap and .pcapng, each also with .gz, in any case.
bool isRecordingName(const std::filesystem::path& file);

/// Recordings, in the order of their names, each once.
/// @param inputs  files, whatever their names, and folders: those are searched with all folders in them.
/// @param list    file with a recording or folder in each line, "-" for the standard input; empty lines and those that
///                begin with # are left out. "": there is none.
/// @throws std::runtime_error naming what is not there, a list that cannot be read, or inputs without any recording.
std::vector<std::string> findRecordings(const std::vector<std::string>& inputs, const std::string& list);

}  // namespace lidar_obstacles::fleet
