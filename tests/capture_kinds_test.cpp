// Captures as people really have them: other ports and models, fragments, duplicates, gaps, bursts, clocks that jump.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>
#include <optional>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/pcap_reader.h"
#include "support/capture_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kPacket = 12 * 110.592e-6;  // of a VLP-16 [s]

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

std::vector<std::size_t> packetsOf(const std::vector<VelodyneScan>& scans) {
    std::vector<std::size_t> packets;
    for (const auto& scan : scans) packets.push_back(scan.scan_packets.size());
    return packets;
}

/// Packets of a sensor that turns for so long, without those that would look out of its field of view.
/// @param start_deg  where it looks first; none: where its field of view begins.
VelodyneScan limitedDrive(int from_deg, int to_deg, int step, int packets, std::optional<int> start_deg = {}) {
    Turn turn;
    turn.step = step;
    turn.packets = packets;
    turn.start = 100U * static_cast<unsigned>(start_deg.value_or(from_deg));
    VelodyneScan drive = makeScan(turn, sphere(20.0));
    auto& all = drive.scan_packets;
    const auto is_outside = [&](const VelodynePacket& packet) {
        const int width = (to_deg - from_deg + 360) % 360 * 100;
        const auto since = [&](int block) {
            return (packet.blocks[block].rotation() - 100 * from_deg + 36000) % 36000;
        };
        return since(0) > width || since(11) > width;
    };
    all.erase(std::remove_if(all.begin(), all.end(), is_outside), all.end());
    return drive;
}

TEST_F(Capture, TurnsOfALimitedFieldOfViewEndInItsGap) {
    for (const int step : {20, 40, 80}) {  // 5, 10 and 20 Hz
        const int five_turns = 5 * 36000 / (12 * step);
        for (const auto& [from, to] :
             {std::pair(300, 60), std::pair(90, 270), std::pair(200, 170), std::pair(350, 80)}) {
            CaptureFile file;
            file.add(limitedDrive(from, to, step, five_turns), 1000.0);
            const auto scans = read(file);
            ASSERT_EQ(scans.size(), 5u) << from << " .. " << to << ", step " << step;
            for (const auto& scan : scans)
                EXPECT_NEAR(static_cast<double>(scan.scan_packets.size()),
                            static_cast<double>(scans[0].scan_packets.size()), 1.0);
        }
    }
}

TEST_F(Capture, OfATurnThatTheEndCutsOffAPieceIsNoScan) {
    const int four_turns = 4 * 36000 / (12 * 20);
    CaptureFile file;  // begins and ends straight ahead, in the middle of what the sensor looks at
    VelodyneScan drive = limitedDrive(300, 60, 20, four_turns, 0);
    file.add(drive, 1000.0);
    const auto scans = packetsOf(read(file));
    ASSERT_EQ(scans.size(), 4u) << "half a view, three whole ones";
    EXPECT_NEAR(static_cast<double>(scans[3]), 2.0 * static_cast<double>(scans[0]), 1.0);
    EXPECT_THAT(remarks(), HasSubstr("packets of the turn that the end of the capture cuts off left out"));
    std::size_t delivered = 0;
    for (const std::size_t packets : scans) delivered += packets;
    EXPECT_THAT(remarks(), HasSubstr(std::to_string(drive.scan_packets.size() - delivered) + " packets of the turn"));
}

TEST_F(Capture, MostOfALastTurnIsAScan) {
    Turn turn;
    turn.packets = 205;
    CaptureFile file;
    file.add(makeScan(turn, sphere(20.0)), 1000.0);
    EXPECT_THAT(packetsOf(read(file)), ElementsAre(75, 75, 55));
    EXPECT_EQ(remarks(), "");
}

