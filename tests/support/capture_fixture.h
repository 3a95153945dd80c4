// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Captures that are written and read again in a test.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "support/capture_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::test {

inline constexpr double kPacket = 12 * 110.592e-6;  // of a VLP-16 [s]

class Capture : public testing::Test {
  protected:
    std::vector<VelodyneScan> read(const CaptureFile& file, const InputOptions& options = {}) {
        writeFile(path_, file.content());
        source_ = openScanSource(path_, options);
        std::vector<VelodyneScan> scans;
        while (const auto item = source_->next())
            scans.push_back(dynamic_cast<const VelodyneScan&>(*item->observation));
        EXPECT_EQ(source_->status(), SourceStatus::End);
        return scans;
    }
    std::string remarks() const { return source_->remarks(); }

    TempFolder folder_;
    std::string path_ = folder_.file("drive.pcap");
    std::unique_ptr<ScanSource> source_;
};

inline std::vector<std::size_t> packetsOf(const std::vector<VelodyneScan>& scans) {
    std::vector<std::size_t> packets;
    for (const auto& scan : scans) packets.push_back(scan.scan_packets.size());
    return packets;
}

}  // namespace lidar_obstacles::test
