// SPDX-License-Identifier: BSD-3-Clause
// Captures as people really have them: other ports and models, fragments, duplicates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <map>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/pcap_reader.h"
#include "support/capture_fixture.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

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

TEST_F(Capture, FragmentsOfASenderThatDoesNotCountAreToldApart) {
    const VelodyneScan scan = makeScan({}, wallAt(10.0));
    CaptureFile file;
    for (std::size_t k = 0; k < scan.scan_packets.size(); ++k) {
        auto fragments = ipv4Fragments(payloadOf(scan.scan_packets[k]), 552, 0);
        if (k == 10) fragments.erase(fragments.begin() + 1);
        if (k == 20) fragments.push_back(fragments[1]);  // twice
        for (const auto& fragment : fragments) file.add(ethernet(fragment), 1000.0 + kPacket * static_cast<double>(k));
    }
    EXPECT_THAT(packetsOf(read(file)), ElementsAre(74));
    EXPECT_EQ(remarks(), "1 datagrams that lack some of their fragments left out");
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

TEST_F(Capture, WhatIsNotSentOverIpv4IsNamed) {
    const std::string payload = payloadOf(emptyPacket(0));
    const auto length = static_cast<std::uint32_t>(payload.size() + 8);
    const std::string ipv6 = big(0x60000000U, 4) + big(length, 2) + big(0x1140, 2) + std::string(32, '\1') +
                             big(2368, 2) + big(2368, 2) + big(length, 2) + big(0, 2) + payload;
    const auto frame = [](std::uint32_t type, const std::string& data) {
        return std::string(12, '\x11') + big(type, 2) + data;
    };
    CaptureFile over_ipv6, others;
    over_ipv6.add(frame(0x86dd, ipv6), 1000.0);
    EXPECT_TRUE(read(over_ipv6).empty());
    EXPECT_THAT(remarks(), HasSubstr("1 packets over IPv6 left out: only IPv4 is read"));
    others.add(frame(0x8864, big(0x11000001U, 4) + big(1300, 2) + big(0x21, 2) + ipv4(payload)), 1000.0);
    others.add(frame(0x0806, std::string(28, '\0')), 1000.0);
    EXPECT_TRUE(read(others).empty());
    EXPECT_THAT(remarks(), HasSubstr("no UDP datagrams over IPv4 in it (but ARP: 1, PPPoE: 1)"));
    CaptureFile mixed;
    mixed.add(makeScan({}, sphere(20.0)), 1000.0);
    mixed.add(frame(0x0806, std::string(28, '\0')), 1000.0);
    EXPECT_EQ(read(mixed).size(), 1U);
    EXPECT_EQ(remarks(), "") << "ARP is usual";
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
