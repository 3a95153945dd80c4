// SPDX-License-Identifier: BSD-3-Clause
// Writes the files that the targets begin with: fuzz_seeds FOLDER
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>

#include <cstdio>
#include <filesystem>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "support/capture_files.h"
#include "support/rawlog_files.h"
#include "support/temp_folder.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::test;
namespace fs = std::filesystem;

/// Some packets of a turn: seeds are small.
VelodyneScan someOf(std::uint8_t model) {
    Turn turn;
    turn.packets = 6;
    turn.step = 400;
    VelodyneScan scan = makeScan(turn, wallAt(10.0));
    for (auto& packet : scan.scan_packets) packet.velodyne_model_ID = model;
    return scan;
}

void writeCaptures(const std::string& folder) {
    for (const std::uint8_t model : {0x21, 0x22, 0x24, 0x28}) {
        CaptureFile whole, fragments;
        whole.add(someOf(model), 1000.0);
        unsigned identification = 0;
        for (const auto& packet : someOf(model).scan_packets)
            for (const std::string& part : ipv4Fragments(payloadOf(packet), 552, ++identification))
                fragments.add(ethernet(part, true), 1000.0);
        writeFile(folder + "/whole" + std::to_string(model), whole.content());
        writeFile(folder + "/fragments" + std::to_string(model), fragments.content());
    }
    CaptureFile cooked_frames(CaptureFile::kCooked);
    for (const auto& packet : someOf(0x22).scan_packets) cooked_frames.add(cooked(ipv4(payloadOf(packet))), 1000.0);
    writeFile(folder + "/cooked", cooked_frames.content());
}

void writeRawlogs(const std::string& folder) {
    const auto packets = std::make_shared<VelodyneScan>(someOf(0x22));
    const auto points = std::make_shared<VelodyneScan>(*packets);
    points->generatePointCloud();
    points->scan_packets.clear();
    const auto map = mrpt::maps::CSimplePointsMap::Create();
    for (int k = 0; k < 100; ++k) map->insertPoint(static_cast<float>(k % 10), 1.0F, 0.5F * static_cast<float>(k % 5));
    const auto cloud = mrpt::obs::CObservationPointCloud::Create();
    cloud->pointcloud = map;
    const auto planar = mrpt::obs::CObservation2DRangeScan::Create();
    planar->resizeScan(20);
    const auto image = mrpt::obs::CObservationRotatingScan::Create();
    image->fromVelodyne(*packets);
    int number = 0;
    for (const mrpt::serialization::CSerializable::Ptr& object :
         {mrpt::serialization::CSerializable::Ptr(packets), mrpt::serialization::CSerializable::Ptr(points),
          mrpt::serialization::CSerializable::Ptr(cloud), mrpt::serialization::CSerializable::Ptr(planar),
          mrpt::serialization::CSerializable::Ptr(image)})
        writeRawlog(folder + "/object" + std::to_string(number++), {object, object}, false);
}

void writePackets(const std::string& folder) {
    for (const std::uint8_t model : {0, 1, 2, 3}) {
        std::string content(1, static_cast<char>(model));
        for (const auto& packet : someOf(0x22).scan_packets) content += little(13, 2) + payloadOf(packet);
        writeFile(folder + "/packets" + std::to_string(model), content);
    }
    std::string points(1, '\x80');
    for (const auto& p : toPointCloud(someOf(0x22), SensorParams{}).xyz)
        points.append(reinterpret_cast<const char*>(p.data()), 12);
    writeFile(folder + "/points", points);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "fuzz_seeds FOLDER\n");
        return 2;
    }
    const std::string folder = argv[1];
    for (const char* target : {"/capture", "/rawlog", "/packets"}) fs::create_directories(folder + target);
    writeCaptures(folder + "/capture");
    writeRawlogs(folder + "/rawlog");
    writePackets(folder + "/packets");
    return 0;
}
