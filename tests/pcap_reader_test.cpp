// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/pcap_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CFileGZOutputStream.h>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "support/capture_files.h"
#include "support/temp_folder.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using testing::HasSubstr;

class Pcap : public testing::Test {
  protected:
    std::vector<VelodyneScan> read(const std::string& content) {
        writeFile(path_, content);
        return read();
    }
    std::vector<VelodyneScan> read() {
        source_ = openScanSource(path_);
        EXPECT_NE(dynamic_cast<PcapReader*>(source_.get()), nullptr);
        std::vector<VelodyneScan> scans;
        while (const auto item = source_->next()) {
            EXPECT_EQ(item->object, scans.size());
            scans.push_back(dynamic_cast<const VelodyneScan&>(*item->observation));
        }
        return scans;
    }

    void writeCompressed(const std::string& content) const {
        mrpt::io::CFileGZOutputStream(path_).Write(content.data(), content.size());
    }

    TempFolder folder_;
    std::string path_ = folder_.file("capture.dat");  // what it is shows in its content, not in its name
    std::unique_ptr<ScanSource> source_;
};

/// Two and a half turns from azimuth 90 deg on: a partial, a full and a partial scan.
VelodyneScan longDrive() {
    Turn turn;
    turn.start = 9000;
    turn.packets = 187;
    return makeScan(turn, sphere(20.0));
}

TEST_F(Pcap, IsCutIntoTurnsWhereTheAzimuthPassesZero) {
    CaptureFile file;
    file.add(longDrive(), 1000.0);
    const auto scans = read(file.content());
    ASSERT_EQ(scans.size(), 3u);
    // 4.8 deg per packet: 270 deg left of the first turn are 56.25 packets; what passes zero is in two scans.
    EXPECT_EQ(scans[0].scan_packets.size(), 57u);
    EXPECT_EQ(scans[1].scan_packets.size(), 76u);
    EXPECT_EQ(scans[2].scan_packets.size(), 56u);
    EXPECT_EQ(scans[0].sensorLabel, "velodyne");
    EXPECT_EQ(scans[0].calibration.laser_corrections.size(), 16u);
    EXPECT_EQ(source_->status(), SourceStatus::End);
    EXPECT_EQ(source_->objects(), 3u);
    EXPECT_EQ(source_->remarks(), "");
    EXPECT_EQ(source_->progress(), 1.0);
}

TEST_F(Pcap, ScansCarryTheCaptureTimeOfTheirFirstPacket) {
    CaptureFile file;
    file.add(longDrive(), 1000.0);
    const auto scans = read(file.content());
    ASSERT_EQ(scans.size(), 3u);
    EXPECT_NEAR(mrpt::Clock::toDouble(scans[0].timestamp), 1000.0, 2e-6);
    EXPECT_NEAR(mrpt::Clock::toDouble(scans[1].timestamp), 1000.0 + 56 * 12 * 110.592e-6, 2e-6);
}

TEST_F(Pcap, LatePacketsDoNotEndATurn) {
    VelodyneScan drive = longDrive();
    std::swap(drive.scan_packets[30], drive.scan_packets[31]);
    std::swap(drive.scan_packets[56], drive.scan_packets[57]);  // across the end of the first turn
    CaptureFile file;
    double time = 1000.0;
    for (const auto& packet : drive.scan_packets) file.add(ethernet(ipv4(payloadOf(packet))), time += 0.001327);
    const auto scans = read(file.content());
    ASSERT_EQ(scans.size(), 3u);
    EXPECT_EQ(scans[0].scan_packets.size(), 56u);
    EXPECT_EQ(scans[1].scan_packets.size(), 76u) << "the late packet goes with the turn that has begun";
}

TEST_F(Pcap, APauseEndsATurn) {
    Turn turn;
    turn.packets = 10;
    CaptureFile file;
    file.add(makeScan(turn, sphere(20.0)), 1000.0);
    turn.start = 20000;
    file.add(makeScan(turn, sphere(20.0)), 1005.0);
    EXPECT_EQ(read(file.content()).size(), 2u);
}

TEST_F(Pcap, VlanCookedAndRawFramesHoldTheSamePackets) {
    const VelodyneScan scan = makeScan({}, sphere(20.0));
    CaptureFile vlan, cooked_frames(CaptureFile::kCooked), raw(CaptureFile::kRawIp);
    double time = 1000.0;
    for (const auto& packet : scan.scan_packets) {
        const std::string ip = ipv4(payloadOf(packet));
        vlan.add(ethernet(ip, true), time);
        cooked_frames.add(cooked(ip), time);
        raw.add(ip, time);
        time += 0.001;
    }
    for (const CaptureFile* file : {&vlan, &cooked_frames, &raw}) {
        const auto scans = read(file->content());
        ASSERT_EQ(scans.size(), 1u);
        EXPECT_EQ(scans[0].scan_packets.size(), 75u);
        EXPECT_EQ(toPointCloud(scans[0], {}).size(), 75u * 384);
    }
}

TEST_F(Pcap, OtherTrafficIsIgnored) {
    CaptureFile file;
    file.add(ethernet(ipv4(std::string(512, 'p'), 8308)), 1000.0);  // position packets
    file.add(ethernet(ipv4("short")), 1000.0);
    file.add(std::string(60, '\x55'), 1000.0);  // not IP at all
    file.add("x", 1000.0);
    file.add(makeScan({}, sphere(20.0)), 1000.0);
    const auto scans = read(file.content());
    ASSERT_EQ(scans.size(), 1u);
    EXPECT_EQ(scans[0].scan_packets.size(), 75u);
    EXPECT_EQ(source_->remarks(), "");
}

