// SPDX-License-Identifier: BSD-3-Clause
// What was found, handed on in rawlogs: written, read back, and told apart from everything else.
#include "lidar_obstacles/mrpt_bridge/results.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationComment.h>

#include <limits>

#include "lidar_obstacles/mrpt_bridge/rawlog_writer.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using mrpt::obs::CObservationRFID;
using testing::AllOf;
using testing::HasSubstr;

/// A vehicle that is tracked; no number of it has a short text.
Obstacle someVehicle() {
    Obstacle o;
    o.id = 12;
    o.cls = ObstacleClass::Vehicle;
    o.probability = {0.01f, 0.9f, 0.03f, 0.05f, 1.0f / 3.0f};
    o.box = {{10.0 / 3.0, -0.1, 0.7}, {4.5, 1.8 + 1e-15, 1.5}, -3.0};
    o.seen_box = {{10.0, 0.2, 0.7}, {0.3, 1.7, 1.4}, -3.1};
    o.heading_valid = true;
    o.heading_std = 0.1 / 7.0;
    o.num_points = 321;
    o.num_rings = 5;
    o.max_height = std::numeric_limits<double>::infinity();
    o.rule = HeadingRule::TwoSides;
    o.faces = kBack | kLeft;
    o.track = TrackState{3.2, false, Eigen::Vector2d(8.1, -0.3), {0.1, 0.2}, {0.3, 0.4}, 0.05, true, true, 0.0421};
    return o;
}

/// A wall that nothing is known of beyond this scan.
Obstacle someWall() {
    Obstacle o;
    o.id = 13;
    o.cls = ObstacleClass::Structure;
    o.max_height = 2.5;
    return o;
}

void expectSameBox(const OrientedBox& a, const OrientedBox& b) {
    EXPECT_EQ(a.center, b.center);
    EXPECT_EQ(a.size, b.size);
    EXPECT_EQ(a.yaw, b.yaw);
}

void expectSameTrack(const TrackState& a, const TrackState& b) {
    EXPECT_EQ(a.age, b.age);
    EXPECT_EQ(a.seen, b.seen);
    EXPECT_EQ(a.velocity, b.velocity);
    EXPECT_EQ(a.velocity_std, b.velocity_std);
    EXPECT_EQ(a.center_std, b.center_std);
    EXPECT_EQ(a.yaw_std, b.yaw_std);
    EXPECT_EQ(a.moving, b.moving);
    EXPECT_EQ(a.direction_known, b.direction_known);
    EXPECT_EQ(a.time_offset, b.time_offset);
}

void expectSame(const Obstacle& a, const Obstacle& b) {
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.cls, b.cls);
    EXPECT_EQ(a.probability, b.probability);
    expectSameBox(a.box, b.box);
    expectSameBox(a.seen_box, b.seen_box);
    EXPECT_EQ(a.heading_valid, b.heading_valid);
    EXPECT_EQ(a.heading_std, b.heading_std);
    EXPECT_EQ(a.num_points, b.num_points);
    EXPECT_EQ(a.num_rings, b.num_rings);
    EXPECT_EQ(a.max_height, b.max_height);
    EXPECT_EQ(a.rule, b.rule);
    EXPECT_EQ(a.faces, b.faces);
    ASSERT_EQ(a.track.has_value(), b.track.has_value());
    if (a.track) expectSameTrack(*a.track, *b.track);
}

TEST(Results, ARawlogGivesBackWhatWasWrittenBitForBit) {
    const test::TempFolder folder;
    const ScanResults written{1519637061.085268, "front", {someVehicle(), someWall()}};
    RawlogWriter writer(folder.file("r.rawlog"));
    writer.append(*toResultsObservation(written));
    writer.append(*toResultsObservation({5.0, "", {}}));
    writer.close();

    const auto source = openScanSource(folder.file("r.rawlog"));
    const auto first = source->next(), second = source->next();
    ASSERT_TRUE(first && second) << source->message();
    EXPECT_EQ(first->observation->sensorLabel, "front_results");
    EXPECT_NEAR(mrpt::Clock::toDouble(first->observation->timestamp), written.timestamp, 1e-6);
    const auto read = readResults(*first->observation);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->timestamp, written.timestamp);
    EXPECT_EQ(read->scan_label, "front");
    ASSERT_EQ(read->obstacles.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) expectSame(read->obstacles[i], written.obstacles[i]);

    EXPECT_EQ(second->observation->sensorLabel, "results");
    const auto empty = readResults(*second->observation);
    ASSERT_TRUE(empty) << "a scan without obstacles is not a scan without results";
    EXPECT_TRUE(empty->obstacles.empty());
}

TEST(Results, OtherObservationsHoldNone) {
    EXPECT_FALSE(readResults(mrpt::obs::CObservationComment()));
    CObservationRFID tags;
    EXPECT_FALSE(readResults(tags));
    tags.tag_readings.emplace_back();
    tags.tag_readings[0].epc = "9000 0000 0022 C311";
    tags.tag_readings[0].antennaPort = "2";
    EXPECT_FALSE(readResults(tags));
}

TEST(Results, AStockToolShowsARowForEachObstacle) {
    std::ostringstream text;
    toResultsObservation({5.0, "front", {someVehicle()}})->getDescriptionAsText(text);
    EXPECT_THAT(text.str(),
                AllOf(HasSubstr("lidar_obstacles 1"), HasSubstr("vehicle 12"), HasSubstr("\"num_points\":321")));
}

std::string errorOf(const CObservationRFID& observation) {
    try {
        readResults(observation);
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return "no error";
}

TEST(Results, ThoseOfANewerVersionAndDamagedOnesAreErrorsThatSayWhy) {
    const auto good = toResultsObservation({5.0, "front", {someVehicle()}});
    CObservationRFID newer = *good, cut = *good, broken = *good, other = *good;
    newer.tag_readings[0].antennaPort = "lidar_obstacles 2";
    EXPECT_THAT(errorOf(newer),
                AllOf(HasSubstr("'front_results'"), HasSubstr("version 2"), HasSubstr("up to version 1")));
    cut.tag_readings.pop_back();
    EXPECT_THAT(errorOf(cut), HasSubstr("0 obstacles where there should be 1"));
    broken.tag_readings[1].epc.resize(40);
    EXPECT_THAT(errorOf(broken), HasSubstr("parse error"));
    auto& text = other.tag_readings[1].epc;
    text.replace(text.find("vehicle"), 7, "machine");
    EXPECT_THAT(errorOf(other), HasSubstr("unknown word 'machine'"));
    other.tag_readings[0].antennaPort = "lidar_obstacles x";
    EXPECT_THAT(errorOf(other), HasSubstr("cannot be read"));
}

TEST(Results, ANumberThatIsNotFiniteIsRefused) {
    Obstacle o = someVehicle();
    o.box.yaw = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(toResultsObservation({5.0, "front", {o}}), std::invalid_argument);
    o = someVehicle();
    o.max_height = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(toResultsObservation({5.0, "front", {o}}), std::invalid_argument);
}

}  // namespace
}  // namespace lidar_obstacles
