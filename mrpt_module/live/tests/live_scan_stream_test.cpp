// SPDX-License-Identifier: BSD-3-Clause
// Datagrams to scans: every count against what the test itself did to the stream.
#include "lidar_obstacles/live/scan_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "stream_fixture.h"

namespace lidar_obstacles::live {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST_F(Stream, ScansAreCutBehindTheVehicle) {
    addPackets(0, 300);  // four turns of 75 packets from azimuth 0 on
    ASSERT_EQ(scans_.size(), 4u);
    EXPECT_EQ(packetsOf(0), 38u) << "half a turn: 4.8 deg per packet, 180 deg = 37.5 packets";
    for (const std::size_t k : {1u, 2u, 3u}) {
        EXPECT_EQ(packetsOf(k), 75u);
        EXPECT_GE(firstAzimuth(k), 18000u);
        EXPECT_LT(firstAzimuth(k), 18480u) << "within a packet of the cut";
    }
}

TEST_F(Stream, ScansAreCutWhereAsked) {
    for (const double cut : {0.0, 90.0, -90.0, 270.0, 359.0}) {
        options_.cut_azimuth_deg = cut;
        stream_ = ScanStream(options_);
        scans_.clear();
        addPackets(0, 300);
        ASSERT_GE(scans_.size(), 3u);
        const double wanted = cut < 0.0 ? cut + 360.0 : cut;
        const double begins = 0.01 * firstAzimuth(2);
        EXPECT_LT(std::fmod(begins - wanted + 360.0, 360.0), 4.8) << cut;
    }
}

TEST_F(Stream, AScanTellsStampPoseLabelAndArrivalOfItsLastPacket) {
    options_.sensor_pose = mrpt::poses::CPose3D(1, 0, 1.8, 0, 0, 0);
    options_.sensor_label = "roof";
    stream_ = ScanStream(options_);
    addPackets(0, 150);
    ASSERT_EQ(scans_.size(), 2u);
    const auto& scan = *scans_[1].observation;
    EXPECT_NEAR(mrpt::Clock::toDouble(scan.timestamp), at(38), 2e-6);
    EXPECT_NEAR(scans_[1].last_arrival, at(112), 1e-9);
    EXPECT_EQ(scans_[1].index, 1u);
    EXPECT_EQ(scan.sensorLabel, "roof");
    EXPECT_DOUBLE_EQ(scan.sensorPose.z(), 1.8);
    EXPECT_EQ(toPointCloud(scan, {}).sensor_origin.z(), 1.8f);
}

TEST_F(Stream, ACleanStreamHasNoFaults) {
    addPackets(0, 3000);
    EXPECT_EQ(counts().packets, 3000u);
    for (const std::size_t n : {counts().lost, counts().late, counts().duplicates, counts().malformed, counts().foreign,
                                counts().unclear, counts().outages, counts().mode_changes, counts().restarts})
        EXPECT_EQ(n, 0u);
    EXPECT_THAT(stream_.takeReports(), ElementsAre(HasSubstr("data of a VLP-16 (strongest return)")));
}

TEST_F(Stream, LostPacketsAreCountedByTheClockAndToldOnce) {
    addPackets(0, 100);
    stream_.takeReports();
    addPackets(103, 200);  // three lost
    addPackets(201, 300);  // one lost
    EXPECT_EQ(counts().lost, 4u);
    EXPECT_THAT(stream_.takeReports(), ElementsAre(HasSubstr("3 packets lost")));
}

TEST_F(Stream, PacketsThatWaitedOnTheWayAreNotLost) {
    addPackets(0, 100);
    stream_.takeReports();
    const int held = 1300;  // a link held back 1.6 s of them and sends them in a burst
    for (int k = 100; k < held; ++k) add(datagramOf(packetNumber(k), at(held) + 1e-5 * (k - held)));
    addPackets(held, held + 100);
    EXPECT_EQ(counts().packets, static_cast<std::size_t>(held) + 100u);
    EXPECT_EQ(counts().lost + counts().unclear + counts().restarts + counts().late, 0u);
    EXPECT_THAT(stream_.takeReports(), IsEmpty());
}

TEST_F(Stream, LatePacketsAreUsedAndNotLost) {
    addPackets(0, 100);
    for (const int k : {101, 102, 100, 104, 103}) add(datagramOf(packetNumber(k), at(k)));
    addPackets(105, 200);
    EXPECT_EQ(counts().late, 2u);
    EXPECT_EQ(counts().lost, 0u);
    EXPECT_EQ(counts().packets, 200u);
    EXPECT_EQ(scans_.size(), 3u) << "and end no scan";
}

TEST_F(Stream, PacketsThatComeTwiceAreLeftOut) {
    for (int k = 0; k < 200; ++k) {
        add(datagramOf(packetNumber(k), at(k)));
        if (k % 10 == 0) add(datagramOf(packetNumber(k), at(k)));
        if (k % 10 == 5) add(datagramOf(packetNumber(k - 3), at(k)));
    }
    EXPECT_EQ(counts().duplicates, 40u);
    EXPECT_EQ(counts().packets, 200u);
    EXPECT_EQ(packetsOf(1), 75u);
}

TEST_F(Stream, AllFaultsAtOnceAreCountedRight) {
    std::mt19937 random(7);
    std::size_t lost = 0, twice = 0, garbage = 0;
    for (int k = 0; k < 20000; ++k) {
        const auto u = random() % 100;
        if (u < 5 && k > 0 && k < 19999) {
            ++lost;
            continue;
        }
        add(datagramOf(packetNumber(k), at(k)));
        if (u >= 95) add(datagramOf(packetNumber(k), at(k))), ++twice;
        if (u >= 90 && u < 95) {
            Datagram d = datagramOf(packetNumber(k), at(k));
            d.bytes[100 * (random() % 12)] ^= 0x01U;
            if (random() % 2) d.length = random() % 1206;
            add(d);
            ++garbage;
        }
    }
    EXPECT_EQ(counts().lost, lost);
    EXPECT_EQ(counts().duplicates, twice);
    EXPECT_EQ(counts().malformed, garbage);
    EXPECT_EQ(counts().packets, 20000u - lost);
    EXPECT_EQ(counts().unclear + counts().restarts + counts().mode_changes + counts().foreign, 0u);
}

TEST_F(Stream, TheHourOfTheClockPassesUnnoticed) {
    const int before = static_cast<int>(3600.0 / kPeriod) - 100;
    addPackets(before, before + 300);
    EXPECT_EQ(counts().packets, 300u);
    EXPECT_EQ(counts().lost + counts().restarts + counts().unclear, 0u);
}

TEST_F(Stream, ARestartIsToldOnceAndSurvived) {
    const double up = 2000.0;  // it has been running for so long [s]
    for (int k = 0; k < 200; ++k) {
        VelodynePacket p = packetNumber(k);
        setClock(p, 1e6 * (up + kPeriod * k));
        add(datagramOf(p, at(k)));
    }
    stream_.takeReports();
    for (int k = 0; k < 200; ++k) add(datagramOf(packetNumber(k), at(200 + k) + 0.05));
    EXPECT_EQ(counts().restarts, 1u);
    EXPECT_EQ(counts().unclear, 2u) << "the third packet in a row proves it";
    EXPECT_EQ(counts().lost, 0u);
    EXPECT_EQ(counts().packets, 398u);
    EXPECT_THAT(stream_.takeReports(), ElementsAre(HasSubstr("clock fits no other"), HasSubstr("restarted")));
}

TEST_F(Stream, OnePacketWithAWrongClockIsNoRestart) {
    addPackets(0, 100);
    VelodynePacket p = packetNumber(100);
    setClock(p, 1e9);
    add(datagramOf(p, at(100)));
    addPackets(101, 200);
    EXPECT_EQ(counts().restarts, 0u);
    EXPECT_EQ(counts().unclear, 1u);
    EXPECT_EQ(counts().lost, 1u);
}

TEST_F(Stream, AChangedReturnModeIsToldOnce) {
    addPackets(0, 100);
    stream_.takeReports();
    for (int k = 0; k < 100; ++k) {
        VelodynePacket p = packetNumber(k, 0x39, kPeriod / 2);
        setClock(p, 1e6 * kPeriod * (100 + 0.5 * k));
        add(datagramOf(p, at(100) + 0.5 * kPeriod * k));
    }
    EXPECT_EQ(counts().mode_changes, 1u);
    EXPECT_EQ(counts().lost + counts().unclear + counts().restarts, 0u);
    EXPECT_THAT(stream_.takeReports(), ElementsAre(HasSubstr("return mode changed to dual")));
}

TEST_F(Stream, SilenceIsToldOnceAndEndsTheScan) {
    addPackets(0, 50);
    stream_.takeReports();
    EXPECT_FALSE(stream_.idle(at(50))) << "nothing is over yet";
    const auto scan = stream_.idle(at(50) + 0.2);
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->observation->scan_packets.size(), 12u);
    for (double s = 1.0; s < 10.0; s += 0.05) EXPECT_FALSE(stream_.idle(at(50) + s));
    EXPECT_EQ(counts().outages, 1u);
    EXPECT_THAT(stream_.takeReports(), ElementsAre(HasSubstr("no data for 2.0 s")));
    const int later = 50 + static_cast<int>(10.0 / kPeriod);
    addPackets(later, later + 50);
    EXPECT_EQ(counts().lost, static_cast<std::size_t>(later - 50)) << "its clock ran on: it was sending";
    EXPECT_EQ(counts().restarts, 0u);
    EXPECT_THAT(stream_.takeReports(), testing::Contains(HasSubstr("data of a VLP-16")));
}

