// SPDX-License-Identifier: BSD-3-Clause
// Overlap, assignment, errors and figures on rows whose answers are known by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "lidar_obstacles/evaluation/bootstrap.h"
#include "lidar_obstacles/evaluation/metrics.h"
#include "lidar_obstacles/evaluation/worst_scans.h"
#include "support/labelled_rows.h"

namespace lidar_obstacles::evaluation {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

double rad(double deg) { return deg * M_PI / 180.0; }

OrientedBox square(double x, double y, double side, double yaw = 0.0) { return boxAt(x, y, {side, side, 1.0}, yaw); }

TEST(BoxOverlap, ShiftedSquaresShareHalf) { EXPECT_NEAR(bevIou(square(0, 0, 2), square(1, 0, 2)), 2.0 / 6.0, 1e-12); }

TEST(BoxOverlap, ASquareAndItsTurnedSelfShareAnOctagon) {
    const double octagon = 2.0 * (std::sqrt(2.0) - 1.0);  // of the unit square turned by 45 degrees
    EXPECT_NEAR(sharedArea(square(0, 0, 1), square(0, 0, 1, rad(45))), octagon, 1e-12);
    EXPECT_NEAR(bevIou(square(0, 0, 1), square(0, 0, 1, rad(45))), octagon / (2.0 - octagon), 1e-12);
}

TEST(BoxOverlap, AContainedBoxIsSharedWhole) {
    EXPECT_NEAR(sharedArea(square(3, 3, 4), boxAt(3, 3, {2, 1, 1}, 1.1)), 2.0, 1e-12);
}

TEST(BoxOverlap, TouchingDistantAndFlatBoxesShareNothing) {
    EXPECT_NEAR(sharedArea(square(0, 0, 1), square(1, 0, 1)), 0.0, 1e-12);
    EXPECT_EQ(sharedArea(square(0, 0, 1), square(5, 0, 1)), 0.0);
    EXPECT_EQ(sharedArea(square(0, 0, 1), boxAt(0, 0, {0, 1, 1})), 0.0);
    EXPECT_EQ(bevIou(boxAt(0, 0, {0, 0, 0}), boxAt(0, 0, {0, 0, 0})), 0.0);
}

TEST(BoxOverlap, ABoxThatIsNowhereSharesNothing) {
    OrientedBox nowhere = square(0, 0, 1);
    nowhere.center.x() = std::nan("");
    EXPECT_EQ(sharedArea(nowhere, square(0, 0, 1)), 0.0);
    OrientedBox undirected = square(0, 0, 1);
    undirected.yaw = std::nan("");
    EXPECT_EQ(sharedArea(undirected, square(0, 0, 1)), 0.0);
}

TEST(BoxOverlap, HeightsCountInThreeDimensions) {
    OrientedBox lifted = boxAt(0, 0, {2, 2, 2});
    lifted.center.z() += 1.0;
    EXPECT_NEAR(iou3d(boxAt(0, 0, {2, 2, 2}), lifted), 4.0 / 12.0, 1e-12);
    lifted.center.z() += 2.0;
    EXPECT_EQ(iou3d(boxAt(0, 0, {2, 2, 2}), lifted), 0.0);
}

TEST(BoxOverlap, TheNearestFaceIsTheNearestPointOfTheFootprint) {
    EXPECT_NEAR(nearestFaceDistance(boxAt(10, 0, {4, 2, 1})), 8.0, 1e-12);
    EXPECT_NEAR(nearestFaceDistance(boxAt(10, 0, {4, 2, 1}, rad(90))), 9.0, 1e-12);
    EXPECT_NEAR(nearestFaceDistance(boxAt(5, 4, {2, 2, 1})), 5.0, 1e-12);  // the corner (4, 3)
    EXPECT_EQ(nearestFaceDistance(boxAt(0.5, 0, {4, 2, 1})), 0.0);
}

TEST(BoxOverlap, AnglesWrapIntoHalfAPeriodToEitherSide) {
    EXPECT_NEAR(wrapAngle(rad(179), M_PI), rad(-1), 1e-12);
    EXPECT_NEAR(wrapAngle(rad(-179), M_PI), rad(1), 1e-12);
    EXPECT_NEAR(wrapAngle(rad(88), M_PI / 2), rad(-2), 1e-12);
    EXPECT_NEAR(wrapAngle(rad(710), 2 * M_PI), rad(-10), 1e-12);
    EXPECT_EQ(wrapAngle(-M_PI / 2, M_PI), M_PI / 2);
}

TEST(Assignment, GreedyWouldLoseHere) {
    Eigen::MatrixXd cost(2, 2);
    cost << -0.9, -0.8, -0.85, -0.1;
    EXPECT_THAT(minimumCostAssignment(cost), ElementsAre(1, 0));
}

TEST(Assignment, IsTheBestOfAllPermutations) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int trial = 0; trial < 50; ++trial) {
        const Eigen::MatrixXd cost = Eigen::MatrixXd::NullaryExpr(5, 5, [&] { return uniform(random); });
        const auto total = [&](const std::vector<int>& columns) {
            double sum = 0.0;
            for (int row = 0; row < 5; ++row) sum += cost(row, columns[static_cast<std::size_t>(row)]);
            return sum;
        };
        std::vector<int> columns(5);
        std::iota(columns.begin(), columns.end(), 0);
        double best = total(columns);
        while (std::next_permutation(columns.begin(), columns.end())) best = std::min(best, total(columns));
        EXPECT_NEAR(total(minimumCostAssignment(cost)), best, 1e-12);
    }
}