TEST_F(Capture, PacketsThatComeInBurstsCutNoTurn) {
    Turn turn;
    turn.packets = 225;
    const VelodyneScan drive = makeScan(turn, sphere(20.0));
    CaptureFile file;
    for (std::size_t k = 0; k < drive.scan_packets.size(); ++k) {
        const double sent = kPacket * static_cast<double>(k);
        const double arrived = sent < 0.05 ? sent : sent < 0.65 ? 0.65 : sent;  // the link stood still for 0.6 s
        file.add(ethernet(ipv4(payloadOf(drive.scan_packets[k]))), 1000.0 + arrived);
    }
    EXPECT_THAT(packetsOf(read(file)), ElementsAre(75, 75, 75));
}

TEST_F(Capture, ALossOfHalfATurnJoinsNoTurns) {
    Turn turn;
    turn.packets = 225;
    VelodyneScan drive = makeScan(turn, sphere(20.0));
    auto& all = drive.scan_packets;
    all.erase(all.begin() + 40, all.begin() + 120);  // from 192 deg of the first turn to 216 deg of the second
    CaptureFile file;
    file.add(drive, 1000.0);
    EXPECT_THAT(packetsOf(read(file)), ElementsAre(40, 30, 75));
}

TEST_F(Capture, AClockThatIsSetWithinATurnCostsNoReturns) {
    for (const double jump : {0.7, 18.0, 1500.0, -900.0}) {
        Turn turn;
        turn.packets = 225;
        turn.clock = 1'000'000'000;
        VelodyneScan drive = makeScan(turn, sphere(20.0));
        CaptureFile file;
        for (std::size_t k = 0; k < drive.scan_packets.size(); ++k) {
            VelodynePacket& packet = drive.scan_packets[k];
            if (k >= 110)
                setClock(packet, packet.gps_timestamp() + static_cast<std::uint32_t>(std::lround(1e6 * jump)));
            file.add(ethernet(ipv4(payloadOf(packet))), 1000.0 + kPacket * static_cast<double>(k));
        }
        const auto scans = read(file);
        ASSERT_THAT(packetsOf(scans), ElementsAre(75, 75, 75)) << jump;
        DecodeStats stats;
        const PointCloud cloud = toPointCloud(scans[1], {}, &stats);
        EXPECT_EQ(cloud.size(), 75u * 384);
        EXPECT_GE(stats.retimed_packets, 35);
        EXPECT_NEAR(cloud.timestamp, 1000.0 + 75 * kPacket, 1e-3);
        for (std::size_t k = 0; k < 75; ++k) EXPECT_NEAR(cloud.time_offset[384 * k], kPacket * double(k), 2e-5) << k;
    }
}

TEST_F(Capture, PacketsToAnyPortAreRead) {
    CaptureFile file;
    file.add(makeScan({}, sphere(20.0)), 1000.0, 0xc0a801c9U, 2369);
    EXPECT_THAT(packetsOf(read(file)), ElementsAre(75));
    EXPECT_EQ(remarks(), "");
}

TEST_F(Capture, SensorsAreToldApartByAddressAndPort) {
    CaptureFile file;
    const VelodyneScan scan = makeScan({}, sphere(20.0));
    for (const auto& packet : scan.scan_packets) {
        file.add(ethernet(ipv4(payloadOf(packet), 2368)), 1000.0);
        file.add(ethernet(ipv4(payloadOf(packet), 2369)), 1000.0);
        file.add(ethernet(ipv4(payloadOf(packet), 2368, 0xc0a801caU)), 1000.0);
    }
    EXPECT_EQ(read(file).size(), 3u);
    EXPECT_EQ(lidarLabels(path_),
              (std::map<std::string, std::size_t>{
                  {"velodyne", 1}, {"velodyne_192.168.1.201:2369", 1}, {"velodyne_192.168.1.202", 1}}));
    InputOptions options;
    options.port = 2368;
    EXPECT_EQ(read(file, options).size(), 2u);
    EXPECT_THAT(remarks(), HasSubstr("packets to other ports left out (2369: 75)"));
    options.sender = 0xc0a801caU;
    EXPECT_EQ(read(file, options).size(), 1u);
    EXPECT_THAT(remarks(), HasSubstr("packets of other senders left out (192.168.1.201: 75)"));
}

