// SPDX-License-Identifier: BSD-3-Clause
// Where turns of a capture begin and end: gaps of the view, bursts, losses, clocks that jump.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "support/capture_fixture.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

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

TEST_F(Capture, EveryTurnSeesAllAroundOnceAlsoWhereAPacketPassesItsEnd) {
    constexpr int kStep = 41;  // a packet in 74 passes azimuth zero, each time elsewhere
    Turn turn;
    turn.step = kStep;
    turn.packets = 450;
    CaptureFile file;
    file.add(makeScan(turn, sphere(20.0)), 1000.0);
    const auto scans = read(file);
    ASSERT_EQ(scans.size(), 7U);
    std::size_t returns = 0;
    for (std::size_t k = 0; k < scans.size(); ++k) {
        const PointCloud cloud = toPointCloud(scans[k], {});
        returns += cloud.size();
        if (k == 0 || k + 1 == scans.size()) continue;
        EXPECT_NEAR(static_cast<double>(cloud.size()), 32.0 * 36000 / kStep, 64.0) << k;
        std::vector<double> azimuths;
        azimuths.reserve(cloud.size());
        for (const auto& p : cloud.xyz) azimuths.push_back(std::atan2(p.y(), p.x()) * 180.0 / M_PI);
        std::sort(azimuths.begin(), azimuths.end());
        for (std::size_t i = 1; i < azimuths.size(); ++i)
            ASSERT_LT(azimuths[i] - azimuths[i - 1], 0.45) << k << ": a gap at " << azimuths[i];
    }
    EXPECT_EQ(returns, 32U * 12U * 450U) << "none lost, none twice";
}

TEST_F(Capture, APacketThatBridgesTheGapOfTheFieldOfViewIsOfBothTurns) {
    Turn turn;
    turn.packets = 750;
    const VelodyneScan drive = makeScan(turn, sphere(20.0));
    VelodyneScan sent;  // blocks from 60 degrees on either side of the x axis, packed without regard to the gap
    int block = 12;
    for (const auto& packet : drive.scan_packets)
        for (const auto& b : packet.blocks) {
            if (b.rotation() > 6000 && b.rotation() < 30000) continue;
            if (block == 12) sent.scan_packets.push_back(packet), block = 0;
            sent.scan_packets.back().blocks[block++] = b;
        }
    sent.scan_packets.pop_back();
    CaptureFile file;
    for (const auto& packet : sent.scan_packets)
        file.add(ethernet(ipv4(payloadOf(packet))), 1000.0 + 1e-6 * packet.gps_timestamp());
    const auto scans = read(file);
    ASSERT_GE(scans.size(), 9U);
    for (std::size_t k = 1; k + 1 < scans.size(); ++k)
        EXPECT_NEAR(static_cast<double>(toPointCloud(scans[k], {}).size()), 301.0 * 32, 33.0) << k;
}

TEST_F(Capture, WhatIsLeftOfALastTurnAllAroundIsAScan) {
    Turn turn;
    turn.packets = 175;
    CaptureFile file;
    file.add(makeScan(turn, sphere(20.0)), 1000.0);
    EXPECT_THAT(packetsOf(read(file)), ElementsAre(75, 75, 25));
    EXPECT_EQ(remarks(), "");
}

TEST_F(Capture, OfALastTurnAllAroundASliverIsNoScan) {
    // the ground is not found in 24 degrees, and its rings would be told as things
    Turn turn;
    turn.packets = 155;
    CaptureFile file;
    file.add(makeScan(turn, sphere(20.0)), 1000.0);
    EXPECT_THAT(packetsOf(read(file)), ElementsAre(75, 75));
    EXPECT_THAT(remarks(), HasSubstr("5 packets of the turn that the end of the capture cuts off left out"));
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

/// When the scans began, after the first [s].
std::vector<double> beginsOf(const std::vector<VelodyneScan>& scans) {
    std::vector<double> begins;
    for (const auto& scan : scans)
        begins.push_back(mrpt::Clock::toDouble(scan.timestamp) - mrpt::Clock::toDouble(scans[0].timestamp));
    return begins;
}

TEST_F(Capture, TurnsOfABurstAreAsFarApartAsTheSensorMadeThem) {
    Turn turn;
    turn.packets = 450;
    const VelodyneScan drive = makeScan(turn, sphere(20.0));
    for (const double burst : {0.35, 1e9}) {  // of a radio link; of a capture without times
        CaptureFile file;
        for (std::size_t k = 0; k < drive.scan_packets.size(); ++k) {
            const double sent = kPacket * static_cast<double>(k);
            const double arrived = burst * std::floor(sent / burst + 1.0);
            file.add(ethernet(ipv4(payloadOf(drive.scan_packets[k]))), 1000.0 + arrived);
        }
        const std::vector<double> begins = beginsOf(read(file));
        ASSERT_EQ(begins.size(), 6U);
        for (std::size_t k = 0; k < begins.size(); ++k) EXPECT_NEAR(begins[k], 75 * kPacket * k, 0.021) << burst;
    }
}

TEST_F(Capture, StampsFollowTheCaptureWhereTheClockIsSet) {
    Turn turn;
    turn.packets = 300;
    VelodyneScan drive = makeScan(turn, sphere(20.0));
    CaptureFile file;
    for (std::size_t k = 0; k < drive.scan_packets.size(); ++k) {
        VelodynePacket packet = drive.scan_packets[k];
        if (k >= 150) setClock(packet, packet.gps_timestamp() + 730'000);
        file.add(ethernet(ipv4(payloadOf(packet))), 1000.0 + kPacket * static_cast<double>(k));
    }
    const std::vector<double> begins = beginsOf(read(file));
    ASSERT_EQ(begins.size(), 4U);
    for (std::size_t k = 0; k < begins.size(); ++k) EXPECT_NEAR(begins[k], 75 * kPacket * k, 1e-4);
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

TEST_F(Capture, TurnsThatLookAlikeByAClockThatStandsStillComeOnce) {
    Turn turn;
    turn.packets = 225;
    VelodyneScan drive = makeScan(turn, wallAt(10.0));
    CaptureFile file;
    for (std::size_t k = 0; k < drive.scan_packets.size(); ++k) {
        setClock(drive.scan_packets[k], 0);
        file.add(ethernet(ipv4(payloadOf(drive.scan_packets[k]))), 1000.0 + kPacket * static_cast<double>(k));
    }
    EXPECT_THAT(packetsOf(read(file)), ElementsAre(75, 75, 75));
}

}  // namespace
}  // namespace lidar_obstacles
