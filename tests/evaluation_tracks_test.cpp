// SPDX-License-Identifier: BSD-3-Clause
// Classes, tracks, velocities and blindness on rows whose figures are known by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/evaluation/metrics.h"
#include "support/labelled_rows.h"

namespace lidar_obstacles::evaluation {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::Pair;

const Eigen::Vector3d kCar{4.0, 1.8, 1.5};
constexpr int kScans = 20;

/// Something that drives along x, beginning at (x, y), or stands.
struct Thing {
    std::string id;
    std::string type;
    Eigen::Vector3d size;
    double x = 0.0;
    double y = 0.0;
    double speed = 0.0;  ///< [m/s]

    OrientedBox at(int scan) const { return boxAt(x + 0.1 * scan * speed, y, size); }
};

const Thing kDrivingVan{"van", "van", kVan, 8.0, 1.0, 5.0};
const Thing kParkedCar{"car", "car", kCar, 10.0, -6.0, 0.0};
const Thing kWalker{"walker", "pedestrian", kPerson, 5.0, -3.0, 1.2};

TruthObject truthOfThing(const Thing& t, int scan) {
    TruthObject o = truthOf(scan, t.id, t.type, t.at(scan));
    o.velocity = {t.speed, 0.0};
    return o;
}

/// A perfect box of it.
Detection boxOfThing(const Thing& t, int scan, const std::string& id) {
    Detection d = detectionOf(scan, id, toString(groupOf(t.type)), t.at(scan));
    d.track.probability = 0.9;
    d.track.velocity = {t.speed, 0.0};
    d.track.moving = t.speed > 0.0 ? 1.0 : 0.0;
    d.track.direction_known = 1.0;
    d.track.age = 2.0;
    d.track.seen = 1.0;
    return d;
}

/// All things in all scans, each with a perfect box whose id is that of the thing.
LabelledSet perfectSet(const std::vector<Thing>& things) {
    LabelledSet set;
    set.name = "set";
    for (int k = 0; k < kScans; ++k) {
        for (const Thing& t : things) {
            set.truth.push_back(truthOfThing(t, k));
            set.detections.push_back(boxOfThing(t, k, t.id));
        }
    }
    return set;
}

/// Changes each box of a thing that a condition on the scan picks.
template <class Pick, class Change>
void change(LabelledSet& set, const Thing& thing, Pick&& pick, Change&& what) {
    for (Detection& d : set.detections)
        if (d.id == thing.id && pick(d.scan_index)) what(d);
}

template <class Pick>
void remove(LabelledSet& set, const Thing& thing, Pick&& pick) {
    auto& boxes = set.detections;
    boxes.erase(std::remove_if(boxes.begin(), boxes.end(),
                               [&](const Detection& d) { return d.id == thing.id && pick(d.scan_index); }),
                boxes.end());
}

constexpr auto kAlways = [](int) { return true; };

TrackingResult judge(const LabelledSet& set, const EvaluationOptions& options = {}) {
    return evaluateSet(set, options).tracking;
}

GroupTracking vehicles(const LabelledSet& set) { return judge(set).groups.at(JudgedGroup::Vehicle); }

TEST(JudgedTracks, APerfectTrackerHasEveryFigureAtItsBest) {
    const TrackingResult r = judge(perfectSet({kDrivingVan, kParkedCar, kWalker}));
    EXPECT_EQ(r.groups.count(JudgedGroup::Cyclist), 0U) << "none was asked for";
    for (const JudgedGroup group : {JudgedGroup::Vehicle, JudgedGroup::Pedestrian, JudgedGroup::Person}) {
        const GroupTracking& g = r.groups.at(group);
        EXPECT_EQ(g.classes.f1(), 1.0);
        EXPECT_EQ(g.classes.averagePrecision(), 1.0);
        EXPECT_NEAR(g.hota.hota(), 1.0, 1e-9);
        EXPECT_EQ(g.clear.mota(), 1.0);
        EXPECT_EQ(g.clear.mostly_tracked, g.clear.objects);
    }
    const VelocityCounts& v = r.groups.at(JudgedGroup::Vehicle).velocity;
    EXPECT_EQ(v.told, 2U * kScans);
    EXPECT_EQ(statisticsOf(v.moving).p95_abs, 0.0);
    EXPECT_EQ(v.ghosts(), 0.0);
    EXPECT_EQ(v.reversed(), 0.0);
    EXPECT_EQ(r.blind.blind, 0U);
    EXPECT_EQ(r.blind.asked, 3U * kScans);
}

TEST(JudgedTracks, ATrackCutInTwoHalvesTheAssociationOfItsObject) {
    LabelledSet set = perfectSet({kDrivingVan, kParkedCar});
    change(set, kDrivingVan, [](int k) { return k >= 10; }, [](Detection& d) { d.id = "new"; });
    const GroupTracking g = vehicles(set);
    EXPECT_NEAR(g.hota.associationAccuracy(), (20 * 1.0 + 20 * 0.5) / 40, 1e-9);
    EXPECT_NEAR(g.hota.detection(), 1.0, 1e-9);
    EXPECT_NEAR(g.hota.hota(), std::sqrt(0.75), 1e-9);
    EXPECT_EQ(g.clear.id_switches, 1U);
    EXPECT_NEAR(g.clear.mota(), 1.0 - 1.0 / 40, 1e-9);
}

TEST(JudgedTracks, OverlapDecidesHowManyThresholdsABoxPasses) {
    LabelledSet set = perfectSet({kParkedCar});
    change(set, kParkedCar, kAlways, [](Detection& d) { d.box.size.x() *= 0.52; });  // inside: its overlap is 0.52
    const GroupTracking g = vehicles(set);
    EXPECT_NEAR(g.hota.detection(), 10.0 / 19.0, 1e-9) << "found at .05 .. .50, missed and invented above";
    EXPECT_EQ(g.clear.mota(), 1.0) << "the gate of the centres knows no size";
}

TEST(JudgedTracks, PeopleAreAlikeByTheDistanceOfTheirCentres) {
    LabelledSet set = perfectSet({kWalker});
    change(set, kWalker, kAlways, [](Detection& d) { d.box.center.y() += 0.28; });
    const HotaCounts h = judge(set).groups.at(JudgedGroup::Pedestrian).hota;
    EXPECT_NEAR(h.detection(), 14.0 / 19.0, 1e-9) << "1 - .28 m passes .05 .. .70";
}

TEST(JudgedTracks, AGapIsAFragmentAndItsScansAreMissed) {
    LabelledSet set = perfectSet({kDrivingVan, kParkedCar});
    remove(set, kParkedCar, [](int k) { return 5 <= k && k < 10; });
    const GroupTracking g = vehicles(set);
    EXPECT_EQ(g.clear.fragmentations, 1U);
    EXPECT_EQ(g.clear.missed, 5U);
    EXPECT_EQ(g.clear.id_switches, 0U);
    EXPECT_EQ(g.clear.mostly_tracked, 1U) << "15 of 20 are less than 80 %";
    EXPECT_NEAR(g.clear.mota(), 1.0 - 5.0 / 40, 1e-9);
}

TEST(JudgedTracks, AMatchStaysThoughAnotherBoxFitsBetter) {
    LabelledSet set = perfectSet({kParkedCar});
    change(set, kParkedCar, kAlways, [](Detection& d) { d.box.center.x() += 0.3; });
    for (int k = 10; k < kScans; ++k) set.detections.push_back(boxOfThing(kParkedCar, k, "better"));
    const ClearCounts c = vehicles(set).clear;
    EXPECT_EQ(c.id_switches, 0U);
    EXPECT_EQ(c.invented, 10U);
}

TEST(JudgedClasses, AWrongBoxIsToldByWhatItStandsOn) {
    LabelledSet set = perfectSet({kParkedCar, kWalker});
    change(set, kWalker, kAlways, [](Detection& d) { d.cls = "vehicle", d.group = Group::Vehicle; });
    for (int k = 0; k < kScans; ++k) {
        Detection twice = boxOfThing(kParkedCar, k, "twice");
        twice.track.probability = 0.5;
        set.detections.push_back(twice);
        Detection nowhere = detectionOf(k, "nowhere", "vehicle", boxAt(-12, 9, kCar));
        nowhere.track.probability = 0.3;
        set.detections.push_back(nowhere);
    }
    const TrackingResult r = judge(set);
    const ClassCounts& c = r.groups.at(JudgedGroup::Vehicle).classes;
    EXPECT_THAT(c.wrong, ElementsAre(Pair("again", 20U), Pair("nothing", 20U), Pair("other class", 20U)));
    EXPECT_EQ(c.precision(), 0.25);
    EXPECT_EQ(c.recall(), 1.0);
    EXPECT_NEAR(c.f1(), 0.4, 1e-12);
    EXPECT_EQ(r.groups.at(JudgedGroup::Pedestrian).classes.recall(), 0.0);
    EXPECT_EQ(r.blind.blind, 0U) << "a box is there, whatever it is called";
}

TEST(JudgedClasses, ProbabilitiesThatAreRankedRightGiveAWholeAveragePrecision) {
    LabelledSet set = perfectSet({kParkedCar});
    for (int k = 0; k < kScans; ++k) {
        Detection nowhere = detectionOf(k, "nowhere", "vehicle", boxAt(-12, 9, kCar));
        nowhere.track.probability = 0.3;
        set.detections.push_back(nowhere);
    }
    EXPECT_EQ(vehicles(set).classes.averagePrecision(), 1.0);
    EXPECT_NEAR(*vehicles(set).classes.calibrationError(), 0.5 * (0.1 + 0.3), 1e-9) << ".9 is always right, .3 never";
    for (Detection& d : set.detections) d.track.probability = d.id == "nowhere" ? 0.95 : 0.9;
    EXPECT_NEAR(*vehicles(set).classes.averagePrecision(), 0.5, 1e-12);
    set.detections.front().track.probability = ToldTrack::kUnknown;
    EXPECT_EQ(vehicles(set).classes.averagePrecision(), std::nullopt);
    EXPECT_EQ(vehicles(set).classes.calibrationError(), std::nullopt);
}

TEST(JudgedClasses, WhatIsPredictedClaimsNothingAndIsNeverWrong) {
    LabelledSet set = perfectSet({kParkedCar});
    for (int k = 0; k < kScans; ++k) {
        Detection hidden = detectionOf(k, "hidden", "vehicle", boxAt(-12, 9, kCar));
        hidden.track.seen = 0.0;
        set.detections.push_back(hidden);
    }
    const GroupTracking g = vehicles(set);
    EXPECT_EQ(g.classes.precision(), 1.0);
    EXPECT_EQ(g.clear.invented, 0U);
}

TEST(JudgedClasses, ObjectsThatAreNotAskedForAreNeitherMissedNorMakeABoxWrong) {
    LabelledSet set = perfectSet({kParkedCar, kDrivingVan});
    for (TruthObject& o : set.truth)
        if (o.object_id == "van") o.num_points = 3;
    const GroupTracking g = vehicles(set);
    EXPECT_EQ(g.classes.asked, static_cast<std::size_t>(kScans));
    EXPECT_EQ(g.classes.claims.size(), static_cast<std::size_t>(kScans));
    EXPECT_EQ(g.clear.invented, 0U);
    EXPECT_EQ(g.clear.objects, 1U);
}

TEST(JudgedVelocities, ErrorsAndGhostsAreThoseOfSettledTracks) {
    LabelledSet set = perfectSet({kDrivingVan, kParkedCar});
    change(set, kDrivingVan, kAlways, [](Detection& d) { d.track.velocity += Eigen::Vector2d(0.3, 0.4); });
    change(set, kParkedCar, [](int k) { return k < 5; }, [](Detection& d) { d.track.velocity = {0.0, 0.8}; });
    change(set, kParkedCar, [](int k) { return k < 5; }, [](Detection& d) { d.track.moving = 1.0; });
    VelocityCounts v = vehicles(set).velocity;
    EXPECT_NEAR(statisticsOf(v.moving).median_abs, 0.5, 1e-9);
    EXPECT_EQ(v.ghosts(), 0.25);
    EXPECT_EQ(shareOf(v.standing_called), 0.25);
    EXPECT_EQ(shareOf(v.moving_called), 1.0);
    change(set, kParkedCar, [](int k) { return k < 5; }, [](Detection& d) { d.track.age = 0.5; });
    v = vehicles(set).velocity;
    EXPECT_EQ(v.ghosts(), 0.0);
    EXPECT_EQ(v.asked, 35U);
}

TEST(JudgedVelocities, AHeadingAgainstTheMotionIsReversedWhereItsDirectionIsTold) {
    LabelledSet set = perfectSet({kDrivingVan});
    change(set, kDrivingVan, [](int k) { return k < 5; }, [](Detection& d) { d.box.yaw = M_PI; });
    EXPECT_EQ(vehicles(set).velocity.reversed(), 0.25);
    change(set, kDrivingVan, [](int k) { return k < 5; }, [](Detection& d) { d.track.direction_known = 0.0; });
    const VelocityCounts v = vehicles(set).velocity;
    EXPECT_EQ(v.reversed(), 0.0);
    EXPECT_EQ(v.heading_360_deg.size(), 15U);
    EXPECT_EQ(v.headings_asked, 20U);
}

TEST(JudgedVelocities, FilesWithoutVelocitiesTellNone) {
    LabelledSet set = perfectSet({kDrivingVan});
    for (Detection& d : set.detections) d.track = {};
    const VelocityCounts v = vehicles(set).velocity;
    EXPECT_EQ(v.asked, 20U) << "the age is not told";
    EXPECT_EQ(v.told, 0U);
    EXPECT_EQ(v.ghosts(), std::nullopt);
    EXPECT_EQ(v.reversed(), std::nullopt);
}

TEST(JudgedJitter, IsTheChangeOfWhatStandsFromScanToScan) {
    LabelledSet set = perfectSet({kParkedCar, kDrivingVan});
    const auto every_second = [](int k) { return k % 2 == 1; };
    change(set, kParkedCar, every_second, [](Detection& d) { d.box.yaw += 0.1, d.box.size.x() += 0.2; });
    change(set, kDrivingVan, every_second, [](Detection& d) { d.box.size.x() += 1.0; });
    const JitterCounts j = vehicles(set).jitter;
    EXPECT_EQ(j.length.size(), static_cast<std::size_t>(kScans - 1)) << "the van moves";
    EXPECT_NEAR(statisticsOf(j.length).p95_abs, 0.2, 1e-9);
    EXPECT_NEAR(statisticsOf(j.yaw_deg).median_abs, 0.1 * 180.0 / M_PI, 1e-9);
}

TEST(JudgedBlindness, CountsRunsOfScansWithoutAnyBoxOnANearObject) {
    LabelledSet set = perfectSet({kParkedCar, kWalker});
    remove(set, kWalker, [](int k) { return (5 <= k && k < 9) || k == 15; });
    const BlindCounts b = judge(set).blind;
    EXPECT_EQ(b.asked, 40U);
    EXPECT_EQ(b.blind, 5U);
    EXPECT_EQ(b.share(), 0.125);
    EXPECT_EQ(b.longestRun(), 4U);
    EXPECT_EQ(b.runs.front().object_id, "walker");
    EXPECT_EQ(b.objectsBlindFor(3), 1U);
}

TEST(JudgedBlindness, ABoxOfAnyClassIsEnoughButAHedgeAroundAPersonIsNone) {
    LabelledSet set = perfectSet({kWalker});
    change(set, kWalker, kAlways, [](Detection& d) { d.cls = "structure", d.group = Group::Other; });
    EXPECT_EQ(judge(set).blind.blind, 0U);
    change(set, kWalker, kAlways, [](Detection& d) { d.box.size = {12.0, 2.0, 2.0}; });
    EXPECT_EQ(judge(set).blind.blind, static_cast<std::size_t>(kScans));
    EvaluationOptions near_only;
    near_only.near = 1.0;
    EXPECT_EQ(judge(set, near_only).blind.asked, 0U);
}

TEST(JudgedTracks, AnIdThatIsTwiceInAScanGivesNoFiguresOfTracks) {
    LabelledSet set = perfectSet({kParkedCar, kDrivingVan});
    set.detections.front().id = "van";
    const TrackingResult r = judge(set);
    EXPECT_EQ(r.repeated_id, "set: id 'van' twice in scan 0 at 100.000000 s");
    EXPECT_EQ(r.groups.at(JudgedGroup::Vehicle).clear.objects, 0U);
    EXPECT_EQ(r.groups.at(JudgedGroup::Vehicle).classes.recall(), 1.0);
}

TEST(JudgedTracks, TheSameIdInTwoSetsIsTwoTracks) {
    LabelledSet cut = perfectSet({kDrivingVan});
    change(cut, kDrivingVan, [](int k) { return k >= 10; }, [](Detection& d) { d.id = "new"; });
    remove(cut, kDrivingVan, [](int k) { return k == 0; });
    const Metrics m =
        summarise({evaluateSet(perfectSet({kDrivingVan}), {}), evaluateSet(cut, {})}, BootstrapOptions{0, 1});
    const GroupTracking& g = m.tracking.groups.at(JudgedGroup::Vehicle);
    EXPECT_EQ(m.tracking.scans, 40U);
    EXPECT_EQ(g.clear.objects, 2U);
    EXPECT_EQ(g.clear.id_switches, 1U);
    const double of_cut = (9.0 * 9.0 / 20.0 + 10.0 * 10.0 / 20.0) / 19.0;
    EXPECT_NEAR(g.hota.associationAccuracy(), (20.0 * 1.0 + 19.0 * of_cut) / 39.0, 1e-9);
    EXPECT_EQ(m.tracking.blind.longestRun(), 1U);
}

}  // namespace
}  // namespace lidar_obstacles::evaluation
