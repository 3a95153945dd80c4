// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The manifest: which recordings, and what is to be done with them. One line of JSON for the settings, then one for
/// each recording, in the order of their names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/input_choice.h"
#include "content.h"
#include "lidar_obstacles/params.h"

namespace lidar_obstacles::fleet {

/// What is the same for all recordings of a manifest.
struct Settings {
    std::string version;                     ///< of the program that made it
    std::string folder;                      ///< absolute: what relative names are relative to
    std::string parameters;                  ///< text of a config file
    std::string files;                       ///< SHA-256 of the recognizer's model, and of the map if there is one
    std::vector<std::string> input_options;  ///< words of the command line: --sensor-pose and so on
};

struct Recording {
    std::string name;
    Stamp stamp;
    std::string sha256;                   ///< contentOf(); empty where it could not be read
    std::string error;                    ///< why not; empty if it was read
    std::string key;                      ///< keyOf(): what names the work to be done; empty where it could not be read
    std::vector<std::string> named = {};  ///< filesNamedIn(): clouds and images of their own, which belong to it
};

struct Manifest {
    Settings settings;
    std::vector<Recording> recordings;
};

/// SHA-256 of the content, model, parameters, options of the input and version: the same key, the same results.
std::string keyOf(const Settings& settings, const std::string& sha256);

/// Settings::files of these parameters. @throws std::runtime_error naming a file that cannot be read.
std::string filesOf(const DetectorParams& params);

/// Files that the parameters name get absolute paths.
/// @param input_options  as Settings has them.
/// @throws std::runtime_error if the model or the map cannot be read.
Settings makeSettings(DetectorParams params, const std::vector<std::string>& input_options);

/// The choice that the options of the input make. @throws apps::UsageError
apps::InputChoice inputChoiceOf(const std::vector<std::string>& input_options);

/// Reads every recording once, but those that one of the known manifests has with the same place, size and time.
/// @param threads  that read at the same time.
Manifest makeManifest(const Settings& settings, const std::vector<std::string>& names,
                      const std::vector<Manifest>& known, int threads);

/// A manifest of that name stays until this one is whole. @throws std::runtime_error naming the file.
void writeManifest(const std::filesystem::path& file, const Manifest& manifest);

/// @throws std::runtime_error naming the file, the line and what is wrong with it.
Manifest readManifest(const std::filesystem::path& file);

/// The same, for work to be done. @throws std::runtime_error also if another version of the program made it.
Manifest readOwnManifest(const std::filesystem::path& file);

/// Where a recording lies.
std::filesystem::path pathOf(const Settings& settings, const std::string& name);
/// A message with the recording's name in the place of its path: the same wherever it lies.
std::string withName(std::string message, const Settings& settings, const std::string& name);

}  // namespace lidar_obstacles::fleet
