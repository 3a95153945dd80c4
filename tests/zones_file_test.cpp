// SPDX-License-Identifier: BSD-3-Clause
// Files of zones: what they may say, and that every fault is told with its line.
#include "lidar_obstacles/mrpt_bridge/zones_file.h"

#include <gtest/gtest.h>

namespace lidar_obstacles {
namespace {

const std::string kHead = "vehicle: [[-1, -1], [2, -1], [2, 1], [-1, 1]]\nzones:\n";
const std::string kZone = "  - name: stop\n    polygon: [[2, -1], [6, -1], [6, 1], [2, 1]]\n";

std::string faultIn(const std::string& text) {
    try {
        parseZones(text, "z.yaml");
    } catch (const ZonesFileError& e) {
        return e.what();
    }
    return "";
}

TEST(ZonesFile, IsReadWithItsDefaults) {
    const ZoneSet set = parseZones(kHead + kZone, "z.yaml");
    ASSERT_EQ(set.zones.size(), 1u);
    const Zone& zone = set.zones.front();
    EXPECT_EQ(zone.name, "stop");
    EXPECT_EQ(zone.frame, ZoneFrame::Vehicle);
    EXPECT_EQ(zone.polygon, (Outline{{2, -1}, {6, -1}, {6, 1}, {2, 1}}));
    EXPECT_FALSE(zone.rule.nearest);
    EXPECT_EQ(zone.rule.off_after, 0.5);
    EXPECT_FALSE(set.max_latency);
}

TEST(ZonesFile, WhatIsWrittenReadsBackAsTheSame) {
    const std::string usual = kHead + kZone;
    EXPECT_EQ(zonesText(parseZones(usual, "z.yaml")).find("margin"), std::string::npos)
        << "what is as usual is left out";
    const std::string odd =
        "max_latency: 0.25\n" + kHead + kZone +
        "  - name: \"gate: 'a' #1\"\n    frame: map\n    polygon: [[0.1, -1], [1e-3, 12.25], [-7, 3]]\n    nearest: "
        "3.5\n"
        "    time_to_contact: 2\n    classes: [vehicle, cyclist]\n    min_probability: 0.4\n    min_age: 0.3\n"
        "    min_returns: 5\n    max_height: 1.5\n    margin: 0.2\n    object_height: 0.5\n    min_seen: 0.8\n"
        "    on_after: 0.1\n    off_after: 1\n";
    for (const std::string& text : {usual, odd}) {
        const std::string once = zonesText(parseZones(text, "z.yaml"));
        EXPECT_EQ(zonesText(parseZones(once, "again.yaml")), once);
    }
    const ZoneSet set = parseZones(zonesText(parseZones(odd, "z.yaml")), "again.yaml");
    EXPECT_EQ(set.vehicle.size(), 4u);
    EXPECT_EQ(set.max_latency, 0.25);
    const Zone& gate = set.zones.at(1);
    EXPECT_EQ(gate.name, "gate: 'a' #1");
    EXPECT_EQ(gate.frame, ZoneFrame::Map);
    EXPECT_EQ(gate.polygon, (Outline{{0.1, -1}, {1e-3, 12.25}, {-7, 3}}));
    EXPECT_EQ(gate.rule.nearest, 3.5);
    EXPECT_EQ(gate.rule.classes, (std::array<bool, 5>{false, true, false, true, false}));
    EXPECT_EQ(gate.rule.min_returns, 5);
    EXPECT_EQ(gate.rule.off_after, 1.0);
}

TEST(ZonesFile, TakesEveryKey) {
    const ZoneSet set = parseZones(
        "max_latency: 0.2\n" + kHead + kZone +
            "    frame: map\n    nearest: 3\n    time_to_contact: 2\n    classes: [vehicle, cyclist]\n"
            "    min_probability: 0.4\n    min_age: 0.3\n    min_returns: 5\n    max_height: 1.5\n    margin: 0.2\n"
            "    object_height: 0.5\n    min_seen: 0.8\n    on_after: 0.1\n    off_after: 1\n",
        "z.yaml");
    const ZoneRule& rule = set.zones.front().rule;
    EXPECT_EQ(set.zones.front().frame, ZoneFrame::Map);
    EXPECT_EQ(rule.classes, (std::array<bool, 5>{false, true, false, true, false}));
    EXPECT_EQ(rule.min_returns, 5);
    EXPECT_EQ(rule.time_to_contact, 2.0);
    EXPECT_EQ(set.max_latency, 0.2);
}

TEST(ZonesFile, FaultsAreToldWithFileAndLine) {
    EXPECT_EQ(faultIn(kHead + kZone + "    nearst: 3\n").substr(0, 45),
              "z.yaml:5: zones[0].nearst: unknown key; here ");
    EXPECT_EQ(faultIn(kHead + "  - name: stop\n    polygon: [[2, -1], [6, 1], [6, -1], [2, 1]]\n"),
              "z.yaml:4: zones[0].polygon: its sides cross or touch each other");
    EXPECT_EQ(faultIn(kHead + "  - name: stop\n    polygon: [[2, -1], [6, 1], [6, x]]\n"),
              "z.yaml:4: zones[0].polygon: must be a number from -99999 to 99999, not 'x'");
    EXPECT_EQ(faultIn(kHead + "  - name: stop\n    polygon: [2, -1, 6]\n"),
              "z.yaml:4: zones[0].polygon: must be a list of pairs of numbers, [[x, y], [x, y]]");
    EXPECT_EQ(faultIn(kHead + kZone + "    min_seen: 2\n"),
              "z.yaml:5: zones[0].min_seen: must be a number from 0 to 1, not 2");
    EXPECT_EQ(faultIn(kHead + kZone + "    min_returns: 2.5\n"),
              "z.yaml:5: zones[0].min_returns: must be a whole number");
    EXPECT_EQ(faultIn(kHead + kZone + "    classes: [cars]\n"),
              "z.yaml:5: zones[0].classes: 'cars' is none of unknown, vehicle, pedestrian, cyclist, structure");
    EXPECT_EQ(faultIn(kHead + kZone + kZone), "z.yaml:5: zones[1].name: there is another zone 'stop'");
    EXPECT_EQ(faultIn("zones:\n" + kZone + "    nearest: 3\n"),
              "z.yaml:4: zones[0].nearest: needs `vehicle`, the outline that it is measured from");
    EXPECT_EQ(faultIn(kHead + "  - name: \"caf\xe9\"\n    polygon: [[2, -1], [6, -1], [6, 1]]\n").substr(0, 10),
              "z.yaml:3: ");
    EXPECT_EQ(faultIn("zones: []\n"), "z.yaml:1: zones: must not be empty");
    EXPECT_EQ(faultIn("zones:\n  - name: a\n"), "z.yaml:2: zones[0].polygon: is missing");
    EXPECT_EQ(faultIn("zones: [\n").substr(0, 20), "z.yaml:2: not YAML: ");
    EXPECT_THROW(loadZones("/no/such/zones.yaml"), ZonesFileError);
}

}  // namespace
}  // namespace lidar_obstacles