TEST_F(Stream, AClockOfTheSystemThatIsSetCostsNoPacketAndIsNoSilence) {
    addPackets(0, 100);
    stream_.takeReports();
    for (const double set : {-3600.0, 3600.0, -0.1, 25.0}) {  // by NTP or GPS [s]
        const int from = static_cast<int>(counts().packets);
        for (int k = from; k < from + 100; ++k) {
            Datagram d = datagramOf(packetNumber(k), at(k));
            d.time += set;
            add(d);
            EXPECT_FALSE(stream_.idle(at(k)));
        }
        EXPECT_EQ(counts().packets, static_cast<std::size_t>(from) + 100u) << set;
    }
    EXPECT_EQ(counts().lost + counts().unclear + counts().restarts + counts().late + counts().outages, 0u);
    EXPECT_THAT(stream_.takeReports(), IsEmpty());
}

TEST_F(Stream, NoDataFromTheStartIsTold) {
    stream_.idle(100.0);
    stream_.idle(101.0);
    EXPECT_THAT(stream_.takeReports(), IsEmpty());
    stream_.idle(102.1);
    stream_.idle(110.0);
    EXPECT_THAT(stream_.takeReports(), ElementsAre(HasSubstr("no data for")));
}

TEST_F(Stream, OtherSendersAndModelsAreForeign) {
    addPackets(0, 10);
    stream_.takeReports();
    for (int k = 10; k < 20; ++k) {
        add(datagramOf(packetNumber(k), at(k), kSensor + 1));
        VelodynePacket hdl = packetNumber(k);
        hdl.velodyne_model_ID = 0x21;
        add(datagramOf(hdl, at(k)));
        add(datagramOf(packetNumber(k), at(k)));
    }
    EXPECT_EQ(counts().foreign, 20u);
    EXPECT_EQ(counts().packets, 20u);
    EXPECT_THAT(stream_.takeReports(), ElementsAre(HasSubstr("192.168.1.202")));
}

