// Pieces beside each other with nothing seen in between: the dark doors of a car against the gap between two things.
#include <gtest/gtest.h>

#include "lidar_obstacles/clustering.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// A scan and its pieces, one per index of the lists.
struct Pieces {
    Scan scan;
    std::vector<Cluster> components;

    std::vector<Cluster> joined(const ClusteringParams& params = {}) const {
        return joinFragments(components, scan.cloud, knownGround(scan), params);
    }
};

World with(const std::vector<OrientedBox>& boxes) {
    World world = flatWorld();
    world.boxes = boxes;
    return world;
}

/// One component per box of the world that has returns.
Pieces perBox(const Scan& scan, int boxes) {
    Pieces pieces{scan, {}};
    for (int b = 0; b < boxes; ++b) {
        pieces.components.emplace_back();
        pieces.components.back().points = scan.returnsOn(b);
    }
    return pieces;
}

/// A car alongside, 4.4 m long, its side at y = 6: nothing came back from between x = -half and half, and what is left
/// and right of it are two pieces. Other boxes stand around it.
Pieces darkDoor(const Sensor& sensor, double half, const std::vector<OrientedBox>& others = {}) {
    std::vector<OrientedBox> boxes = {boxAt(0.0, 6.9, 0.0, {4.4, 1.8, 1.5})};
    boxes.insert(boxes.end(), others.begin(), others.end());
    const Scan whole = castRays(with(boxes), sensor);
    const auto dark = [&](std::int32_t i) { return whole.hit[i] == 0 && std::abs(whole.cloud.xyz[i].x()) < half; };
    Pieces pieces{without(whole, dark), std::vector<Cluster>(2)};
    for (const std::int32_t i : pieces.scan.returnsOn(0))
        pieces.components[pieces.scan.cloud.xyz[i].x() < 0.0f ? 0 : 1].points.push_back(i);
    return pieces;
}

/// The same two pieces as two things of their own: each as deep as the car, free ground between them.
Pieces twoThings(const Sensor& sensor, double half) {
    const double length = 2.2 - half;
    const double middle = half + 0.5 * length;
    return perBox(
        castRays(with({boxAt(-middle, 6.9, 0.0, {length, 1.8, 1.5}), boxAt(middle, 6.9, 0.0, {length, 1.8, 1.5})}),
                 sensor),
        2);
}

TEST(JoinGap, ACarWithADarkDoorIsOne) {
    for (const int planes : {16, 8, 4})
        for (const double half : {0.4, 0.6, 0.9}) {
            const Pieces pieces = darkDoor(fewPlanes(planes), half);
            const auto joined = pieces.joined();
            ASSERT_EQ(joined.size(), 1u) << planes << " planes, " << 2 * half << " m";
            EXPECT_EQ(joined[0].points.size(), pieces.scan.returnsOn(0).size());
        }
}

TEST(JoinGap, AGapThatBeamsPassThroughParts) {
    // 4 planes at -7 .. -1 deg: at 6 m that of -7 deg passes at 1.06 m, over a car's body, and tells nothing
    for (const int planes : {16, 8})
        for (const double half : {0.4, 0.6, 0.9})
            EXPECT_EQ(twoThings(fewPlanes(planes), half).joined().size(), 2u) << planes << " planes, " << 2 * half;
}

TEST(JoinGap, BeamsOverTheWindowsPartNothing) {
    // what is seen through the windows, 0.9 m and higher, stands behind the car
    const Pieces pieces = darkDoor(Sensor{}, 0.6, {boxAt(0.0, 12.0, 0.0, {20.0, 0.3, 4.0})});
    EXPECT_EQ(pieces.joined().size(), 1u);
}

TEST(JoinGap, AGapWiderThanTheLimitParts) {
    ClusteringParams narrow;
    narrow.join_gap = 1.0;
    EXPECT_EQ(darkDoor(Sensor{}, 0.4).joined(narrow).size(), 1u);
    EXPECT_EQ(darkDoor(Sensor{}, 0.6).joined(narrow).size(), 2u);
}