TEST(Assignment, OfNothingIsEmptyAndOblongIsRefused) {
    EXPECT_THAT(minimumCostAssignment(Eigen::MatrixXd(0, 0)), SizeIs(0));
    EXPECT_THROW(minimumCostAssignment(Eigen::MatrixXd::Zero(2, 3)), std::invalid_argument);
}

TEST(Matching, CentresFartherThanTheGateDoNotMatchUnlessTheyOverlap) {
    const std::vector<TruthObject> person = {truthOf(0, "1", "pedestrian", boxAt(5, 0, kPerson))};
    const auto found = [&](double x) {
        return matchBoxes(person, {detectionOf(0, "1", "unknown", boxAt(x, 0, kPerson))}, {}).size();
    };
    EXPECT_EQ(found(5.99), 1U);  // gate of people: 1 m
    EXPECT_EQ(found(6.01), 0U);
    const std::vector<TruthObject> bus = {truthOf(0, "1", "bus", boxAt(12, 0, {12, 2.5, 3}))};
    // the rear of a bus: all of it on the bus, 5.5 m from its centre
    EXPECT_THAT(matchBoxes(bus, {detectionOf(0, "1", "vehicle", boxAt(6.5, 0, {1, 2.5, 3}))}, {}), SizeIs(1));
}

TEST(Matching, OneBoxForEachObject) {
    const std::vector<TruthObject> van = {truthOf(0, "1", "van", boxAt(10, 0, kVan))};
    const std::vector<Detection> pieces = {detectionOf(0, "1", "vehicle", boxAt(8.5, 0, {2, 2, 2})),
                                           detectionOf(0, "2", "vehicle", boxAt(11, 0, {3, 2, 2}))};
    const auto pairs = matchBoxes(van, pieces, {});
    ASSERT_THAT(pairs, SizeIs(1));
    EXPECT_EQ(pairs.front().second, 1U);  // the larger piece overlaps more
}