TEST_F(Capture, FragmentsArePutTogether) {
    const VelodyneScan scan = makeScan({}, sphere(20.0));
    CaptureFile file;
    for (std::size_t k = 0; k < scan.scan_packets.size(); ++k) {
        auto fragments = ipv4Fragments(payloadOf(scan.scan_packets[k]), 552, static_cast<unsigned>(k + 1));
        ASSERT_EQ(fragments.size(), 3u);
        if (k % 3 == 1) std::swap(fragments[0], fragments[2]);
        if (k == 10) fragments.pop_back();
        if (k == 20) fragments.push_back(fragments[1]);  // twice
        for (const auto& fragment : fragments) file.add(ethernet(fragment), 1000.0 + kPacket * static_cast<double>(k));
    }
    const auto scans = read(file);
    ASSERT_THAT(packetsOf(scans), ElementsAre(74));
    EXPECT_EQ(remarks(), "1 datagrams that lack some of their fragments left out");
    EXPECT_EQ(toPointCloud(scans[0], {}).size(), 74u * 384);
}

TEST_F(Capture, PacketsThatComeTwiceAreDropped) {
    const VelodyneScan scan = makeScan({}, sphere(20.0));
    CaptureFile file;
    for (const auto& packet : scan.scan_packets) {  // a bridge: the second time with a VLAN tag
        file.add(ethernet(ipv4(payloadOf(packet))), 1000.0);
        file.add(ethernet(ipv4(payloadOf(packet)), true), 1000.0);
    }
    EXPECT_THAT(packetsOf(read(file)), ElementsAre(75));
    EXPECT_EQ(remarks(), "75 packets that came twice left out");
}

TEST_F(Capture, ThePuckHiResIsDecoded) {
    VelodyneScan scan = makeScan({}, sphere(20.0));
    for (auto& packet : scan.scan_packets) packet.velodyne_model_ID = 0x24;
    CaptureFile file;
    file.add(scan, 1000.0);
    const PointCloud cloud = toPointCloud(read(file).at(0), {});
    ASSERT_EQ(cloud.size(), 75u * 384);
    for (std::size_t i = 0; i < 32; ++i) {
        const double elevation = std::asin(cloud.xyz[i].z() / cloud.xyz[i].norm()) * 180.0 / M_PI;
        EXPECT_NEAR(elevation, -10.0 + cloud.ring[i] * 4.0 / 3.0, 1e-3) << "20 deg in 15 steps";
    }
}

TEST_F(Capture, TheVlp32cIsDecoded) {
    CaptureFile file;
    for (int k = 0; k < 151; ++k) {  // 0.2 deg and 55.296 us from block to block
        VelodynePacket packet = emptyPacket(1000 + static_cast<std::uint32_t>(std::lround(k * 12 * 55.296)), 0x28);
        for (int b = 0; b < 12; ++b) {
            setBlock(packet, b, static_cast<unsigned>(20 * (12 * k + b)));
            for (int laser = 0; laser < 32; ++laser) setReturn(packet, b, laser, 5000);
        }
        file.add(ethernet(ipv4(payloadOf(packet))), 1000.0 + k * 12 * 55.296e-6);
    }
    const auto scans = read(file);
    ASSERT_EQ(packetsOf(scans).at(0), 150u);
    const PointCloud cloud = toPointCloud(scans[0], {});
    const auto azimuth = [&](std::size_t i) { return std::atan2(-cloud.xyz[i].y(), cloud.xyz[i].x()) * 180.0 / M_PI; };
    EXPECT_NEAR(cloud.xyz[0].norm(), 20.0, 1e-4) << "its unit is 4 mm";
    EXPECT_EQ(cloud.ring[0], 0) << "the first laser looks down 25 deg";
    EXPECT_NEAR(azimuth(0), 1.4, 1e-3) << "and beside the block's azimuth";
    EXPECT_NEAR(cloud.time_offset[2], 2.304e-6, 1e-9) << "two lasers fire at a time";
    EXPECT_EQ(cloud.ring[29], 31) << "the highest: 15 deg";
    EXPECT_NEAR(azimuth(29), -1.4 + 0.2 * 14 * 2.304 / 55.296, 1e-3);
    std::map<int, int> returns;  // neighbours in the view look the same way
    for (int ring = 0; ring < 32; ++ring) {
        const std::int32_t i = cloud.view.at(ring, 300);
        ASSERT_GE(i, 0);
        EXPECT_NEAR(azimuth(static_cast<std::size_t>(i)), 60.0, 0.3) << ring;
    }
}