TEST_F(Stream, OnlyTheAllowedSenderIsListenedTo) {
    options_.sender = kSensor;
    stream_ = ScanStream(options_);
    add(datagramOf(packetNumber(0), at(0), kSensor + 1));
    Datagram junk = datagramOf(packetNumber(0), at(0), kSensor + 1);
    junk.bytes[0] = 0;
    add(junk);
    EXPECT_EQ(counts().foreign, 2u);
    addPackets(0, 10);
    EXPECT_EQ(counts().packets, 10u);
}

/// A packet as `packetNumber`, its clock off by so much [us].
VelodynePacket forged(int k, double clock_off, std::uint8_t mode = 0x37) {
    VelodynePacket packet = packetNumber(k, mode);
    setClock(packet, 1e6 * kPeriod * k + clock_off + 3600e6);
    return packet;
}

TEST_F(Stream, HostileTrafficAtTenTimesTheRateCostsNoGoodPacket) {
    constexpr int kGood = 4000;  // 5 s
    std::mt19937 random(3);
    std::size_t foreign = 0, malformed = 0, replayed = 0, forged_clocks = 0;
    for (int k = 0; k < kGood; ++k) {
        add(datagramOf(packetNumber(k), at(k)));
        for (int j = 1; j <= 10; ++j) {
            const double now = at(k) + kPeriod * j / 11;
            Datagram d = datagramOf(packetNumber(k), now);
            if (j <= 2) {
                d.sender = kSensor + static_cast<std::uint32_t>(j), ++foreign;
            } else if (j <= 4) {
                d.length = j == 3 ? 0 : 1207 + random() % 60000, ++malformed;
            } else if (j <= 6 && k > 3000) {
                d = datagramOf(packetNumber(k - (j == 5 ? 700 : 3000)), now), ++replayed;  // 0.9 s, 4 s ago
            } else if (j == 7) {
                d = datagramOf(forged(k, 1e9), now), ++forged_clocks;  // a sensor that goes on by a clock of its own
            } else if (j == 8) {
                d = datagramOf(forged(10 * k, 1.5e9, 0x39), now), ++forged_clocks;  // of another mode, and faster
            } else {
                const double off = 5e6 + 1e6 * (random() % 3000);
                d = datagramOf(forged(k, j == 9 ? off : 30e3 + 10.0 * (random() % 90000)), now), ++forged_clocks;
            }
            add(d);
        }
    }
    EXPECT_EQ(counts().foreign, foreign);
    EXPECT_EQ(counts().malformed, malformed);
    EXPECT_EQ(counts().packets, static_cast<std::size_t>(kGood));
    EXPECT_EQ(counts().duplicates + counts().unclear, counts().datagrams - kGood - foreign - malformed);
    EXPECT_GE(counts().duplicates, replayed / 2);
    EXPECT_GE(counts().unclear, forged_clocks + replayed / 2);
    EXPECT_EQ(counts().lost + counts().late + counts().restarts + counts().mode_changes + counts().outages, 0u);
    EXPECT_EQ(scans_.size(), 53u) << "4000 packets: half a turn and 52 whole ones";
    for (std::size_t k = 1; k < scans_.size(); ++k) EXPECT_EQ(packetsOf(k), 75u);
}

