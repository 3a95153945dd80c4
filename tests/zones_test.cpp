// SPDX-License-Identifier: BSD-3-Clause
// Zones: when they are occupied, when free, and when nobody can know.
#include "lidar_obstacles/zones.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sequence/zone_contact.h"
#include "support/watched_scene.h"

namespace lidar_obstacles {
namespace {

using test::WatchedScene;

Outline rectangle(double x_from, double x_to, double y_from, double y_to) {
    return {{x_from, y_from}, {x_to, y_from}, {x_to, y_to}, {x_from, y_to}};
}

const Outline kVehicle = rectangle(-1.0, 2.0, -0.9, 0.9);

ZoneSet setOf(const ZoneRule& rule, ZoneFrame frame = ZoneFrame::Vehicle) {
    ZoneSet set;
    set.vehicle = kVehicle;
    set.zones.push_back({"ahead", frame, rectangle(4.0, 10.0, -1.5, 1.5), rule});
    return set;
}

/// One zone and the scene that it is in.
struct Watch {
    explicit Watch(const ZoneSet& set, bool with_poses = true) : scene(with_poses), zones(set, RegionParams{}) {}

    const ZoneReport& see(const SequenceResult& found) {
        return zones.update({found, scene.trajectory(), health, latency}).front();
    }
    const ZoneReport& see(const PointCloud& cloud, double x = 0.0) { return see(scene.next(cloud, x)); }