TEST_F(Capture, WhatIsNotDecodedIsNamed) {
    CaptureFile file;
    file.add(ethernet(ipv4(payloadOf(emptyPacket(0, 0xa1)))), 1000.0);
    file.add(ethernet(ipv4(payloadOf(emptyPacket(0, 0x5c)))), 1000.0);
    VelodynePacket hdl64 = emptyPacket(0, 0x22);
    setBlock(hdl64, 1, 0, 0xddff);
    file.add(ethernet(ipv4(payloadOf(hdl64))), 1000.0);
    EXPECT_TRUE(read(file).empty());
    EXPECT_THAT(remarks(), HasSubstr("1 packets of model 0xa1 (VLS-128), which is not decoded, left out"));
    EXPECT_THAT(remarks(), HasSubstr("1 packets of unknown model 0x5c (--sensor-model says what it is: vlp-16"));
    EXPECT_THAT(remarks(), HasSubstr("1 packets of a sensor with more than 32 lasers"));
}

TEST_F(Capture, TheModelCanBeSaid) {
    VelodyneScan scan = makeScan({}, sphere(20.0));
    for (auto& packet : scan.scan_packets) packet.velodyne_model_ID = 0;
    CaptureFile file;
    file.add(scan, 1000.0);
    InputOptions options;
    options.sensor_model = "vlp-16";
    EXPECT_EQ(toPointCloud(read(file, options).at(0), {}).size(), 75u * 384);
    options.sensor_model = "vlp-61";
    EXPECT_THROW(openScanSource(path_, options), std::invalid_argument);
}

TEST_F(Capture, PacketsCutShortAreToldWithTheirLength) {
    CaptureFile file(CaptureFile::kEthernet, 96);
    file.add(makeScan({}, sphere(20.0)), 1000.0);
    EXPECT_TRUE(read(file).empty());
    EXPECT_THAT(remarks(), HasSubstr("75 packets cut short by the capture"));
    EXPECT_THAT(remarks(), HasSubstr("96 bytes"));
}

TEST_F(Capture, OfAnotherSensorSaysWhatItHolds) {
    CaptureFile file;
    for (int k = 0; k < 5; ++k) file.add(ethernet(ipv4(std::string(1248, 'r'), 6699)), 1000.0 + k);
    file.add(ethernet(ipv4("name?", 53)), 1000.0);
    EXPECT_TRUE(read(file).empty());
    EXPECT_THAT(remarks(), HasSubstr("1248 bytes to port 6699 (5 of them)"));
}

TEST_F(Capture, OptionsOfCapturesFitNoRawlog) {
    writeFile(path_, "");
    InputOptions options;
    options.port = 2369;
    EXPECT_THROW(openScanSource(path_, options), std::invalid_argument);
}

TEST_F(Capture, APipeIsRefusedBecauseItCanBeReadOnceOnly) {
    ASSERT_EQ(mkfifo(path_.c_str(), 0600), 0);
    try {
        openScanSource(path_);
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_THAT(e.what(), HasSubstr("a pipe can be read once only"));
    }
}

}  // namespace
}  // namespace lidar_obstacles
