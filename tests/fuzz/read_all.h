// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What all targets do with a file or a scan.
#pragma once

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace lidar_obstacles::fuzz {

/// A file in memory with the fuzzer's bytes.
class MemoryFile {
  public:
    MemoryFile(const std::uint8_t* data, std::size_t size) : file_(memfd_create("fuzz", MFD_CLOEXEC)) {
        if (file_ < 0 || write(file_, data, size) != static_cast<ssize_t>(size)) std::abort();
    }
    ~MemoryFile() { close(file_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    std::string path() const { return "/proc/self/fd/" + std::to_string(file_); }

  private:
    int file_;
};

/// Decodes a scan; what comes out has to be finite, and its fields have to fit together.
inline void decode(const mrpt::obs::CObservation& observation) {
    try {
        DecodeStats stats;
        const auto cloud = toPointCloud(observation, SensorParams{}, &stats);
        if (!cloud) return;
        for (const auto& p : cloud->xyz)
            if (!p.allFinite()) std::abort();
        if (!cloud->ring.empty() && cloud->ring.size() != cloud->size()) std::abort();
        if (!cloud->view.empty() && cloud->view.column_of.size() != cloud->size()) std::abort();
        for (const std::uint16_t ring : cloud->ring)
            if (ring >= cloud->view.rings) std::abort();
    } catch (const std::exception&) {
        // a scan that cannot be right is refused
    }
}

/// Reads a file to its end as the tools do.
inline void readAll(const std::string& path) {
    try {
        const auto source = openScanSource(path);
        while (const auto item = source->next())
            if (item->observation && !item->is_gap) decode(*item->observation);
        if ((source->status() == SourceStatus::Damaged) == source->message().empty()) std::abort();
        static_cast<void>(source->remarks());
    } catch (const std::runtime_error&) {
        // not even opened
    }
}

}  // namespace lidar_obstacles::fuzz