TEST(Matching, ClassesCountWhereAskedTo) {
    const std::vector<TruthObject> van = {truthOf(0, "1", "van", boxAt(10, 0, kVan))};
    MatchOptions options;
    options.class_aware = true;
    const auto found = [&](const char* cls) {
        return matchBoxes(van, {detectionOf(0, "1", cls, boxAt(10, 0, kVan))}, options).size();
    };
    EXPECT_EQ(found("vehicle"), 1U);
    EXPECT_EQ(found("unknown"), 1U);
    EXPECT_EQ(found("pedestrian"), 0U);
}

TEST(Errors, AreDetectionMinusTruthAlongTheObjectsAxes) {
    const TruthObject van = truthOf(0, "1", "van", boxAt(10, 0, {5, 2, 2}));
    // 1 m shorter, front where it was, turned by 183 degrees
    const BoxErrors e = boxErrors(van, detectionOf(0, "1", "vehicle", boxAt(10.5, 0, {4, 2, 1.5}, rad(183))));
    EXPECT_NEAR(e.centre, 0.5, 1e-12);
    EXPECT_NEAR(e.dz, -0.25, 1e-12);
    EXPECT_NEAR(e.heading_180, rad(3), 1e-12);
    EXPECT_NEAR(e.heading_90, rad(3), 1e-12);
    EXPECT_FALSE(e.swapped);
    EXPECT_TRUE(e.flipped);
    EXPECT_NEAR(e.length, -1.0, 1e-12);
    EXPECT_NEAR(e.height, -0.5, 1e-12);
}

TEST(Errors, OfABoxTurnedByAQuarterCompareLengthWithWidth) {
    const TruthObject van = truthOf(0, "1", "van", boxAt(10, 0, {5, 2, 2}));
    const BoxErrors e = boxErrors(van, detectionOf(0, "1", "vehicle", boxAt(10, 0, {2.1, 4.8, 2}, rad(90))));
    EXPECT_TRUE(e.swapped);
    EXPECT_NEAR(std::abs(e.heading_180), rad(90), 1e-12);
    EXPECT_NEAR(e.heading_90, 0.0, 1e-12);
    EXPECT_NEAR(e.length, -0.2, 1e-12);
    EXPECT_NEAR(e.width, 0.1, 1e-12);
    EXPECT_NEAR(e.face, (10 - 2.4) - (10 - 2.5), 1e-12);
}

/// Twenty scans: a van ahead that moves away, a person, a car with three returns.
LabelledSet twentyScans() {
    LabelledSet set;
    set.name = "made";
    for (int k = 0; k < 20; ++k) {
        set.truth.push_back(truthOf(k, "1", "van", boxAt(8 + 0.1 * k, 1, kVan)));
        set.truth.push_back(truthOf(k, "2", "pedestrian", boxAt(5, -4, kPerson), 30));
        set.truth.push_back(truthOf(k, "3", "car", boxAt(-12, -4, {4, 1.8, 1.5}), 3));
    }
    return set;
}

OrientedBox vanAt(int scan) { return boxAt(8 + 0.1 * scan, 1, kVan); }

Metrics metricsOf(const LabelledSet& set, const EvaluationOptions& options = {}) {
    return summarise({evaluateSet(set, options)}, {0, 0});
}

TEST(Evaluation, APerfectDetectorHasNoErrors) {
    LabelledSet set = twentyScans();
    for (const TruthObject& o : set.truth) {
        set.detections.push_back(detectionOf(o.scan_index, o.object_id, o.type, o.box, o.type != "pedestrian"));
    }
    const Metrics m = metricsOf(set);
    EXPECT_EQ(m.scans, 20U);
    for (const Group group : {Group::Vehicle, Group::Pedestrian}) {
        EXPECT_EQ(m.groups.at(group).asked, 20U) << "three returns are too few to be asked for";
        EXPECT_EQ(m.groups.at(group).recall(), 1.0);
        EXPECT_EQ(m.groups.at(group).face.mean_abs, 0.0);
        EXPECT_NEAR(m.groups.at(group).bev_iou_mean, 1.0, 1e-9);
    }
    EXPECT_EQ(m.groups.at(Group::Vehicle).heading_valid, 1.0);
    EXPECT_EQ(m.groups.at(Group::Pedestrian).heading_180.count, 0U);
    EXPECT_TRUE(m.unmatched.empty());
    EXPECT_EQ(m.falsePerScan(), 0.0);
    EXPECT_EQ(m.tracks.objects, 2U);
    EXPECT_EQ(m.tracks.id_switches, 0U);
    EXPECT_EQ(m.class_of_matched.at("van").at("van"), 20U);
}