TEST_F(Stream, ARestartIsFoundBetweenForgedPacketsOnceTheClockBeforeIsSilent) {
    addPackets(0, 100);
    for (int k = 0; k < 200; ++k) {
        VelodynePacket p = packetNumber(k);
        setClock(p, 2e9 + 1e6 * kPeriod * k);
        add(datagramOf(p, at(100 + k)));
        for (int j = 1; j <= 5; ++j) add(datagramOf(forged(7919 * k, 5e8 * j + 7e6 * k), at(100 + k) + 1e-4 * j));
    }
    EXPECT_EQ(counts().restarts, 1u);
    EXPECT_GE(counts().packets, 100u + 200u - 24u) << "30 ms";
}

TEST_F(Stream, ASensorThatStandsStillDoesNotGrowAScan) {
    for (int k = 0; k < 5000; ++k) {
        VelodynePacket p = packetNumber(0);
        setClock(p, 1e6 * kPeriod * k);
        add(datagramOf(p, at(k)));
    }
    EXPECT_EQ(scans_.size(), 4u);
    EXPECT_EQ(packetsOf(0), 1000u);
}

TEST_F(Stream, AFloodOfGarbageIsCountedAndNotTold) {
    std::mt19937 random(1);
    Datagram d;
    for (int k = 0; k < 200'000; ++k) {
        for (std::size_t i = 0; i < 8; ++i) d.bytes[i] = static_cast<std::uint8_t>(random());
        d.bytes[1204] = static_cast<std::uint8_t>(random());
        d.bytes[1205] = static_cast<std::uint8_t>(random());
        d.length = k % 2 ? 1206 : random() % 3000;
        d.sender = static_cast<std::uint32_t>(random());
        d.arrival = d.steady_time = d.time = at(0) + 1e-5 * k;
        add(d);
    }
    EXPECT_EQ(counts().malformed, 200'000u);
    EXPECT_EQ(scans_.size(), 0u);
    EXPECT_EQ(stream_.takeReports().size(), 1u);
}

TEST_F(Stream, ModesThatChangeWithEveryPacketAreToldOnceASecond) {
    for (int k = 0; k < 7536; ++k) add(datagramOf(packetNumber(k, k % 2 ? 0x38 : 0x37), at(k)));  // 10 s
    EXPECT_EQ(counts().mode_changes, 7535u);
    EXPECT_LE(stream_.takeReports().size(), 12u);
}

}  // namespace
}  // namespace lidar_obstacles::live
