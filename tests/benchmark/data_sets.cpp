// SPDX-License-Identifier: BSD-3-Clause
#include "data_sets.h"

#include <optional>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "support/synthetic_scene.h"
#include "support/test_data.h"

namespace lidar_obstacles::bench {
namespace {

/// The same street within the same field of view, cut by more planes: returns double, the geometry stays.
DataSet syntheticStreet(int planes) {
    test::Sensor sensor;
    sensor.planes = planes;
    sensor.step_deg = 30.0 / (planes - 1);
    sensor.noise = 0.02;
    return {"street_" + std::to_string(planes), castRays(test::street(), sensor).cloud, nullptr};
}

/// One scan of a file, of all planes or decimated (0: all).
std::optional<DataSet> scanOfFile(const std::string& name, const std::string& path, int number, int planes = 0) {
    if (path.empty()) return std::nullopt;
    const auto source = openScanSource(path);
    while (const auto item = source->next()) {
        if (!item->observation || !isLidarScan(*item->observation) || number-- > 0) continue;
        auto packets = std::dynamic_pointer_cast<mrpt::obs::CObservationVelodyneScan>(item->observation);
        if (packets && packets->scan_packets.empty()) packets = nullptr;
        SensorParams sensor;
        sensor.planes = planes;
        return DataSet{name, *toPointCloud(*item->observation, sensor), planes == 0 ? packets : nullptr};
    }
    return std::nullopt;
}

}  // namespace

std::vector<DataSet> loadDataSets() {
    std::vector<DataSet> sets;
    for (const int planes : {16, 32, 64}) sets.push_back(syntheticStreet(planes));
    if (auto set = scanOfFile("vlp16_sample", test::mrptDataset("test_velodyne_VLP16.rawlog"), 0))
        sets.push_back(std::move(*set));
    for (const int planes : {16, 8})
        if (auto set = scanOfFile("kitti_0001_" + std::to_string(planes), test::labelledData("kitti_0001_16.rawlog"),
                                  20, planes))
            sets.push_back(std::move(*set));
    return sets;
}

}  // namespace lidar_obstacles::bench
