// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What another run made of the same recordings: which changed, and where most.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace lidar_obstacles::fleet {

/// How boxes differ between two runs. Boxes of the same class within a metre are the same thing.
struct BoxChanges {
    std::size_t gone = 0;   ///< were there
    std::size_t fresh = 0;  ///< are there
    std::size_t moved = 0;  ///< by more than .1 m, are larger or smaller by that, or turned by more than 5 degrees

    std::size_t sum() const { return gone + fresh + moved; }
};

/// A recording that the two runs have not the same of.
struct Change {
    std::string name;
    std::string before, now;  ///< what came of it: "done", "damaged", "failed"
    std::size_t scans_before = 0, scans_now = 0;
    std::size_t tracks_before = 0, tracks_now = 0;
    std::size_t scans_changed = 0;
    BoxChanges boxes;
    std::size_t worst_scan = 0;  ///< in which most boxes changed
    std::string replay;          ///< page with both, beside the report; empty: none
    std::string no_replay;       ///< why there is none
};

struct Drift {
    std::string baseline;              ///< its file
    std::string version;               ///< of the program that made it
    std::string parameters;            ///< text of its config file
    std::vector<std::string> options;  ///< of the input, of it
    std::size_t same = 0;              ///< recordings with the same bytes of obstacles
    std::size_t only_before = 0;       ///< recordings that only the baseline has
    std::size_t only_now = 0;
    bool has_boxes = true;  ///< false: one of the two has no rows of obstacles, boxes are not compared
    std::vector<std::string> parameters_changed;  ///< "section.key: before -> now"
    std::vector<Change> changes;                  ///< those with most changed boxes first
};

/// @throws std::runtime_error naming the file if it is not there or no database of `obstacle-fleet merge`.
void requireBaseline(const std::filesystem::path& baseline);

/// Compares recordings with the same content.
Drift driftBetween(const std::filesystem::path& now, const std::filesystem::path& baseline);

}  // namespace lidar_obstacles::fleet
