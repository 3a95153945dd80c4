// SPDX-License-Identifier: BSD-3-Clause
// The parts of the tracker by themselves: assignment, overlap, shapes, beliefs, motion, beams.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "sequence/track_assignment.h"
#include "sequence/track_belief.h"
#include "sequence/track_filter.h"
#include "sequence/track_overlap.h"
#include "sequence/track_rays.h"
#include "sequence/track_shape.h"
#include "sequence/track_view.h"
#include "support/synthetic_scene.h"

namespace lidar_obstacles {
namespace {

/// The least cost over all ways to pair rows with columns, a row alone costing `limit`.
double leastCost(const std::vector<double>& costs, std::size_t rows, std::size_t columns, double limit) {
    std::vector<std::size_t> places(columns + rows);
    std::iota(places.begin(), places.end(), 0U);
    double best = 1e300;
    do {
        double sum = 0.0;
        for (std::size_t r = 0; r < rows; ++r)
            sum += places[r] < columns ? std::min(limit, costs[r * columns + places[r]]) : limit;
        best = std::min(best, sum);
    } while (std::next_permutation(places.begin(), places.end()));
    return best;
}

TEST(Assignment, CostsTheLeastOfAllWays) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> cost(0.0, 12.0);
    Assignment assignment;
    for (int n = 0; n < 60; ++n) {
        const std::size_t rows = 1 + random() % 4, columns = random() % 4;
        std::vector<double> costs(rows * columns);
        for (double& c : costs) c = cost(random);
        const auto& column_of = assignment.solve(costs, rows, columns, 9.0);
        double sum = 0.0;
        for (std::size_t r = 0; r < rows; ++r)
            sum += column_of[r] < 0 ? 9.0 : costs[r * columns + static_cast<std::size_t>(column_of[r])];
        EXPECT_NEAR(sum, leastCost(costs, rows, columns, 9.0), 1e-9);
    }
}

TEST(Assignment, GroupsThatWantNothingOfEachOtherAreEachServedBest) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> cost(0.0, 9.0);
    for (int n = 0; n < 40; ++n) {
        // two groups of two rows and two columns, their places mixed
        const std::size_t size = 4;
        std::vector<double> costs(size * size, 9.0);
        for (std::size_t r = 0; r < size; ++r)
            for (std::size_t c = 0; c < size; ++c)
                if (r % 2 == (c / 2 + static_cast<std::size_t>(n)) % 2) costs[r * size + c] = cost(random);
        const std::vector<int> column_of = Assignment().solve(costs, size, size, 9.0);
        double sum = 0.0;
        for (std::size_t r = 0; r < size; ++r)
            sum += column_of[r] < 0 ? 9.0 : costs[r * size + static_cast<std::size_t>(column_of[r])];
        EXPECT_NEAR(sum, leastCost(costs, size, size, 9.0), 1e-9);
    }
}

TEST(Assignment, NothingIsPairedAtTheLimit) {
    EXPECT_EQ(Assignment().solve({9.0, 20.0}, 1, 2, 9.0), std::vector<int>{-1});
    EXPECT_TRUE(Assignment().solve({}, 0, 3, 9.0).empty());
}

FlatBox flat(double x, double y, double length, double width, double yaw) {
    return {{x, y}, {0.5 * length, 0.5 * width}, yaw};
}

TEST(Overlap, IsThatOfSquaresWorkedOutByHand) {
    const FlatBox square = flat(0, 0, 2, 2, 0);
    EXPECT_NEAR(sharedArea(square, flat(1, 0, 2, 2, 0)), 2.0, 1e-12);
    EXPECT_NEAR(sharedArea(square, flat(0, 0, 2, 2, M_PI / 4)), 8.0 * (std::sqrt(2.0) - 1.0), 1e-9);  // an octagon
    EXPECT_NEAR(sharedArea(square, flat(5, 0, 2, 2, 0.3)), 0.0, 1e-12);
    EXPECT_NEAR(generalisedIou(square, square), 1.0, 1e-12);
    EXPECT_NEAR(generalisedIou(square, flat(1, 0, 2, 2, 0)), 2.0 / 6.0, 1e-12);    // the hull is their union
    EXPECT_NEAR(generalisedIou(square, flat(4, 0, 2, 2, 0)), -4.0 / 12.0, 1e-12);  // hull 6 x 2, 4 of it empty
}