    WatchedScene scene;
    ZoneMonitor zones;
    const HealthReport* health = nullptr;
    std::optional<double> latency;
};

const PointCloud& nothing() {
    static const PointCloud cloud = test::scanOf({test::boxAt(30.0, 0.0, 0.0, {1.0, 20.0, 3.0})});
    return cloud;
}
const PointCloud& person() {
    static const PointCloud cloud =
        test::scanOf({test::personAt(7.0, 0.0), test::boxAt(30.0, 0.0, 0.0, {1.0, 20.0, 3.0})});
    return cloud;
}

TEST(Zones, AreFreeWhereTheGroundIsSeenAndNothingStands) {
    Watch watch(setOf({}));
    const ZoneReport& r = watch.see(nothing());
    EXPECT_EQ(r.state, ZoneState::Free) << toString(r.reason);
    EXPECT_EQ(r.reason, ZoneReason::None);
    EXPECT_GT(r.seen, 0.95);
    EXPECT_EQ(r.returns, 0);
}

TEST(Zones, AreOccupiedByAPersonInThemAtOnce) {
    Watch watch(setOf({}));
    watch.see(nothing());
    const ZoneReport& r = watch.see(person());
    EXPECT_EQ(r.state, ZoneState::Occupied);
    EXPECT_GE(r.returns, 10);
    ASSERT_TRUE(r.nearest);
    EXPECT_NEAR(*r.nearest, 7.0 - 0.25 - 2.0, 0.1);  // from the bumper to the person's front
}

TEST(Zones, AreNotOccupiedByWhatStandsBeside) {
    Watch watch(setOf({}));
    EXPECT_EQ(watch.see(test::scanOf({test::personAt(7.0, 3.0)})).state, ZoneState::Free);
}

TEST(Zones, StayOccupiedForAWhile) {
    ZoneRule rule;
    rule.off_after = 0.35;
    Watch watch(setOf(rule));
    watch.see(person());
    for (int k = 0; k < 3; ++k) {  // what may be hidden is still followed
        SequenceResult found = watch.scene.next(nothing());
        found.detection.obstacles.clear();
        EXPECT_EQ(watch.see(found).state, ZoneState::Occupied) << k;
    }
    SequenceResult found = watch.scene.next(nothing());
    found.detection.obstacles.clear();
    EXPECT_EQ(watch.see(found).state, ZoneState::Free);
}

TEST(Zones, MayWaitBeforeTheyAreOccupied) {
    ZoneRule rule;
    rule.on_after = 0.15;
    Watch watch(setOf(rule));
    watch.see(nothing());
    EXPECT_EQ(watch.see(person()).state, ZoneState::Free);
    EXPECT_EQ(watch.see(person()).state, ZoneState::Free);
    EXPECT_EQ(watch.see(person()).state, ZoneState::Occupied);
}

TEST(Zones, BehindAWallAreUnknown) {
    Watch watch(setOf({}));
    const ZoneReport& r = watch.see(test::scanOf({test::boxAt(3.0, 0.0, 0.0, {0.2, 6.0, 2.0})}));
    EXPECT_EQ(r.state, ZoneState::Unknown);
    EXPECT_EQ(r.reason, ZoneReason::NotSeen);
    EXPECT_LT(r.seen, 0.2);
}

TEST(Zones, BelowTheLowestBeamsAreUnknownForLowThings) {
    ZoneRule rule;
    rule.object_height = 0.4;  // the lowest beam is that low at 1.4 m / tan(15 deg) = 5.2 m
    Watch watch(setOf(rule));
    const ZoneReport& r = watch.see(nothing());
    EXPECT_EQ(r.reason, ZoneReason::NotSeen);
    EXPECT_NEAR(r.seen, (10.0 - 5.2) / 6.0, 0.06);
}

TEST(Zones, OutsideOfTheRegionAreUnknown) {
    RegionParams region;
    region.front = 6.0;
    Watch watch(setOf({}));
    watch.zones = ZoneMonitor(setOf({}), region);
    EXPECT_EQ(watch.see(nothing()).reason, ZoneReason::NotSeen);
}

TEST(Zones, InPlacesThatAreNotSearchedAreUnknown) {
    for (const char* excluded : {"box(3, 8, -2, 2)", "sector(-30, 30)"}) {
        RegionParams region;
        region.excluded = excluded;
        Watch watch(setOf({}));
        watch.zones = ZoneMonitor(setOf({}), region);
        EXPECT_EQ(watch.see(nothing()).reason, ZoneReason::NotSeen) << excluded;
    }
    RegionParams region;
    region.outline = "box(0, 6, -9, 9)";
    Watch watch(setOf({}));
    watch.zones = ZoneMonitor(setOf({}), region);
    EXPECT_EQ(watch.see(nothing()).reason, ZoneReason::NotSeen);
    EXPECT_NEAR(watch.see(nothing()).seen, 2.0 / 6.0, 0.06);
}

TEST(Zones, WithAnExcludedCornerAreFreeAsFarAsTheirRuleAllows) {
    RegionParams region;
    region.excluded = "box(9, 12, 1, 3)";
    Watch watch(setOf({}));
    watch.zones = ZoneMonitor(setOf({}), region);
    const ZoneReport& r = watch.see(nothing());
    EXPECT_EQ(r.state, ZoneState::Free) << toString(r.reason);
    EXPECT_LT(r.seen, 0.99);
}

TEST(Zones, WithoutGroundAreUnknown) {
    Watch watch(setOf({}));
    EXPECT_EQ(watch.see(PointCloud{}).reason, ZoneReason::NoGround);
}

TEST(Zones, WithoutScansAreUnknown) {
    Watch watch(setOf({}));
    watch.see(nothing());
    const ZoneReport& r = watch.zones.missScan(watch.scene.time + 0.5).front();
    EXPECT_EQ(r.state, ZoneState::Unknown);
    EXPECT_EQ(r.reason, ZoneReason::NoScan);
}

TEST(Zones, InABlockedSectorAndOfATurnedSensorAreUnknown) {
    Watch watch(setOf({}));
    HealthReport health;
    watch.health = &health;
    EXPECT_EQ(watch.see(nothing()).state, ZoneState::Free);
    health.blocked = {{0.1, 0.2}};  // at its edge
    EXPECT_EQ(watch.see(nothing()).reason, ZoneReason::Blocked);
    health.blocked = {{3.0, 3.2}};  // behind
    for (int k = 0; k < 6; ++k) watch.see(nothing());
    EXPECT_EQ(watch.see(nothing()).state, ZoneState::Free);
    health.turned = true;
    EXPECT_EQ(watch.see(nothing()).reason, ZoneReason::Turned);
}

TEST(Zones, OfAScanThatComesTooLateAreUnknown) {
    ZoneSet set = setOf({});
    set.max_latency = 0.1;
    Watch watch(set);
    watch.latency = 0.05;
    EXPECT_EQ(watch.see(nothing()).state, ZoneState::Free);
    watch.latency = 0.15;
    EXPECT_EQ(watch.see(nothing()).reason, ZoneReason::Late);
}

TEST(Zones, OfTheMapStayInPlaceAndNeedAPose) {
    ZoneRule rule;
    rule.min_seen = 0.5;  // the person may hide a part
    const ZoneSet set = setOf(rule, ZoneFrame::Map);
    Watch without(set, false);
    EXPECT_EQ(without.see(person()).reason, ZoneReason::NoPose);
    Watch watch(set);
    EXPECT_EQ(watch.see(person()).state, ZoneState::Occupied);
    Watch away(set);  // the vehicle is 5 m behind: what is 7 m ahead of it stands before the zone
    EXPECT_EQ(away.see(person(), -5.0).state, ZoneState::Free);
}

TEST(Zones, CountOnlyThingsOfTheirClasses) {
    ZoneRule rule;
    rule.classes = {false, true, false, false, false};  // vehicles
    rule.min_seen = 0.0;
    Watch watch(setOf(rule));
    SequenceResult found = watch.scene.next(person());
    for (Obstacle& o : found.detection.obstacles) o.cls = ObstacleClass::Pedestrian;
    EXPECT_EQ(watch.see(found).state, ZoneState::Free);
    for (Obstacle& o : found.detection.obstacles) {
        o.cls = ObstacleClass::Vehicle;
        o.probability = {0.3f, 0.7f, 0.0f, 0.0f, 0.0f};
    }
    EXPECT_EQ(watch.see(found).state, ZoneState::Occupied);
    EXPECT_EQ(watch.zones.reports().front().cls, ObstacleClass::Vehicle);
    rule.min_probability = 0.8;
    watch.zones = ZoneMonitor(setOf(rule), RegionParams{});
    EXPECT_EQ(watch.see(found).state, ZoneState::Free);
}

TEST(Zones, CountARiderOfWhomOnlyAPartWasSeen) {
    // .3 m beside the zone, half a metre long: there is more of a bicycle
    Watch watch(setOf({}));
    SequenceResult found = watch.scene.next(test::scanOf({test::personAt(7.0, 2.05)}));
    ASSERT_EQ(found.detection.obstacles.size(), 1u);
    found.detection.obstacles.front().cls = ObstacleClass::Pedestrian;
    EXPECT_EQ(watch.see(found).state, ZoneState::Free);
    found.detection.obstacles.front().cls = ObstacleClass::Cyclist;
    EXPECT_EQ(watch.see(found).state, ZoneState::Occupied);
}

TEST(Zones, WithANearestDistanceCountWhatIsNearer) {
    ZoneRule rule;
    rule.min_seen = 0.0;
    rule.nearest = 4.0;  // the person is 4.75 m from the bumper
    Watch watch(setOf(rule));
    EXPECT_EQ(watch.see(person()).state, ZoneState::Free);
    rule.nearest = 5.0;
    watch.zones = ZoneMonitor(setOf(rule), RegionParams{});
    EXPECT_EQ(watch.see(person()).state, ZoneState::Occupied);
}

TEST(Zones, DoNotCountWhatHangsAbove) {
    const OrientedBox beam{{7.0, 0.0, 2.3}, {0.3, 8.0, 0.3}, 0.0};
    ZoneRule rule;
    rule.max_height = 2.0;
    Watch watch(setOf(rule));
    EXPECT_EQ(watch.see(test::scanOf({beam})).state, ZoneState::Free);
}

/// A car that comes from 30 m ahead, once on the vehicle's line and once beside it; the state after a second.
ZoneReport approach(double y, double speed, double limit) {
    ZoneRule rule;
    rule.min_seen = 0.0;
    rule.time_to_contact = limit;
    ZoneSet set = setOf(rule);
    set.zones.front().polygon = rectangle(2.0, 40.0, -6.0, 6.0);
    Watch watch(set);
    ZoneReport last;
    for (int k = 0; k < 10; ++k) last = watch.see(test::scanOf({test::carAt(30.0 - speed * 0.1 * k, y, 0.0)}));
    return last;
}

TEST(Zones, WithATimeToContactCountWhatComes) {
    // after 0.9 s the car's front is at 30 - 9 - 2.25 = 18.75 m, 16.75 m from the bumper: 1.7 s
    const ZoneReport soon = approach(0.8, 10.0, 2.5);
    EXPECT_EQ(soon.state, ZoneState::Occupied);
    EXPECT_EQ(soon.reason, ZoneReason::Contact);
    ASSERT_TRUE(soon.time_to_contact);
    EXPECT_NEAR(*soon.time_to_contact, 1.7, 0.3);
    EXPECT_EQ(approach(0.8, 10.0, 1.0).state, ZoneState::Free);  // not so soon
    EXPECT_EQ(approach(4.0, 10.0, 2.5).state, ZoneState::Free);  // it passes by
}

TEST(Zones, WithATimeToContactAreUnknownWithoutTheSpeedOfTheVehicle) {
    ZoneRule rule;
    rule.time_to_contact = 2.0;
    rule.min_seen = 0.0;
    Watch watch(setOf(rule), false);
    EXPECT_EQ(watch.see(person()).reason, ZoneReason::NoPose);
    EXPECT_EQ(watch.see(nothing()).state, ZoneState::Unknown);  // for a while
}

TEST(TimeToContact, IsTheGapByTheSpeed) {
    const ZonePolygon vehicle = toPolygon(kVehicle);
    MovingThing thing{rectangle(12.0, 13.0, -0.5, 0.5), {-3.0, 0.0}};
    const VehicleMotion motion{{2.0, 0.0}, 0.0};
    EXPECT_NEAR(timeToContact(vehicle, motion, thing, {0.0, 5.0}).value(), 2.0, 0.02);
    EXPECT_FALSE(timeToContact(vehicle, motion, thing, {0.0, 1.9}));
    thing.velocity = {-3.0, 2.0};  // it has crossed by then
    EXPECT_FALSE(timeToContact(vehicle, motion, thing, {0.0, 5.0}));
    thing.outline = rectangle(1.0, 3.0, 0.0, 1.0);
    EXPECT_EQ(timeToContact(vehicle, motion, thing, {0.0, 5.0}).value(), 0.0);
}

TEST(TimeToContact, FollowsTheCurveOfTheVehicle) {
    const ZonePolygon vehicle = toPolygon(rectangle(-0.1, 0.1, -0.1, 0.1));
    // 5 m/s on a circle of 5 m radius to the left: after a quarter of it, pi / 2 s, it is at (5, 5)
    const VehicleMotion motion{{5.0, 0.0}, 1.0};
    const MovingThing thing{rectangle(4.8, 5.2, 4.8, 5.2), {0.0, 0.0}};
    const auto contact = timeToContact(vehicle, motion, thing, {0.0, 3.0});
    ASSERT_TRUE(contact);
    EXPECT_NEAR(*contact, M_PI / 2.0, 0.1);
    EXPECT_FALSE(timeToContact(vehicle, {{5.0, 0.0}, 0.0}, thing, {0.0, 3.0}));
}

TEST(ZonePolygons, MustBeSimple) {
    EXPECT_EQ(faultOf(rectangle(0, 1, 0, 1)), "");
    EXPECT_EQ(faultOf({{0, 0}, {0, 1}, {1, 1}, {1, 0}}), "");  // the other way round
    EXPECT_THAT(faultOf({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), testing::HasSubstr("cross"));
    EXPECT_THAT(faultOf({{0, 0}, {1, 1}}), testing::HasSubstr("three corners"));
    EXPECT_NE(faultOf({{0, 0}, {1, 1}, {2, 2}}), "");
}

TEST(ZoneSets, AreValidated) {
    ZoneRule rule;
    rule.nearest = 3.0;
    ZoneSet set = setOf(rule);
    EXPECT_NO_THROW(validate(set));
    set.vehicle.clear();
    EXPECT_THROW(validate(set), std::invalid_argument);
    set = setOf({});
    set.zones.push_back(set.zones.front());
    EXPECT_THROW(validate(set), std::invalid_argument);
    rule.min_seen = 1.5;
    EXPECT_THROW(validate(setOf(rule)), std::invalid_argument);
}

}  // namespace
}  // namespace lidar_obstacles
