// SPDX-License-Identifier: BSD-3-Clause
// Writes the files that the targets begin with: fuzz_seeds FOLDER
#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "support/capture_files.h"
#include "support/rawlog_files.h"
#include "support/size_model.h"
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

/// Returns of a scan, behind the byte that says that points follow.
void writePoints(const std::string& folder, char how) {
    std::string points(1, how);
    for (const auto& p : toPointCloud(someOf(0x22), SensorParams{}).xyz)
        points.append(reinterpret_cast<const char*>(p.data()), 12);
    writeFile(folder + "/points", points);
}

void writePackets(const std::string& folder) {
    for (const std::uint8_t model : {0, 1, 2, 3}) {
        std::string content(1, static_cast<char>(model));
        for (const auto& packet : someOf(0x22).scan_packets) content += little(13, 2) + payloadOf(packet);
        writeFile(folder + "/packets" + std::to_string(model), content);
    }
    writePoints(folder, '\x80');
}

void writeTexts(const std::string& folder) {
    writeFile(folder + "/config/defaults.ini", dumpParams(DetectorParams{}));
    writeFile(folder + "/config/assignment", "grid.resolution=0.2");
    writeFile(folder + "/model/sizes", sizeModelText());
    writeFile(folder + "/model/deep", modelText({leaf(1.0F)}, {stump(Feature::Range, 10.0F, 1.0F, -1.0F)}));
    fs::copy(DATASETS "presets/zones.yaml", folder + "/zones", fs::copy_options::overwrite_existing);
    for (const char* name : {"street", "delivery-two", "fast-curves", "yaw-grid"})
        fs::copy(std::string(DATASETS "scenarios/") + name + ".yaml", folder + "/scenario",
                 fs::copy_options::overwrite_existing);
    int number = 0;
    for (const char* line : {R"({"subscribe": ["tracks", "grid"]})", R"({"detection": "stop"})",
                             R"({"set": ["grid.resolution=0.2", "pipeline.algorithm=auto"]})",
                             R"({"pose": {"timestamp": 1e9, "x": 1, "y": -2, "yaw": 0.5, "roll": 0}})",
                             R"({"timestamp": 1e9, "x": 1, "y": -2, "yaw": 0.5, "pitch": 0.1, "z": 3})"})
        writeFile(folder + "/requests/" + std::to_string(number++), line);
}

/// A wall and a block on the ground, as fuzz_detector reads them: ring, column and range [2 mm] of each return.
void writeTurns(const std::string& folder) {
    for (const std::uint8_t how : {0x00, 0x04, 0x08, 0x01, 0x05, 0x0a, 0x03}) {
        const int rings = how % 4 == 0 ? 16 : how % 4 == 1 ? 8 : how % 4 == 2 ? 4 : 32;
        std::string content(1, static_cast<char>(how));
        for (int ring = 0; ring < rings; ++ring)
            for (int column = 0; column < 1800; column += 12) {
                const double down = (15.0 - 30.0 * ring / rings) * 0.01745;
                const double ground = down > 0.02 ? 1.8 / std::sin(down) : 200.0;
                const double wall = column > 700 && column < 900 ? 12.0 : 200.0, block = column < 100 ? 8.0 : 200.0;
                const double range = std::min({ground, wall, block, 60.0});
                if (range < 60.0)
                    content += little(ring, 1) + little(column, 2) + little(static_cast<std::uint32_t>(range * 500), 2);
            }
        writeFile(folder + "/turn" + std::to_string(how), content);
    }
    writePoints(folder, '\x88');
}

/// Twenty scans of two boxes, as fuzz_tracker reads them: what each byte is there.
void writeTracks(const std::string& folder) {
    std::string content(1, '\x01');
    for (int scan = 0; scan < 20; ++scan) {
        content += std::string("\x7f\x80\x82\x00\x02", 5);  // time, the vehicle's way, boxes
        for (int box = 0; box < 2; ++box) {
            content += std::string("\x7f\x80", 2);  // time
            content += static_cast<char>(0x90 + 8 * box + scan);
            content += std::string("\x10\x60\x20\x82\x00\xa0\x00\x90\x00\x80\x00\x80\x00\x11\x60", 15);
            content += static_cast<char>(1 + box);
        }
    }
    writeFile(folder + "/two", content);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "fuzz_seeds FOLDER\n");
        return 2;
    }
    const std::string folder = argv[1];
    for (const char* target : {"/capture", "/rawlog", "/packets", "/config", "/model", "/zones", "/scenario",
                               "/requests", "/detector", "/tracker"})
        fs::create_directories(folder + target);
    writeCaptures(folder + "/capture");
    writeRawlogs(folder + "/rawlog");
    writePackets(folder + "/packets");
    writeTexts(folder);
    writeTurns(folder + "/detector");
    writeTracks(folder + "/tracker");
    return 0;
}
