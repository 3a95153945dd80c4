// SPDX-License-Identifier: BSD-3-Clause
// Zones in the tools: obstacle-replay --zones and obstacle-live --zones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>

#include "support/live_program.h"
#include "support/shell.h"

namespace lidar_obstacles::test {
namespace {

const std::string kZones = PRESETS "zones.yaml";

/// Number of pixels of a picture in the red of an occupied zone.
int redPixels(const std::string& file) {
    mrpt::img::CImage picture;
    EXPECT_TRUE(picture.loadFromFile(file));
    int count = 0;
    for (unsigned y = 0; y < picture.getHeight(); ++y) {
        const auto* p = picture.ptrLine<std::uint8_t>(y);  // blue, green, red
        for (unsigned x = 0; x < picture.getWidth(); ++x, p += 3) count += p[0] < 60 && p[1] < 70 && p[2] > 220;
    }
    return count;
}

class Replay : public testing::Test {
  protected:
    int replay(const std::string& arguments) {
        return shell(std::string(OBSTACLE_REPLAY) + " " + kStreet + " --output " + folder_.file("out") + " " +
                     arguments + " > /dev/null 2> " + folder_.file("err"));
    }
    std::string out(const std::string& name) const { return readFile(folder_.file("out/" + name)); }

    TempFolder folder_;
};

TEST_F(Replay, WritesARowPerZoneAndScan) {
    ASSERT_EQ(replay("--zones " + kZones + " --format csv,jsonl"), 0);
    std::istringstream rows(out("zones.csv"));
    std::string row;
    std::getline(rows, row);
    EXPECT_EQ(row, "timestamp,scan_index,zone,state,reason,since,seen,nearest,time_to_contact,returns,id,class");
    int count = 0, occupied = 0;
    for (; std::getline(rows, row); ++count) occupied += row.find(",occupied,") != std::string::npos;
    EXPECT_EQ(count, 8 * 4);
    EXPECT_GT(occupied, 0);
    const Json summary = Json::parse(out("summary.json"));
    EXPECT_EQ(summary["health"], Json::object());
    int scans = 0;
    for (const char* state : {"free", "occupied", "unknown"}) scans += summary["zones"]["stop"][state].get<int>();
    EXPECT_EQ(scans, 8);
    std::istringstream lines(out("obstacles.jsonl"));
    for (std::string line; std::getline(lines, line);) {
        const Json json = Json::parse(line);
        ASSERT_EQ(json["zones"].size(), 4u);
        EXPECT_EQ(json["zones"][0]["name"], "stop");
        EXPECT_TRUE(json["health"]["ok"].get<bool>());
    }
}

TEST_F(Replay, WritesLowThingsWhereTheyAreLookedFor) {
    ASSERT_EQ(replay("--format csv,jsonl --set low.enabled=true"), 0);
    EXPECT_THAT(out("low_things.csv"), testing::StartsWith("timestamp,scan_index,kind,x,y,length,width,yaw,height,"));
    std::istringstream lines(out("obstacles.jsonl"));
    for (std::string line; std::getline(lines, line);) EXPECT_TRUE(Json::parse(line)["low"].is_array());
    ASSERT_EQ(replay("--format csv,jsonl --set low.enabled=false"), 0);
    EXPECT_EQ(out("low_things.csv"), "");
    EXPECT_EQ(out("obstacles.jsonl").find("\"low\""), std::string::npos);
}

TEST_F(Replay, TakesAwayTheZonesOfAnEarlierRun) {
    ASSERT_EQ(replay("--to 1 --zones " + kZones), 0);
    ASSERT_EQ(replay("--to 1"), 0);
    EXPECT_EQ(out("zones.csv"), "");
}

TEST_F(Replay, NamesFileAndLineOfABadZone) {
    writeFile(folder_.file("bad.yaml"), "zones:\n  - name: a\n    polygon: [[0, 0], [1, 1], [1, 0], [0, 1]]\n");
    EXPECT_EQ(replay("--zones " + folder_.file("bad.yaml")), 2);
    EXPECT_THAT(readFile(folder_.file("err")), testing::HasSubstr("bad.yaml:3: zones[0].polygon: its sides cross"));
}

TEST_F(Replay, RecordsZonesAsTheWindowDrawsThem) {
    const std::string view = "--to 0 --view 5,0,30,180,55 --layers ground --record " + folder_.file("frames");
    const std::string frame = folder_.file("frames/frame_000000.png");
    ASSERT_EQ(replay(view), 0);
    const int axis = redPixels(frame);  // of the vehicle's marker
    ASSERT_EQ(replay(view + " --zones " + kZones), 0);
    EXPECT_GT(redPixels(frame), axis + 200);
}

TEST_F(Live, LinesHaveZonesAndGoOnWithoutScans) {
    auto live = startListening({"--sensor-pose", "0,0,1.85,0,0,0", "--standing-at", "0,0,0,0,0,0", "--zones", kZones,
                                "--serve", "127.0.0.1:0"});
    const std::string endpoint = waitFor("serving results on ");
    Program client({"/usr/bin/env", "python3", ZONES_CLIENT, "127.0.0.1", endpoint.substr(endpoint.find(':') + 1), "9"},
                   file("client"), file("client_err"));
    send({"--duration", "1.5"});
    std::this_thread::sleep_for(std::chrono::milliseconds(1200));
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    EXPECT_EQ(client.wait(), 0) << readFile(file("client_err"));
    std::size_t scans = 0;
    bool free = false;
    Json last;
    std::istringstream text(readFile(file("out")));
    for (std::string line; std::getline(text, line);) {
        last = Json::parse(line);
        ASSERT_EQ(last["zones"].size(), 4u) << line;
        if (last["scan_index"].is_null()) continue;
        ++scans;
        EXPECT_TRUE(last.contains("health"));
        EXPECT_NE(last["zones"][0]["reason"], "no_scan");
        free = free || last["zones"][0]["state"] == "free";
    }
    const std::string told = readFile(file("client"));
    EXPECT_THAT(told, testing::HasSubstr("stop: unknown"));
    EXPECT_EQ(told.find("stop: free") != std::string::npos, free) << told;
    EXPECT_GT(scans, 0u) << "how many depends on the machine";
    EXPECT_TRUE(last["scan_index"].is_null());
    EXPECT_EQ(last["zones"][0]["state"], "unknown");
    EXPECT_EQ(last["zones"][0]["reason"], "no_scan");
}

}  // namespace
}  // namespace lidar_obstacles::test
