// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A recording as one HTML file that any browser plays: points, grid, boxes, tracks, plots.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "common/text_file.h"
#include "exports/page_scan.h"

namespace lidar_obstacles::apps {

/// What a page says of itself.
struct PageTitle {
    std::string program;  ///< and its version
    std::string input;
    std::string note;  ///< e.g. that the run was interrupted; empty: nothing
};

/// Bounds of a page.
struct PageLimits {
    std::size_t bytes = 28'000'000;  ///< of the file, about: returns are left out until it fits
    std::size_t scans = 3000;        ///< of more scans every second, third .. is kept
    std::size_t points = 40'000;     ///< of one scan
};

/// Collects scans in a temporary file and writes the page at the end, when it is known how much room each has.
class ReplayPage {
  public:
    /// @throws std::runtime_error naming the file if it cannot be written.
    explicit ReplayPage(const std::filesystem::path& file, const PageLimits& limits = {});
    ~ReplayPage();
    ReplayPage(const ReplayPage&) = delete;
    ReplayPage& operator=(const ReplayPage&) = delete;

    /// @throws std::runtime_error if there is no room for temporary files.
    void add(const ScanOutput& scan);
    /// Writes the page; without scans an empty one. @throws std::runtime_error naming the file.
    void finish(const PageTitle& title);

  private:
    struct Room;
    PageScan scanAt(std::size_t place) const;
    Room roomFor(const std::vector<std::size_t>& kept) const;
    void write(const PageTitle& title);
    std::size_t writeScans(const std::vector<std::size_t>& kept, const Room& room);

    std::filesystem::path file_;
    PageLimits limits_;
    TextFile out_;
    int spool_ = -1;
    std::vector<std::size_t> begins_;  ///< of the scans in the temporary file, and the end of the last
    std::size_t returns_ = 0;          ///< of all scans
    bool finished_ = false;
};

}  // namespace lidar_obstacles::apps
