// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/scenario.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lidar_obstacles/simulation/world.h"
#include "support/small_worlds.h"

namespace lidar_obstacles::simulation {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// What reading and building a scenario complains of; "" if it does not.
std::string complaint(const std::string& text) {
    try {
        buildWorld(parseScenario(text, "my.yaml"));
        return "";
    } catch (const ScenarioError& e) {
        return e.what();
    }
}

/// The same for further lines in a good scenario.
std::string complaintAbout(const std::string& lists) { return complaint(test::scenarioText({lists})); }

TEST(Scenario, TheShippedOnesAreRight) {
    for (const char* name : {"street", "delivery", "yaw-grid"})
        EXPECT_NO_THROW(buildWorld(loadScenario(std::string(SCENARIOS) + name + ".yaml"))) << name;
}

TEST(Scenario, TheLapIsTheExperimentsOne) {
    const World world = buildWorld(loadScenario(std::string(SCENARIOS) + "monza.yaml"));
    EXPECT_DOUBLE_EQ(world.scenario.duration, 300.0);
    EXPECT_EQ(world.objects.front().model->kind, ObjectKind::Van);
    double nearest = 100.0, farthest = 0.0;
    std::vector<double> turned(300, 0.0);
    for (double t = 0.0; t < 300.0; t += 0.1) {
        const PlanarPose ego = world.ego.at(t), van = poseOf(world.objects.front().motion, t, 0);
        nearest = std::min(nearest, (van.position - ego.position).norm());
        farthest = std::max(farthest, (van.position - ego.position).norm());
        double& most = turned[static_cast<std::size_t>(t)];
        most = std::max(most, std::abs(std::remainder(van.yaw - ego.yaw, 2.0 * M_PI)) * 180.0 / M_PI);
    }
    EXPECT_LT(nearest, 2.6);
    EXPECT_GT(farthest, 20.0);
    for (std::size_t chicane : {20U, 130U, 150U, 270U}) {
        const auto from = turned.begin() + static_cast<std::ptrdiff_t>(chicane) - 5;
        EXPECT_GT(*std::max_element(from, from + 10), 40.0) << chicane;
    }
}

TEST(Scenario, ErrorsNameFileLineKeyAndWhatWasExpected) {
    EXPECT_THAT(complaintAbout("objects:\n  - {model: tank, s: 5}\n"),
                AllOf(HasSubstr("my.yaml:7"), HasSubstr("objects[0].model"), HasSubstr("sedan"), HasSubstr("'tank'")));
    EXPECT_THAT(complaintAbout("objects:\n  - {model: sedan, s: abc}\n"),
                AllOf(HasSubstr("my.yaml:7: objects[0].s: must be a number"), HasSubstr("'abc'")));
    EXPECT_THAT(complaintAbout("objects:\n  - {model: sedan, s: 5, colour: red}\n"),
                AllOf(HasSubstr("objects[0].colour: unknown key"), HasSubstr("yaw")));
    EXPECT_THAT(complaintAbout("objects:\n  - {model: sedan}\n"), HasSubstr("objects[0].s: is missing"));
    EXPECT_THAT(complaintAbout("clutter:\n  - {type: sofa, s: 5}\n"),
                AllOf(HasSubstr("clutter[0].type"), HasSubstr("tree"), HasSubstr("'sofa'")));
    EXPECT_THAT(complaintAbout("clutter:\n  - {type: wall, from: 10, to: 5}\n"), HasSubstr("clutter[0].to"));
    EXPECT_THAT(complaintAbout("objects:\n  - {model: sedan, path: [{t: 1, s: 2}, {t: 1, s: 4}]}\n"),
                HasSubstr("objects[0].path[1].t: must be larger"));
    EXPECT_THAT(complaintAbout("objects: 5\n"), HasSubstr("objects: must be a list"));
    EXPECT_THAT(complaintAbout("weather: bad\n"), HasSubstr("my.yaml:6: weather: unknown key"));
    EXPECT_THAT(complaintAbout("ego: {path: [{t: 0, s: 1}]}\n"), HasSubstr("ego: stands here twice"));
}

TEST(Scenario, BadNumbersAreErrors) {
    for (const char* value : {"nan", "inf", "1e99", "''", "[1]", "'0,5'", "0x10", "5m", "~"})
        EXPECT_THAT(complaintAbout("objects: [{model: sedan, s: " + std::string(value) + "}]\n"),
                    HasSubstr("objects[0].s"))
            << value;
    EXPECT_THAT(complaint(test::scenarioText({"", "[{t: 0, s: 100}]", ", planes: 12"})), HasSubstr("16, 8 or 4"));
    EXPECT_THAT(complaint(test::scenarioText({"", "[{t: 0, s: 100}]", ", rate: 50"})), HasSubstr("sensor.rate"));
}

TEST(Scenario, WhatIsNoYamlIsAnErrorWithItsLine) {
    EXPECT_THAT(complaint("duration: 10\ntrack: {width: [3\n"), HasSubstr("my.yaml:"));
    EXPECT_THAT(complaint(""), HasSubstr("must be a mapping"));
    EXPECT_THAT(complaint("- 1\n- 2\n"), HasSubstr("must be a mapping"));
    EXPECT_THAT(complaint(std::string("\x00\xff\x13", 3)), HasSubstr("my.yaml"));
}

TEST(Scenario, WhatStandsBesideTheTerrainIsAnError) {
    EXPECT_THAT(complaintAbout("objects: [{model: sedan, s: 100, d: 190}]\n"),
                AllOf(HasSubstr("object 1 (sedan)"), HasSubstr("terrain.reach")));
    EXPECT_THAT(complaintAbout("clutter: [{type: tree, s: 100, d: 190}]\n"), HasSubstr("terrain.reach"));
}

TEST(Scenario, WhatCannotBeBuiltIsAnErrorBeforeAnythingIsWritten) {
    EXPECT_THAT(complaint(test::scenarioText({"", "[{t: 0, s: 100}, {t: 9, s: 900}]"})), HasSubstr("terrain.reach"));
    EXPECT_THAT(complaintAbout("objects: [{model: van, row: {from: 0, to: 90000, every: 1, d: 5}}]\n"),
                HasSubstr("row.every"));
    EXPECT_THAT(complaint(test::scenarioText({"objects: [{model: van, grid: {ranges: 5, bearings: 0, yaws: 0}}]\n",
                                              "[{t: 0, s: 100}, {t: 9, s: 120}]"})),
                HasSubstr("must stand still"));
    EXPECT_THAT(complaint("duration: 1\ntrack: {segments: [{straight: 90000}, {turn: 90, radius: 9}, {straight: "
                          "90000}]}\nterrain: {cell: 0.25}\nsensor: {pose: {z: 1}}\nego: {path: [{t: 0, s: 9}]}\n"),
                HasSubstr("terrain.cell"));
    EXPECT_THAT(complaint("duration: 1\ntrack: {closed: true, elevation: [{s: 0, z: 0}, {s: 99, z: 5}], segments: "
                          "[{turn: 360, radius: 30}]}\nsensor: {pose: {z: 1}}\nego: {path: [{t: 0, s: 9}]}\n"),
                HasSubstr("elevation and bank of a closed track"));
}

TEST(Scenario, PlantsAndModelsDifferAsTheFileSays) {
    const Scenario s = parseScenario(
        test::scenarioText({"objects: [{model: [sedan, van], variant: 5, row: {from: 10, to: 40, every: 10, d: 5}}]\n"
                            "clutter: [{type: bush, s: 20, d: 9, leaves: 0.2, roughness: 0.1}, {type: shrub, s: 30}, "
                            "{type: bush, s: 40, variant: 3}]\n"}),
        "x");
    EXPECT_EQ(s.objects[0].variant, 5U);
    EXPECT_EQ(s.objects[3].variant, 8U);
    EXPECT_DOUBLE_EQ(s.clutter[0].leaves, 0.2);
    EXPECT_DOUBLE_EQ(s.clutter[0].roughness, 0.1);
    EXPECT_GT(s.clutter[1].leaves, 0.0) << "a shrub is never a shell";
    EXPECT_DOUBLE_EQ(s.clutter[2].leaves, 0.0);
    EXPECT_NE(s.clutter[2].variant, s.clutter[0].variant);
}

TEST(Scenario, MissingFilesAreErrors) { EXPECT_THROW(loadScenario("/no/such.yaml"), ScenarioError); }

TEST(Scenario, RowsBecomeOneObjectEachAndModelsTakeTurns) {
    const Scenario s = parseScenario(
        test::scenarioText({"objects: [{model: [sedan, van], row: {from: 10, to: 40, every: 10, d: 5}}]\n"}), "x");
    ASSERT_EQ(s.objects.size(), 4U);
    EXPECT_EQ(s.objects[2].model, "sedan");
    EXPECT_EQ(s.objects[3].model, "van");
    EXPECT_DOUBLE_EQ(std::get<Standing>(s.objects[3].motion).s, 40.0);
}

}  // namespace
}  // namespace lidar_obstacles::simulation