TEST(Overlap, ARearAndItsCarCoverTheSameAngle) {
    PlacedBox car, rear;
    car.whole = flat(20, 0, 4.3, 1.8, 0);
    rear.whole = flat(17.9, 0, 0.2, 1.8, 0);
    lookAt(car);
    lookAt(rear);
    EXPECT_GT(polarOverlap(car, rear), 0.95);
    EXPECT_LT(generalisedIou(car.whole, rear.whole), 0.1);
    EXPECT_NEAR(car.range, 17.85, 1e-9);
}

BodyAxis::View view(double ahead, double behind, EdgeGrade a, EdgeGrade b) {
    return {{ahead, behind}, {a, b}, 1.0, false};
}

TEST(BodyAxis, ScrapsAndMergersDoNotMoveTheExtent) {
    BodyAxis axis;
    axis.begin(view(2.1, 2.1, EdgeGrade::Seen, EdgeGrade::Silhouette));
    for (int n = 0; n < 20; ++n) axis.learn(view(2.1, 2.1, EdgeGrade::Seen, EdgeGrade::Silhouette));
    for (int n = 0; n < 5; ++n) axis.learn(view(-1.0, 2.1, EdgeGrade::Silhouette, EdgeGrade::Silhouette));
    for (int n = 0; n < 5; ++n) axis.learn(view(2.1, 5.0, EdgeGrade::Seen, EdgeGrade::Silhouette));
    EXPECT_NEAR(axis.extent(), 4.2, 0.05);
}

TEST(BodyAxis, AGuessCountsUntilSomethingIsSeen) {
    BodyAxis axis;
    for (int n = 0; n < 30; ++n) {
        const auto guess = view(3.5, 0.5, EdgeGrade::Guess, EdgeGrade::Seen);
        n == 0 ? axis.begin(guess) : axis.learn(guess);
    }
    EXPECT_NEAR(axis.extent(), 4.0, 1e-9);
    for (int n = 0; n < 3; ++n) axis.learn(view(4.9, 0.5, EdgeGrade::Silhouette, EdgeGrade::Seen));
    EXPECT_NEAR(axis.extent(), 5.4, 0.1);
    EXPECT_NEAR(axis.face(1), 0.5, 0.05);  // it grew at the end that was not seen
}

/// A car of 4.2 m straight ahead, its rear and right side seen up to a length; the rest is completed.
BodyShape shapeOfCarSeenUpTo(double seen_length) {
    SeenBox car;
    car.box = {{12.1, 3.0, 0.8}, {4.2, 1.7, 1.6}, 0.0};
    car.seen_box = {{10.0 + 0.5 * seen_length, 3.0, 0.8}, {seen_length, 1.7, 1.6}, 0.0};
    car.faces = kBack | kRight;
    car.heading_valid = true;
    car.num_points = 100;
    const PlacedBox placed = placeBox(car, {0.0, 0.0}, TrackingParams{});
    BodyShape shape;
    for (int n = 0; n < 20; ++n) learnShape(shape, viewOf(placed, {12.0, 3.0}, 0.0), 1.0, n == 0);
    return shape;
}

TEST(BodyShape, IsAsLongAsTheCompletedBoxWhereNobodySawTheEnd) {
    EXPECT_NEAR(shapeOfCarSeenUpTo(3.6).extent(0), 4.2, 0.01);
    EXPECT_NEAR(shapeOfCarSeenUpTo(4.2).extent(0), 4.2, 0.01);  // nothing was added
    EXPECT_NEAR(shapeOfCarSeenUpTo(3.6).extent(1), 1.7, 0.01);
}

