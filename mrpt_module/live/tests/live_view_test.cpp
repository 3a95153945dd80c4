// SPDX-License-Identifier: BSD-3-Clause
// Sensors whose field of view is limited: what they do not send is not lost, and turns end where they do not look.
#include "lidar_obstacles/live/field_of_view.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "stream_fixture.h"

namespace lidar_obstacles::live {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A sensor that looks from one azimuth to another only [0.01 deg, may pass zero], and leaves out the packets that
/// hold anything else: those of 4.8 degrees of a VLP-16 at 10 Hz, which do not come to lie alike in every turn.
bool isInView(const VelodynePacket& packet, int from, int to) {
    return std::all_of(std::begin(packet.blocks), std::end(packet.blocks), [&](const auto& block) {
        return (block.rotation() - from + 36000) % 36000 <= (to - from + 36000) % 36000;
    });
}

VelodynePacket unevenPacket(int k) {
    VelodynePacket packet = emptyPacket(0, 0x22, 0x37);
    for (int b = 0; b < 12; ++b) setBlock(packet, b, static_cast<unsigned>((41 * (12 * k + b)) % 36000));
    setClock(packet, 1e6 * kPeriod * k);
    return packet;
}

TEST_F(Stream, AGapOfEveryTurnIsTheFieldOfViewAndNoLoss) {
    std::size_t sent = 0, lost = 0;
    for (int k = 0; k < 2000; ++k) {
        const VelodynePacket packet = unevenPacket(k);
        const int ahead = (packet.blocks[0].rotation() + 1000) % 36000;
        if (!isInView(packet, 30000, 6000)) continue;
        if (lost < 2 && k > 1000 && ahead < 2000) {  // straight ahead, one after the other
            ++lost;
            continue;
        }
        ++sent;
        add(datagramOf(packet, at(k)));
    }
    ASSERT_EQ(lost, 2U);
    EXPECT_EQ(counts().packets, sent);
    EXPECT_EQ(counts().lost, lost);
    EXPECT_THAT(stream_.takeReports(), ElementsAre(HasSubstr("data of"), HasSubstr("2 packets lost")));
    for (std::size_t k = 1; k < 14; ++k) EXPECT_NEAR(static_cast<double>(packetsOf(k)), 23.5, 1.6) << k;
    EXPECT_EQ(scans_.size(), 27U);
}

TEST_F(Stream, PacketsThatBridgeTheGapAreNoLossEither) {
    constexpr int kView = 12000, kStep = 40;
    VelodynePacket packet = emptyPacket(0, 0x22, 0x37);
    int block = 0;
    std::size_t sent = 0;
    for (int k = 0; k < 900 * 50; ++k) {  // firings of 50 turns
        const int azimuth = kStep * k % 36000;
        if (azimuth > kView) continue;
        if (block == 0) setClock(packet, 110.592 * k);
        setBlock(packet, block, static_cast<unsigned>(azimuth));
        if (++block < 12) continue;
        add(datagramOf(packet, 5000.0 + 110.592e-6 * k));
        block = 0;
        ++sent;
    }
    EXPECT_EQ(counts().packets, sent);
    EXPECT_EQ(counts().lost, 0U);
}

TEST_F(Stream, ALossInTheFirstTurnIsCountedOnceTheNextShowsWhatWasThere) {
    addPackets(0, 20);
    addPackets(30, 75);
    EXPECT_EQ(counts().lost, 0U) << "it may be that the sensor does not look there";
    addPackets(75, 100);
    EXPECT_EQ(counts().lost, 10U);
    addPackets(100, 600);
    EXPECT_EQ(counts().lost, 10U);
}

TEST_F(Stream, LatePacketsOfTheFirstTurnAreNeitherLostNorDropped) {
    addPackets(0, 20);
    addPackets(30, 40);
    addPackets(20, 30);
    addPackets(40, 600);
    EXPECT_EQ(counts().packets, 600U);
    EXPECT_EQ(counts().lost, 0U);
    EXPECT_EQ(counts().late, 10U);
}

TEST_F(Stream, IsCutWhereTheSensorDoesNotLook) {
    for (int k = 0; k < 2000; ++k)  // it looks behind only
        if (isInView(unevenPacket(k), 12000, 24000)) add(datagramOf(unevenPacket(k), at(k)));
    ASSERT_GT(scans_.size(), 20U);
    for (std::size_t k = 6; k < scans_.size(); ++k) {
        EXPECT_NEAR(static_cast<double>(firstAzimuth(k)), 12250.0, 250.0) << k;
        EXPECT_NEAR(static_cast<double>(packetsOf(k)), 23.5, 1.6) << k;
    }
    options_.cut_azimuth_deg = 180.0;
    stream_ = ScanStream(options_);
    scans_.clear();
    for (int k = 0; k < 2000; ++k)
        if (isInView(unevenPacket(k), 12000, 24000)) add(datagramOf(unevenPacket(k), at(k)));
    EXPECT_NEAR(static_cast<double>(firstAzimuth(10)), 18250.0, 250.0) << "as asked";
}

TEST_F(Stream, ATurnOfALimitedViewThatTheEndCutsOffIsLeftOut) {
    int k = 0;
    for (; k < 732; ++k)  // ten turns
        if (isInView(unevenPacket(k), 30000, 6000)) add(datagramOf(unevenPacket(k), at(k)));
    const std::size_t packets = counts().packets;
    EXPECT_FALSE(stream_.end());
    EXPECT_NEAR(static_cast<double>(counts().unfinished), 12.0, 1.0);
    EXPECT_EQ(counts().packets + counts().unfinished, packets);
    EXPECT_EQ(counts().scans, 10U) << "half of one, and nine";
}

TEST_F(Stream, WhatIsCollectedAtTheEndIsAScanOfASensorThatLooksAllAround) {
    addPackets(0, 600);
    EXPECT_TRUE(stream_.end());
    EXPECT_EQ(counts().unfinished, 0U);
}

}  // namespace
}  // namespace lidar_obstacles::live