TEST(JoinGap, WhatTogetherIsLongerThanACarStaysApart) {
    ClusteringParams params;
    params.join_gap_length = 4.2;  // the car is 4.4 m long
    EXPECT_EQ(darkDoor(Sensor{}, 0.6).joined(params).size(), 2u);
}

TEST(JoinGap, SourcesWithoutRingsAreLeftUnchanged) {
    Sensor sensor;
    sensor.rings = false;
    EXPECT_EQ(darkDoor(sensor, 0.6).joined().size(), 2u);
}

TEST(JoinGap, ACarBehindAPostIsOne) {
    // the post hides 0.3 m * 6 / 3 = 0.6 m of the side
    const Pieces all = darkDoor(Sensor{}, 0.35, {boxAt(0.0, 3.0, 0.0, {0.3, 0.3, 3.0})});
    EXPECT_EQ(all.joined().size(), 1u);
}

TEST(JoinGap, TwoPeopleSideBySideAreTwo) {
    for (const int planes : {16, 8, 4})
        for (const double apart : {0.8, 1.2, 1.8}) {
            const World world =
                with({boxAt(-0.5 * apart, 6.0, 0.0, {0.5, 0.4, 1.75}), boxAt(0.5 * apart, 6.0, 0.0, {0.5, 0.4, 1.75})});
            EXPECT_EQ(perBox(castRays(world, fewPlanes(planes)), 2).joined().size(), 2u) << planes << ", " << apart;
            // nor where nothing is seen between them
            World dark = world;
            dark.ground.clear();
            EXPECT_EQ(perBox(castRays(dark, fewPlanes(planes)), 2).joined().size(), 2u) << planes << ", " << apart;
        }
}

/// A piece of a car's side and, 1.2 m on, a speck of three returns of one plane on it, `hidden` behind a post or not.
Pieces speck(bool hidden, int ring = 0) {
    std::vector<OrientedBox> boxes = {boxAt(0.0, 6.9, 0.0, {4.4, 1.8, 1.5})};
    if (hidden) boxes.push_back(boxAt(0.75, 3.2, 0.0, {0.7, 0.2, 1.5}));
    const Scan whole = castRays(with(boxes), Sensor{});
    int kept = 0;
    const auto lost = [&](std::int32_t i) {
        const Eigen::Vector3f& p = whole.cloud.xyz[i];
        if (whole.hit[i] != 0 || p.x() < 0.6f) return false;
        const bool of_speck = p.x() > 1.8f && whole.cloud.ring[i] == ring;
        return !of_speck || ++kept > 3;
    };
    Pieces pieces{without(whole, lost), std::vector<Cluster>(2)};
    for (const std::int32_t i : pieces.scan.returnsOn(0))
        pieces.components[pieces.scan.cloud.xyz[i].x() < 1.0f ? 0 : 1].points.push_back(i);
    return pieces;
}

TEST(JoinGap, ASpeckOfTheSameSideBelongsToIt) {
    const Pieces pieces = speck(false);
    ASSERT_EQ(pieces.components[1].points.size(), 3u);
    EXPECT_EQ(pieces.joined().size(), 1u);
}

TEST(JoinGap, ASpeckOfTheSameSideBelongsToItWhicheverPlaneHitIt) {
    for (int ring = 0; ring <= 6; ++ring) EXPECT_EQ(speck(false, ring).joined().size(), 1u) << ring;
}

TEST(JoinGap, ASpeckThatLiesBehindSomethingElseDoesNot) {
    const Pieces pieces = speck(true);
    ASSERT_EQ(pieces.components[1].points.size(), 3u);
    EXPECT_EQ(pieces.joined().size(), 2u);
}

}  // namespace
}  // namespace lidar_obstacles
