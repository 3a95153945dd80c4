// SPDX-License-Identifier: BSD-3-Clause
// The packets of one sensor, and points without rings: what no file format stands before.
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <cstring>
#include <deque>

#include "fuzz/read_all.h"
#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"
#include "mrpt_bridge/input/sensor_turns.h"

namespace {

using namespace lidar_obstacles;
using Packet = TurnAssembler::Packet;

/// Each packet behind the time since the one before [0.1 ms]; the first byte chooses the model and whether what the end
/// cuts off is a turn.
void assemble(const std::uint8_t* data, std::size_t size) {
    constexpr std::uint8_t kModels[] = {0x21, 0x22, 0x24, 0x28};
    SensorTurns turns("fuzz");
    std::deque<mrpt::obs::CObservation::Ptr> scans;
    double time = 1000.0;
    const std::uint8_t model = kModels[data[0] % 4];
    for (std::size_t at = 1; at + 2 + sizeof(Packet) <= size; at += 2 + sizeof(Packet)) {
        Packet packet;
        std::memcpy(&packet, data + at + 2, sizeof packet);
        packet.velodyne_model_ID = model;
        time += 1e-4 * (data[at] | data[at + 1] << 8U);
        if (!turns.isDuplicate(packet)) turns.add(packet, time, scans);
    }
    turns.finish((data[0] & 0x40U) != 0, scans);
    for (const auto& scan : scans) fuzz::decode(*scan);
}

void decodePoints(const std::uint8_t* data, std::size_t size) {
    mrpt::obs::CObservationPointCloud scan;
    auto map = mrpt::maps::CSimplePointsMap::Create();
    for (std::size_t at = 0; at + 12 <= size; at += 12) {
        float p[3];
        std::memcpy(p, data + at, sizeof p);
        map->insertPointFast(p[0], p[1], p[2]);
    }
    scan.pointcloud = map;
    fuzz::decode(scan);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 2) return 0;
    if (data[0] & 0x80U)
        decodePoints(data + 1, size - 1);
    else
        assemble(data, size);
    return 0;
}