TEST(Evaluation, FiguresAreThoseWorkedOutByHand) {
    LabelledSet set = twentyScans();
    for (int k = 0; k < 20; ++k) {
        OrientedBox box = vanAt(k);
        box.center.x() += k % 2 == 0 ? 0.2 : -0.1;  // faces: mean 0.05, mean abs 0.15, median 0.15, p95 0.2
        if (k != 5 && k != 6) set.detections.push_back(detectionOf(k, "7", "vehicle", box));
    }
    const GroupMetrics van = metricsOf(set).groups.at(Group::Vehicle);
    EXPECT_EQ(van.asked, 20U);
    EXPECT_EQ(van.found, 18U);
    EXPECT_EQ(van.objects, 1U);
    EXPECT_NEAR(van.recall(), 0.9, 1e-12);
    EXPECT_NEAR(van.face.mean, 0.05, 1e-9);
    EXPECT_NEAR(van.face.mean_abs, 0.15, 1e-9);
    EXPECT_NEAR(van.face.median_abs, 0.15, 1e-9);
    EXPECT_NEAR(van.face.p95_abs, 0.2, 1e-9);
    EXPECT_NEAR(van.face.rmse, std::sqrt(0.5 * (0.04 + 0.01)), 1e-9);
    EXPECT_EQ(metricsOf(set).tracks.fragmentations, 1U);
}

TEST(Evaluation, RangesFallIntoBins) {
    LabelledSet set = twentyScans();
    const Metrics m = metricsOf(set);
    ASSERT_EQ(m.bins.at(Group::Vehicle).size(), 1U);  // nearest face 5.5 .. 7.4 m
    EXPECT_EQ(m.bins.at(Group::Vehicle).front().bin.from, 5);
    EXPECT_EQ(m.bins.at(Group::Vehicle).front().metrics.asked, 20U);
    EXPECT_EQ(rangeBinOf(5.0).from, 5);
    EXPECT_EQ(rangeBinOf(4.999).from, 0);
    EXPECT_EQ(rangeBinOf(1000.0).from, 50);
}

TEST(Evaluation, LeftoversAreToldByTheirCause) {
    LabelledSet set = twentyScans();
    set.truth.push_back(truthOf(0, "9", "dontcare", boxAt(20, 10, {4, 4, 2})));
    set.statics = {{"wall", boxAt(0, 12, {20, 1, 3})}, {"overhead", boxAt(25, -10, {4, 4, 1})}};
    for (int k = 0; k < 20; ++k) {
        EgoPose ego;
        ego.timestamp = timeOf(k);
        ego.scan_index = k;
        set.ego.push_back(ego);
    }
    const auto leave = [&](double x, double y) {
        set.detections.push_back(detectionOf(0, "5", "vehicle", boxAt(x, y, {1, 1, 1})));
    };
    leave(8, 1);  // on the van, which a better one matches
    set.detections.push_back(detectionOf(0, "1", "vehicle", vanAt(0)));
    leave(-12, -4);   // on the car with three returns: it matches that, which is not asked for
    leave(22.3, 10);  // at the edge of what is neither wanted nor false
    leave(3, 12);     // the wall
    leave(25, -10);   // the bridge
    leave(15, 5);     // nothing
    leave(60, 0);     // out of range: not counted at all
    const Metrics m = metricsOf(set);
    EXPECT_EQ(m.unmatched, (std::map<std::string, std::size_t>{
                               {"fragment", 1}, {"ignored", 1}, {"structure", 1}, {"overhead", 1}, {"phantom", 1}}));
    EXPECT_NEAR(m.falsePerScan(), 2.0 / 20.0, 1e-12);
    EXPECT_EQ(m.classified_on_nothing.at("phantom:vehicle"), 1U);
    EXPECT_EQ(m.classified_on_nothing.count("fragment:vehicle"), 0U);
}