TEST(BodyAxis, BeamsBeyondItsEndMakeItShort) {
    BodyAxis axis;
    axis.begin(view(1.7, 1.7, EdgeGrade::Silhouette, EdgeGrade::Silhouette));
    for (int n = 0; n < 20; ++n) axis.learn(view(1.7, 1.7, EdgeGrade::Silhouette, EdgeGrade::Silhouette));
    auto small = view(0.3, 0.3, EdgeGrade::Silhouette, EdgeGrade::Silhouette);
    for (int n = 0; n < 5; ++n) axis.learn(small);
    EXPECT_GT(axis.extent(), 3.0);  // it may be hidden
    small.ends = true;
    for (int n = 0; n < 5; ++n) axis.learn(small);
    EXPECT_LT(axis.extent(), 0.8);
}

TEST(DirectionBelief, KnowsTheFrontAfterHalfASecondOfWalkingPace) {
    DirectionBelief belief;
    EXPECT_FALSE(belief.known());
    for (int n = 0; n < 5; ++n) belief.move({1.5, 0.0}, 0.1);
    EXPECT_TRUE(belief.known());
    EXPECT_EQ(belief.takeTurn(), 0);
}

TEST(DirectionBelief, TurnsOnlyOnStrongEvidenceAndIsSureThen) {
    DirectionBelief belief;
    for (int n = 0; n < 30; ++n) belief.move({3.0, 0.0}, 0.1);
    for (int n = 0; n < 8; ++n) belief.move({-3.0, 0.0}, 0.1);
    EXPECT_EQ(belief.takeTurn(), 0);
    for (int n = 0; n < 10; ++n) belief.move({-3.0, 0.0}, 0.1);
    EXPECT_EQ(belief.takeTurn(), 2);
    EXPECT_TRUE(belief.known());
}

TEST(DirectionBelief, SidewaysMotionSaysNothingAboutTheFront) {
    DirectionBelief belief;
    for (int n = 0; n < 5; ++n) belief.move({0.1, 0.5}, 0.1);
    EXPECT_FALSE(belief.known());
}

TEST(ClassBelief, ManyLooksAreSurerThanOneButNotAsSureAsIfTheyWereIndependent) {
    ClassProbabilities look{};
    look.fill(0.1f);
    look[1] = 0.6f;
    ClassBelief belief;
    belief.look(look, 0.0, 1.0);
    EXPECT_NEAR(belief.probabilities()[1], 0.6, 1e-6);
    for (int n = 0; n < 100; ++n) belief.look(look, 0.1, 1.0);
    const double p = belief.probabilities()[1];
    EXPECT_GT(p, 0.95);
    EXPECT_LT(p, 0.9999);
}

TEST(ClassBelief, AGlimpseDoesNotUndoWhatWasSeenWell) {
    ClassProbabilities car{}, scrap{};
    car.fill(0.02f);
    car[1] = 0.92f;
    scrap.fill(0.05f);
    scrap[0] = 0.8f;
    for (const double quality : {1.0, 0.1}) {
        ClassBelief belief;
        for (int n = 0; n < 20; ++n) belief.look(car, 0.1, 1.0);
        for (int n = 0; n < 20; ++n) belief.look(scrap, 0.1, quality);
        EXPECT_EQ(belief.best() == ObstacleClass::Vehicle, quality < 1.0) << quality;
    }
}

Measurements placeAt(const MotionFilter& f, double x, double y, double std) {
    Measurements z;
    for (const int k : {kPosX, kPosY}) {
        Measurement m;
        m.row[k] = 1.0;
        m.innovation = (k == kPosX ? x : y) - f.mean()[k];
        m.variance = std * std;
        z.add(m);
    }
    return z;
}

TEST(MotionFilter, TellsStandingDrivingAndTurningApart) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0.0, 0.05);
    const MotionNoise car;
    for (const double speed : {0.0, 5.0}) {
        MotionFilter f;
        f.begin({0, 0}, 0.0, 0.1, car);
        for (int n = 1; n <= 30; ++n) {
            f.predict(0.1, car);
            f.update(placeAt(f, speed * 0.1 * n + noise(random), noise(random), 0.05));
        }
        EXPECT_EQ(f.standing() > 0.5, speed == 0.0);
        EXPECT_NEAR(f.velocity().x(), speed, 0.3);
    }
}

