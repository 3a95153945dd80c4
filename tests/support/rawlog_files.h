// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Small rawlogs written for a test.
#pragma once

#include <mrpt/io/CFileGZOutputStream.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/serialization/CArchive.h>

#include <memory>
#include <string>
#include <vector>

#include "support/velodyne_packets.h"

namespace lidar_obstacles::test {

using Objects = std::vector<mrpt::serialization::CSerializable::Ptr>;

inline void writeRawlog(const std::string& path, const Objects& objects, bool compressed) {
    const auto writeTo = [&objects](auto&& stream) {
        auto archive = mrpt::serialization::archiveFrom(stream);
        for (const auto& object : objects) archive.WriteObject(object.get());
    };
    if (compressed)
        writeTo(mrpt::io::CFileGZOutputStream(path));
    else
        writeTo(mrpt::io::CFileOutputStream(path));
}

/// A turn with a wall 10 m ahead.
inline std::shared_ptr<VelodyneScan> scanLabelled(const std::string& label, double time = 1'000'000.0) {
    auto scan = std::make_shared<VelodyneScan>(makeScan({}, wallAt(10.0)));
    scan->sensorLabel = label;
    scan->timestamp = mrpt::Clock::fromDouble(time);
    return scan;
}

}  // namespace lidar_obstacles::test