TEST(Evaluation, StaticBoxesMoveWithTheVehicle) {
    EgoPose ego;
    ego.position = {10, 5, 1};
    ego.rpy = {0, 0, rad(90)};  // it looks along the world's y
    const auto near =
        staticBoxesNear({{"wall", boxAt(10, 25, {4, 1, 2}, rad(90))}, {"far", boxAt(100, 5, {1, 1, 1})}}, ego, 30.0);
    ASSERT_THAT(near, SizeIs(1));
    EXPECT_NEAR(near[0].box.center.x(), 20.0, 1e-9);
    EXPECT_NEAR(near[0].box.center.y(), 0.0, 1e-9);
    EXPECT_NEAR(near[0].box.center.z(), 0.0, 1e-9);
    EXPECT_NEAR(near[0].box.yaw, 0.0, 1e-12);
}

TEST(Evaluation, TheVehiclesVelocityIsThatBetweenItsNeighbouringPosesInItsOwnAxes) {
    const auto pose = [](double time, double y) {
        return EgoPose{time, 0, {0.0, y, 0.0}, {0.0, 0.0, M_PI / 2}};  // towards +y of the world
    };
    const auto v = egoVelocities({pose(0.0, 0.0), pose(0.1, 1.0), pose(0.2, 3.0), pose(5.0, 90.0)});
    ASSERT_EQ(v.size(), 4U);
    EXPECT_NEAR((v[0] - Eigen::Vector2d(10.0, 0.0)).norm(), 0.0, 1e-9);
    EXPECT_NEAR((v[1] - Eigen::Vector2d(15.0, 0.0)).norm(), 0.0, 1e-9);
    EXPECT_TRUE(std::isnan(v[2].x()) && std::isnan(v[3].x())) << "the next pose is too late";
    EXPECT_TRUE(std::isnan(egoVelocities({pose(0.0, 0.0)})[0].x()));
    EXPECT_TRUE(egoVelocities({}).empty());
}

TEST(Evaluation, VelocitiesAreHeldAgainstTheTruthWhereTheyAreTold) {
    LabelledSet set;
    for (int k = 0; k < 3; ++k) {
        set.truth.push_back(truthOf(k, "van", "van", boxAt(10, 0, kVan)));
        set.truth.back().velocity = {5.0, 0.0};
        set.detections.push_back(detectionOf(k, "1", "vehicle", boxAt(10, 0, kVan)));
        if (k > 0) set.detections.back().track.velocity = {5.0 + 0.1 * k, 3.0};
        set.ego.push_back({timeOf(k), k, {2.0 * k, 0.0, 0.0}, {0.0, 0.0, 0.0}});
    }
    const SetResult r = evaluateSet(set, {});
    EXPECT_NEAR(r.records[1].ego_velocity->x(), 20.0, 1e-6);
    const GroupMetrics m = summarise({r}, BootstrapOptions{0, 1}).groups.at(Group::Vehicle);
    EXPECT_EQ(m.velocity.count, 2U);
    EXPECT_NEAR(m.velocity.mean, 0.15, 1e-9);
}

