// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Scans put by in a temporary file, for sources that cannot be read backwards.
#pragma once

#include <mrpt/obs/CObservation.h>

#include <cstdint>

namespace lidar_obstacles::apps {

/// A file without a name in the folder for temporary files ($TMPDIR, /tmp): it is gone when the program ends, however
/// it ends. One thread may append while another reads what append() has given back.
class ScanSpool {
  public:
    /// Where a scan lies.
    struct Place {
        std::uint64_t begin = 0;
        std::uint64_t size = 0;
    };

    /// @throws std::runtime_error naming the folder if no file can be made there.
    ScanSpool();
    ~ScanSpool();
    ScanSpool(const ScanSpool&) = delete;
    ScanSpool& operator=(const ScanSpool&) = delete;

    /// @throws std::runtime_error if the disk is full.
    Place append(const mrpt::obs::CObservation& scan);
    /// @throws std::runtime_error if it cannot be read.
    mrpt::obs::CObservation::Ptr read(const Place& place) const;

  private:
    int file_ = -1;
    std::uint64_t end_ = 0;
};

}  // namespace lidar_obstacles::apps
