// SPDX-License-Identifier: BSD-3-Clause
// Two things do not stand in one place.
#include "objects/overlap.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// An obstacle with that box, nothing of it completed, and so many returns numbered from `first`.
Obstacle standing(const OrientedBox& box, int first, int returns = 20, ObstacleClass cls = ObstacleClass::Vehicle,
                  float probability = 0.9f) {
    Obstacle o;
    o.box = o.seen_box = box;
    o.cls = cls;
    o.probability[static_cast<std::size_t>(cls)] = probability;
    for (int k = 0; k < returns; ++k) o.points.push_back(first + k);
    o.num_points = returns;
    return o;
}

std::size_t returnsOf(const std::vector<Obstacle>& obstacles) {
    std::size_t count = 0;
    for (const Obstacle& o : obstacles) {
        EXPECT_EQ(o.num_points, static_cast<int>(o.points.size()));
        count += o.points.size();
    }
    return count;
}

void expectApart(const std::vector<Obstacle>& obstacles) {
    for (std::size_t a = 0; a < obstacles.size(); ++a)
        for (std::size_t b = a + 1; b < obstacles.size(); ++b) {
            const auto area = [](const Obstacle& o) { return o.box.size.x() * o.box.size.y(); };
            EXPECT_LE(sharedArea(obstacles[a].box, obstacles[b].box),
                      0.1 * std::min(area(obstacles[a]), area(obstacles[b])) + 1e-4);
        }
}

TEST(SharedArea, IsThatOfTheIntersection) {
    const OrientedBox a = boxAt(10.0, 0.0, 0.0, {4.0, 2.0, 1.5});
    EXPECT_NEAR(sharedArea(a, a), 8.0, 1e-3);
    EXPECT_NEAR(sharedArea(a, boxAt(13.0, 1.0, 0.0, {4.0, 2.0, 1.5})), 1.0, 1e-3);
    EXPECT_NEAR(sharedArea(a, boxAt(10.0, 0.0, 90.0, {4.0, 2.0, 1.5})), 4.0, 1e-3) << "crossed";
    EXPECT_NEAR(sharedArea(a, boxAt(10.0, 0.0, 45.0, {1.0, 1.0, 1.5})), 1.0, 1e-3) << "inside, turned";
    EXPECT_EQ(sharedArea(a, boxAt(20.0, 0.0, 0.0, {4.0, 2.0, 1.5})), 0.0);
}

TEST(WithoutOverlaps, BoxesThatStandApartStayAsTheyAre) {
    const std::vector<Obstacle> cars = {standing(carAt(10.0, 0.0, 0.0), 0), standing(carAt(10.0, 2.2, 0.0), 20)};
    const auto kept = withoutOverlaps(cars, GroundModel{});
    ASSERT_EQ(kept.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(kept[k].box.center, cars[k].box.center);
        EXPECT_EQ(kept[k].points, cars[k].points);
    }
    EXPECT_TRUE(withoutOverlaps({}, GroundModel{}).empty());
}

TEST(WithoutOverlaps, ATenthOfTheSmallerMayBeShared) {
    // 4.5 m long, one behind the other: 0.4 m are 9 %, 0.5 m are 11 %
    const Obstacle first = standing(carAt(10.0, 0.0, 0.0), 0), second = standing(carAt(14.1, 0.0, 0.0), 20);
    const auto kept = withoutOverlaps({first, second}, {});
    ASSERT_EQ(kept.size(), 2u);
    EXPECT_EQ(kept[0].box.size, first.box.size);
    EXPECT_EQ(kept[1].box.size, second.box.size);
}

TEST(WithoutOverlaps, WhatStandsBesideAnotherIsCutAndNotTakenForAPartOfIt) {
    // 1.5 m of a car are within the box of a lorry, whose returns are many more
    const Obstacle lorry = standing(boxAt(10.0, 0.0, 0.0, {8.0, 2.5, 3.0}), 0, 500);
    const Obstacle car = standing(boxAt(14.75, 0.0, 0.0, {4.5, 1.8, 1.5}), 500, 60);
    for (const auto& order : {std::vector<Obstacle>{lorry, car}, std::vector<Obstacle>{car, lorry}}) {
        const auto kept = withoutOverlaps(order, GroundModel{});
        ASSERT_EQ(kept.size(), 2u);
        expectApart(kept);
        for (const Obstacle& o : kept) {
            const bool is_car = o.points.size() == 60u;
            EXPECT_GT(sharedArea(o.box, is_car ? car.box : lorry.box), 0.6 * (is_car ? 4.5 * 1.8 : 8.0 * 2.5))
                << "stays where it is";
            EXPECT_EQ(o.box.size, o.seen_box.size) << "tracks hear of the cut";
        }
    }
}