TEST(Evaluation, OnlyTheLabelledSectorAndRegionCount) {
    LabelledSet set = twentyScans();
    set.truth.push_back(truthOf(0, "4", "car", boxAt(-10, 0, kVan)));
    set.detections.push_back(detectionOf(0, "4", "vehicle", boxAt(-15, 3, kVan)));
    EvaluationOptions options;
    EXPECT_EQ(metricsOf(set, options).groups.at(Group::Vehicle).asked, 21U);
    EXPECT_EQ(metricsOf(set, options).detections, 1U);
    options.fov_deg = 80.0;
    EXPECT_EQ(metricsOf(set, options).groups.at(Group::Vehicle).asked, 20U);
    EXPECT_EQ(metricsOf(set, options).detections, 0U);
    options.fov_deg = 360.0;
    options.roi = RegionOfInterest{-20, 0, -10, 10};
    EXPECT_EQ(metricsOf(set, options).groups.at(Group::Vehicle).asked, 1U);
    options.roi.reset();
    options.min_points = 1;
    EXPECT_EQ(metricsOf(set, options).groups.at(Group::Vehicle).asked, 41U);
    options.skip_first = 1.0;
    EXPECT_EQ(metricsOf(set, options).scans, 10U);
}

TEST(Evaluation, DetectionsOfNoScanAreCountedAsSuch) {
    LabelledSet set = twentyScans();
    set.detections.push_back(detectionOf(3, "1", "vehicle", vanAt(3)));
    set.detections.back().timestamp += 0.03;
    set.detections.push_back(detectionOf(500, "1", "vehicle", vanAt(3)));
    const Metrics by_time = metricsOf(set);
    EXPECT_EQ(by_time.groups.at(Group::Vehicle).found, 1U);
    EXPECT_EQ(by_time.detections_without_scan, 1U);
    EvaluationOptions by_index;
    by_index.match_by_index = true;
    EXPECT_EQ(metricsOf(set, by_index).groups.at(Group::Vehicle).found, 1U);
}

TEST(Evaluation, TheTargetIsTheObjectOfItsKindWithMostRows) {
    LabelledSet set = twentyScans();
    set.truth.push_back(truthOf(0, "8", "van", boxAt(20, 10, kVan)));
    EvaluationOptions options;
    for (const char* word : {"van", "vehicle", "id:1"}) {
        options.target = word;
        const SetResult r = evaluateSet(set, options);
        EXPECT_EQ(r.target_id, "1") << word;
        EXPECT_EQ(summarise({r}, {0, 0}).target->asked, 20U) << word;
    }
    options.target = "tram";
    EXPECT_THROW(evaluateSet(set, options), std::runtime_error);
}

TEST(Evaluation, WithoutScansIsAnError) { EXPECT_THROW(evaluateSet({}, {}), std::runtime_error); }

TEST(Tracks, AChangedIdIsASwitch) {
    LabelledSet set = twentyScans();
    for (int k = 0; k < 20; ++k) set.detections.push_back(detectionOf(k, k < 10 ? "7" : "9", "vehicle", vanAt(k)));
    EXPECT_EQ(metricsOf(set).tracks.id_switches, 1U);
}

TEST(Tracks, IdsThatDoNotLastAreNotCounted) {
    LabelledSet set = twentyScans();
    for (int k = 0; k < 20; ++k) set.detections.push_back(detectionOf(k, std::to_string(k), "vehicle", vanAt(k)));
    EXPECT_EQ(metricsOf(set).tracks.id_switches, std::nullopt);
}

TEST(Statistics, OfNothingSayZero) {
    EXPECT_EQ(statisticsOf({}).count, 0U);
    EXPECT_NEAR(statisticsOf({-3.0}).median_abs, 3.0, 1e-12);
    EXPECT_NEAR(statisticsOf({-3.0}).mean, -3.0, 1e-12);
}

/// Ten objects in ten scans; object k is found in k of them.
std::vector<SetResult> tenObjects() {
    LabelledSet set;
    set.name = "ten";
    for (int scan = 0; scan < 10; ++scan) {
        for (int k = 0; k < 10; ++k) {
            const OrientedBox box = boxAt(10, -20 + 4 * k, kVan);
            set.truth.push_back(truthOf(scan, std::to_string(k), "car", box));
            if (scan < k) set.detections.push_back(detectionOf(scan, std::to_string(k), "vehicle", box));
        }
    }
    return {evaluateSet(set, {})};
}