TEST_F(Pcap, PacketsCutShortByTheCaptureAreCounted) {
    CaptureFile file(CaptureFile::kEthernet, 600);
    file.add(makeScan({}, sphere(20.0)), 1000.0);
    EXPECT_TRUE(read(file.content()).empty());
    EXPECT_EQ(source_->status(), SourceStatus::End);
    EXPECT_THAT(source_->remarks(), HasSubstr("75 packets cut short"));
}

TEST_F(Pcap, PacketsOfUnknownModelsAreCounted) {
    CaptureFile file;
    file.add(ethernet(ipv4(payloadOf(emptyPacket(0, 0x00)))), 1000.0);
    EXPECT_TRUE(read(file.content()).empty());
    EXPECT_THAT(source_->remarks(), HasSubstr("1 packets of unknown"));
}

TEST_F(Pcap, SeveralSensorsAreToldApartByTheirAddress) {
    const VelodyneScan scan = makeScan({}, sphere(20.0));
    CaptureFile file;
    double time = 1000.0;
    for (const auto& packet : scan.scan_packets) {
        file.add(ethernet(ipv4(payloadOf(packet))), time);
        file.add(ethernet(ipv4(payloadOf(packet), 2368, 0xc0a801caU)), time += 0.0013);
    }
    EXPECT_EQ(read(file.content()).size(), 2u);
    EXPECT_EQ(lidarLabels(path_), (std::map<std::string, std::size_t>{{"velodyne", 1}, {"velodyne_192.168.1.202", 1}}));
}

TEST_F(Pcap, AFileCutInsideAPacketIsDamagedAndKeepsWhatCameBefore) {
    CaptureFile file;
    file.add(longDrive(), 1000.0);
    const auto scans = read(file.content().substr(0, file.content().size() - 100));
    EXPECT_EQ(scans.size(), 3u);
    EXPECT_EQ(source_->status(), SourceStatus::Damaged);
    EXPECT_THAT(source_->message(), HasSubstr(path_));
    EXPECT_THAT(source_->message(), HasSubstr("packet 186"));
}

TEST_F(Pcap, WithoutPacketsEndsAtObjectZero) {
    EXPECT_TRUE(read(CaptureFile().content()).empty());
    EXPECT_EQ(source_->status(), SourceStatus::End);
    EXPECT_EQ(source_->objects(), 0u);
}

TEST_F(Pcap, ThatCannotBeReadIsAnErrorThatNamesTheFile) {
    const auto expectError = [this](const std::string& content, const std::string& reason) {
        writeFile(path_, content);
        try {
            openScanSource(path_);
            FAIL() << reason;
        } catch (const std::runtime_error& e) {
            EXPECT_THAT(e.what(), HasSubstr(path_));
            EXPECT_THAT(e.what(), HasSubstr(reason));
        }
    };
    expectError(CaptureFile().content().substr(0, 10), "truncated");
    expectError(CaptureFile(127).content(), "link type 127 (802.11 plus radiotap header)");
}

TEST_F(Pcap, ACompressedOneIsReadLikeAPlainOne) {
    CaptureFile capture;
    for (int turn = 0; turn < 3; ++turn) capture.add(makeScan({}, wallAt(10.0)), 1000.0 + 0.1 * turn);
    writeCompressed(capture.content());
    EXPECT_EQ(read().size(), 3u);
    EXPECT_EQ(source_->status(), SourceStatus::End) << source_->message();
    EXPECT_EQ(source_->progress(), 1.0);
}

TEST_F(Pcap, ACompressedOneThatIsCutOffIsDamagedAndGivesWhatItHolds) {
    CaptureFile capture;
    for (int turn = 0; turn < 3; ++turn) capture.add(makeScan({}, wallAt(10.0)), 1000.0 + 0.1 * turn);
    writeCompressed(capture.content());
    const std::string whole = readFile(path_);
    writeFile(path_, whole.substr(0, whole.size() * 2 / 3));
    EXPECT_GE(read().size(), 1u);
    EXPECT_EQ(source_->status(), SourceStatus::Damaged);
    EXPECT_THAT(source_->message(), HasSubstr("the compressed file is cut off"));
}

/// Packets, scans, and the returns of a full turn of the recorded captures.
void expectCapture(const std::string& path, const std::vector<std::size_t>& packets) {
    const auto source = openScanSource(path);
    std::vector<std::size_t> found;
    double last = 0.0;
    while (const auto item = source->next()) {
        const auto& scan = dynamic_cast<const VelodyneScan&>(*item->observation);
        found.push_back(scan.scan_packets.size());
        const double time = mrpt::Clock::toDouble(scan.timestamp);
        EXPECT_TRUE(last == 0.0 || (time > last && time < last + 0.21)) << "turns at 10 Hz, one may be missing";
        last = time;
    }
    EXPECT_EQ(found, packets);
    EXPECT_EQ(source->status(), SourceStatus::End) << source->message();
}

TEST(PcapLabelled, TheVlp16CaptureHoldsFiveTurns) {
    LIDAR_OBSTACLES_NEED(path, labelledData("velodyne_vlp16_gps.pcap"));
    expectCapture(path, {51, 77, 76, 76, 16});  // 293 data packets, of which three are in two turns
}

TEST(PcapLabelled, TheHdl32CaptureHoldsFourTurns) {
    LIDAR_OBSTACLES_NEED(path, labelledData("velodyne_hdl32.pcap"));
    expectCapture(path, {77, 201, 201, 24});  // 500 data packets, of which three are in two turns
}

}  // namespace
}  // namespace lidar_obstacles
