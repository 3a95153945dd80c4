// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What every return hit, in a file beside the rawlog: `PREFIX_labels.bin`.
///
/// All numbers are little-endian. The file begins with the eight letters LOLABELS and the version (uint32, 1). Then
/// per scan: scan_index (uint32), number of returns (uint32), timestamp (float64, seconds since the epoch), and per
/// return, in the order of the packets (firing by firing, in a firing in the order the lasers fire), its id (int16)
/// and its ObjectKind (uint8). Returns that the packets do not hold have no label.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/simulation/lidar.h"

namespace lidar_obstacles::simulation {

struct ReturnLabel {
    std::int16_t id = 0;  ///< 1, 2 ...: object_id of the truth; -1, -2 ... clutter, one per thing; 0: terrain, nothing
    ObjectKind kind = ObjectKind::Noise;
};

struct ScanLabels {
    std::size_t scan_index = 0;
    double timestamp = 0.0;  ///< seconds since the epoch, as of the scan
    std::vector<ReturnLabel> returns;
};

/// The labels of a cast scan. @throws std::invalid_argument if an id does not fit into the file (more than 32767).
ScanLabels labelsOf(const LidarScan& scan, std::size_t scan_index);

/// The first bytes of a file, and the bytes of a scan.
std::string labelsHeader();
std::string labelsRecord(const ScanLabels& labels);

/// Reads a file of labels scan by scan.
/// An object is for one thread at a time.
class LabelsReader {
  public:
    /// @throws std::runtime_error naming the file if it cannot be read, is no file of labels or of another version.
    explicit LabelsReader(std::string file);

    /// The next scan; none after the last one.
    /// @throws std::runtime_error naming file and scan if it ends within a scan or names a kind that does not exist;
    ///         the scans before are good.
    std::optional<ScanLabels> next();

  private:
    [[noreturn]] void fail(const std::string& reason) const;
    /// False at the end of the file. @throws std::runtime_error if it ends within `bytes`.
    bool read(std::string& bytes);

    std::string file_;
    std::ifstream in_;
    std::uintmax_t left_ = 0;  ///< bytes
    std::size_t scans_ = 0;
};

}  // namespace lidar_obstacles::simulation