TEST(Bootstrap, SameSeedSameIntervalsAndAnotherSeedOthers) {
    const auto results = tenObjects();
    const auto recall = [&](std::uint64_t seed) {
        return summarise(results, {500, seed}).groups.at(Group::Vehicle).intervals.at("recall");
    };
    EXPECT_EQ(recall(1).low, recall(1).low);
    EXPECT_EQ(recall(1).high, recall(1).high);
    EXPECT_NE(recall(1).low, recall(2).low);
}

TEST(Bootstrap, TheIntervalOfAMeanOverObjectsHasTheWidthThatTheirSpreadSays) {
    // recall per object: 0 .. 0.9, standard deviation 0.287, of the mean of ten 0.0908: +-1.96 of that
    const Interval recall = summarise(tenObjects(), {4000, 7}).groups.at(Group::Vehicle).intervals.at("recall");
    EXPECT_NEAR(recall.low, 0.45 - 1.96 * 0.0908, 0.02);
    EXPECT_NEAR(recall.high, 0.45 + 1.96 * 0.0908, 0.02);
}

TEST(Bootstrap, DrawsObjectsNotRows) {
    auto results = tenObjects();
    const Interval before = summarise(results, {500, 1}).groups.at(Group::Vehicle).intervals.at("recall");
    const std::vector<ObjectRecord> once = results[0].records;  // every row twice: no new objects
    results[0].records.insert(results[0].records.end(), once.begin(), once.end());
    const Interval after = summarise(results, {500, 1}).groups.at(Group::Vehicle).intervals.at("recall");
    EXPECT_EQ(before.low, after.low);
    EXPECT_EQ(before.high, after.high);
}

TEST(Bootstrap, OneObjectHasNoInterval) {
    LabelledSet set = twentyScans();
    EXPECT_TRUE(summarise({evaluateSet(set, {})}, {100, 1}).groups.at(Group::Vehicle).intervals.empty());
    EXPECT_THROW(summarise({evaluateSet(set, {})}, {-1, 1}), std::invalid_argument);
}

TEST(Sets, TheSameIdInTwoSetsIsTwoObjects) {
    const SetResult r = evaluateSet(twentyScans(), {});
    const Metrics m = summarise({r, r}, {0, 0});
    EXPECT_EQ(m.groups.at(Group::Vehicle).objects, 2U);
    EXPECT_EQ(m.groups.at(Group::Vehicle).asked, 40U);
    EXPECT_EQ(m.scans, 40U);
}

TEST(WorstScans, AMissComesBeforeAnErrorAndOneEventIsShownOnce) {
    LabelledSet set = twentyScans();
    for (int k = 0; k < 20; ++k) {
        set.detections.push_back(detectionOf(k, "2", "pedestrian", boxAt(5, -4, kPerson), false));
        if (k == 12 || k == 13) continue;  // missed
        OrientedBox box = vanAt(k);
        if (k == 2) box.center.x() += 1.0;
        set.detections.push_back(detectionOf(k, "1", "vehicle", box));
    }
    const std::vector<SetResult> results = {evaluateSet(set, {})};
    const auto worst = worstScans(results, 2);
    ASSERT_THAT(worst, SizeIs(2));
    EXPECT_EQ(worst[0].scan_index, 12);
    EXPECT_THAT(worst[0].reasons.front(), HasSubstr("van 1, 6.7 m away, 100 returns: not found"));
    EXPECT_EQ(worst[1].scan_index, 13) << "within 2 s of 12 and the same van, but only these two and scan 2 failed";
    EXPECT_THAT(worstScans(results, 10), SizeIs(3));
    EXPECT_THAT(worstScans(results, 0), SizeIs(0));
}

}  // namespace
}  // namespace lidar_obstacles::evaluation