TEST(WithoutOverlaps, FirstWhatCompletionAddedIsTakenBack) {
    Obstacle grown = standing(boxAt(10.0, 0.0, 0.0, {1.0, 1.8, 1.5}), 0);  // the rear that was seen
    grown.box = carAt(11.75, 0.0, 0.0);
    const Obstacle other = standing(carAt(14.0, 0.0, 0.0), 20);
    const auto kept = withoutOverlaps({grown, other}, GroundModel{});
    ASSERT_EQ(kept.size(), 2u);
    EXPECT_EQ(kept[0].box.size.head<2>(), grown.seen_box.size.head<2>());
    EXPECT_NEAR(kept[0].box.center.x(), 10.0, 1e-9);
    EXPECT_NEAR(kept[0].box.center.z() - 0.5 * kept[0].box.size.z(), 0.0, 1e-9) << "it stands on the ground";
    expectApart(kept);
}

TEST(WithoutOverlaps, WhatStillLiesInAnothersBoxBelongsToIt) {
    const Obstacle bus = standing(boxAt(12.0, 0.0, 0.0, {11.0, 2.5, 3.0}), 0, 100);
    const Obstacle part = standing(boxAt(10.0, 0.5, 20.0, {1.5, 1.0, 1.0}), 100, 12);
    for (const auto& order : {std::vector<Obstacle>{bus, part}, std::vector<Obstacle>{part, bus}}) {
        const auto kept = withoutOverlaps(order, GroundModel{});
        ASSERT_EQ(kept.size(), 1u);
        EXPECT_EQ(kept[0].box.size, bus.box.size);
        EXPECT_EQ(returnsOf(kept), 112u);
    }
}

TEST(WithoutOverlaps, AThingOfAnotherClassIsOneOfItsOwn) {
    const Obstacle car = standing(carAt(10.0, 0.0, 0.0), 0, 100);
    const auto kept = [&](ObstacleClass cls) {
        return withoutOverlaps({car, standing(personAt(10.0, 0.5), 100, 15, cls)}, GroundModel{});
    };
    for (const ObstacleClass cls : {ObstacleClass::Pedestrian, ObstacleClass::Cyclist})
        EXPECT_EQ(kept(cls).size(), 2u) << "a person beside the door";
    for (const ObstacleClass cls : {ObstacleClass::Unknown, ObstacleClass::Vehicle}) {
        EXPECT_EQ(kept(cls).size(), 1u);
        EXPECT_EQ(returnsOf(kept(cls)), 115u);
    }
}

TEST(WithoutOverlaps, ABoxThatLiesElsewhereWithoutItsCompletionIsComparedAgain) {
    Obstacle moved = standing(carAt(10.0, 0.0, 0.0), 0, 50);
    moved.box = carAt(20.0, 0.0, 0.0);
    const Obstacle where_it_was_seen = standing(carAt(10.5, 0.2, 0.0), 50, 10);
    const Obstacle where_it_was_put = standing(carAt(21.0, 0.2, 0.0), 60);
    const auto kept = withoutOverlaps({moved, where_it_was_seen, where_it_was_put}, GroundModel{});
    EXPECT_EQ(kept.size(), 2u);
    expectApart(kept);
    EXPECT_EQ(returnsOf(kept), 80u);
}

TEST(WithoutOverlaps, NoTwoShareATenthAndNoReturnIsLostWhateverTheBoxes) {
    cv::RNG random(11);
    for (int run = 0; run < 100; ++run) {
        std::vector<Obstacle> obstacles;
        for (int k = 0; k < 12; ++k) {
            const auto any = [&](double low, double high) { return random.uniform(low, high); };
            Obstacle o =
                standing(boxAt(any(5, 20), any(-6, 6), any(-180, 180), {any(0.5, 3), any(0.4, 2), 1.5}), 20 * k);
            o.box.size.head<2>() *= any(1.0, 1.6);
            obstacles.push_back(o);
        }
        const auto kept = withoutOverlaps(obstacles, GroundModel{});
        expectApart(kept);
        EXPECT_EQ(returnsOf(kept), 240u) << run;
    }
}

}  // namespace
}  // namespace lidar_obstacles