TEST(MotionFilter, AJumpOfTheBoxIsNoMotion) {
    const MotionNoise car;
    MotionFilter f;
    f.begin({0, 0}, 0.0, 0.1, car);
    for (int n = 0; n < 20; ++n) {
        f.predict(0.1, car);
        f.update(placeAt(f, 0.0, 0.0, 0.05));
    }
    f.predict(0.1, car);
    EXPECT_GT(f.update(placeAt(f, 2.0, 0.0, 0.05)), 4.0);
    EXPECT_LT(f.velocity().norm(), 0.5);
    EXPECT_GT(f.standing(), 0.5);
}

/// A car 12 m ahead, and a wall behind it and around.
test::Scan carBeforeAWall(bool with_car, bool with_screen = false) {
    test::World world;
    world.ground.push_back({});
    world.boxes.push_back({{30.0, 0.0, 2.0}, {0.5, 40.0, 4.0}, 0.0});
    if (with_car) world.boxes.push_back({{12.0, 0.0, 0.75}, {4.0, 1.8, 1.5}, 0.0});
    if (with_screen) world.boxes.push_back({{6.0, 0.0, 1.5}, {0.2, 4.0, 3.0}, 0.0});
    return castRays(world, test::Sensor{});
}

TEST(BeamMap, BeamsTellEmptyFromHitFromHidden) {
    const OrientedBox car{{12.0, 0.0, 0.75}, {4.0, 1.8, 1.5}, 0.0};
    BeamMap beams;
    const test::Scan there = carBeforeAWall(true), gone = carBeforeAWall(false), hidden = carBeforeAWall(true, true);
    beams.look(&there.cloud);
    EXPECT_GT(beams.through(car).hit, 10);
    EXPECT_LT(beams.through(car).passed, beams.through(car).hit / 4);
    beams.look(&gone.cloud);
    EXPECT_GT(beams.through(car).passed, 10);
    EXPECT_EQ(beams.through(car).blocked, 0);
    beams.look(&hidden.cloud);
    EXPECT_EQ(beams.through(car).passed, 0);
    EXPECT_GT(beams.through(car).blocked, 10);
}

TEST(BeamMap, TellsReturnsOfSomethingElse) {
    const OrientedBox car{{12.0, 0.0, 0.75}, {4.0, 1.8, 1.5}, 0.0};
    const test::Scan scan = carBeforeAWall(true);
    std::vector<std::uint8_t> other(scan.cloud.size(), 0);
    BeamMap beams;
    beams.look(&scan.cloud, other.data());
    EXPECT_EQ(beams.through(car).other, 0);
    for (const std::int32_t i : scan.returnsOn(1)) other[static_cast<std::size_t>(i)] = 1;
    beams.look(&scan.cloud, other.data());
    EXPECT_GT(beams.through(car).other, 10);
    EXPECT_LE(beams.through(car).other, beams.through(car).hit);
}

TEST(BeamMap, KnowsNothingOfAScanWithoutRings) {
    test::Sensor sensor;
    sensor.rings = false;
    const test::Scan scan = castRays({{{}}, {}}, sensor);
    BeamMap beams;
    beams.look(&scan.cloud);
    EXPECT_TRUE(beams.empty());
    EXPECT_EQ(beams.through({{12.0, 0.0, 0.75}, {4.0, 1.8, 1.5}, 0.0}).all(), 0);
    beams.look(nullptr);
    EXPECT_TRUE(beams.empty());
}

TEST(OpenShare, ANearerBoxHidesWhatItCovers) {
    PlacedBox car, bus;
    car.whole = flat(20, 0, 4, 2, M_PI / 2);
    bus.whole = flat(10, 0, 10, 2.5, M_PI / 2);
    lookAt(car);
    lookAt(bus);
    EXPECT_EQ(openShare(car, {bus}), 0.0);
    EXPECT_EQ(openShare(car, {car}), 1.0);
    bus.whole = flat(10, 5, 10, 2.5, M_PI / 2);  // from y = 0 on
    lookAt(bus);
    EXPECT_NEAR(openShare(car, {bus}), 0.5, 0.12);
}

}  // namespace
}  // namespace lidar_obstacles
