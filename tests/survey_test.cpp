// SPDX-License-Identifier: BSD-3-Clause
// Marks of the timeline for what is wrong with the sensor, and for scans that took too long.
#include "survey.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "support/rawlog_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::apps {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

constexpr double kDegree = M_PI / 180.0;

/// Marks of a kind: the place of the scan, and the text.
std::vector<std::pair<std::size_t, std::string>> marksOf(const History& history, MarkKind kind) {
    std::vector<std::pair<std::size_t, std::string>> marks;
    for (const Mark& m : history.marks())
        if (m.kind == kind) marks.emplace_back(m.scan, m.text);
    return marks;
}

using At = std::pair<std::size_t, std::string>;

/// A scan every 0.1 s of which only the sensor's health is known.
History historyOf(const std::vector<HealthReport>& reports) {
    History h;
    for (const HealthReport& report : reports) h.add({}, 0.1 * static_cast<double>(h.scans()), {{}, report});
    return h;
}

HealthReport blocked(double from_deg, double to_deg) {
    HealthReport report;
    report.blocked = {{from_deg * kDegree, to_deg * kDegree}};
    return report;
}

TEST(Faults, AreMarkedWhereTheyBeginAndAgainWhenTheyComeBack) {
    const History h = historyOf({{}, blocked(30, 60), blocked(30, 60), {}, blocked(30, 60)});
    EXPECT_THAT(marksOf(h, MarkKind::Fault), ElementsAre(At{1, "blocked 30 to 60 deg"}, At{4, "blocked 30 to 60 deg"}));
    EXPECT_STREQ(toString(MarkKind::Fault), "sensor fault");
}

TEST(Faults, ABlockedSectorThatGrowsIsTheSameOneAlsoAcrossTheRear) {
    EXPECT_EQ(marksOf(historyOf({blocked(30, 60), blocked(25, 70)}), MarkKind::Fault).size(), 1U);
    EXPECT_EQ(marksOf(historyOf({blocked(-180, -170), blocked(175, 190)}), MarkKind::Fault).size(), 1U);
    EXPECT_EQ(marksOf(historyOf({blocked(30, 60), blocked(90, 100)}), MarkKind::Fault).size(), 2U);
}

TEST(Faults, OfEachKindAreMarkedByThemselves) {
    HealthReport report = blocked(30, 60);
    std::vector<HealthReport> reports = {{}, report};
    report.silent_rings = {5};
    reports.push_back(report);
    report.silent_rings = {5, 9};
    reports.push_back(report);
    report.turned = true;
    report.turned_by = 4.5 * kDegree;
    reports.push_back(report);
    report.wrong_rate = true;
    report.rate = 5.0;
    report.usual_rate = 10.0;
    report.poses_lost = true;
    reports.push_back(report);
    EXPECT_THAT(marksOf(historyOf(reports), MarkKind::Fault),
                ElementsAre(At{1, "blocked 30 to 60 deg"}, At{2, "ring 5 silent"}, At{3, "ring 9 silent"},
                            At{4, "mount turned by 4.5 deg"}, At{5, "5.0 scans/s, not 10.0, poses lost"}));
}

TEST(SlowScans, AreMarkedWhereTheyBeginToTakeLongerThanFromScanToScan) {
    History h;
    for (const double took : {0.3, 0.09, 0.12, 0.13, 0.08, 0.104})
        h.add({}, 0.1 * static_cast<double>(h.scans()), {{}, {}, took});
    EXPECT_THAT(marksOf(h, MarkKind::SlowScan), ElementsAre(At{2, "it took 120 ms, and scans come every 100 ms"},
                                                            At{5, "it took 104 ms, and scans come every 100 ms"}))
        << "the first one: not known yet how often they come";
    EXPECT_STREQ(toString(MarkKind::SlowScan), "slow scan");
}

/// A turn on flat ground with a wall ahead; nothing comes from within 20 to 50 degrees on the right where that is
/// muddy.
test::VelodyneScan groundScan(bool muddy) {
    const auto range = [muddy](double azimuth, double elevation) {
        if (muddy && azimuth > 20.0 * kDegree && azimuth < 50.0 * kDegree) return 0.0;
        const double ground = elevation < -0.01 ? 1.8 / std::sin(-elevation) : 100.0;
        const double wall = test::wallAt(15.0)(azimuth, elevation);
        return wall > 0.0 && wall < ground ? wall : ground < 60.0 ? ground : 0.0;
    };
    test::VelodyneScan scan = test::makeScan({}, range);
    scan.sensorLabel = "velodyne";
    scan.sensorPose = mrpt::poses::CPose3D(0.0, 0.0, 1.8, 0.0, 0.0, 0.0);
    return scan;
}

TEST(SurveyOfABlockedSensor, MarksTheFaultOnceItHasLastedASecond) {
    const test::TempFolder folder;
    const test::VelodyneScan clean = groundScan(false), muddy = groundScan(true);
    test::Objects objects;
    for (int k = 0; k < 45; ++k) {
        auto scan = std::make_shared<test::VelodyneScan>(k < 30 ? clean : muddy);
        scan->timestamp = mrpt::Clock::fromDouble(1'000'000.0 + 0.1 * k);
        objects.push_back(scan);
    }
    test::writeRawlog(folder.file("muddy.rawlog"), objects, false);
    const ScanStore store(folder.file("muddy.rawlog"), {{}, 0, 1'000'000, 1});
    Player player(store, {}, {});
    while (!store.complete() || (player.poses() && !player.poses()->complete()))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    Survey survey;
    while (survey.step(player)) {
    }
    ASSERT_EQ(survey.history().scans(), 45U);
    const auto faults = marksOf(survey.history(), MarkKind::Fault);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_THAT(faults[0].first, testing::AllOf(testing::Ge(39U), testing::Le(41U))) << "it began with scan 30";
    EXPECT_THAT(faults[0].second, StartsWith("blocked -50 to -20 deg"));
}

}  // namespace
}  // namespace lidar_obstacles::apps
