// SPDX-License-Identifier: BSD-3-Clause
// obstacle-replay --format mcap: read by the official library, held against Foxglove's schemas and obstacles.csv.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/node.h"
#include "support/replay_run.h"

namespace lidar_obstacles {
namespace {

using nlohmann::json;
using test::CsvRow;
using test::readFile;
using testing::HasSubstr;

constexpr const char* kStreet = DATASETS "street_sample.rawlog";
constexpr std::size_t kScans = 8;

class Mcap : public testing::Test, public test::ReplayRun {
  protected:
    /// What the official reader finds in the file.
    json readBack() const {
        const int code =
            test::shell("node '" LIDAR_OBSTACLES_NODE "/read_mcap.mjs' '" LIDAR_OBSTACLES_NODE_MODULES "' '" +
                        file("out/obstacles.mcap") + "' >'" + file("json") + "' 2>'" + file("node_err") + "'");
        EXPECT_EQ(code, 0) << readFile(file("node_err"));
        return code == 0 ? json::parse(readFile(file("json"))) : json();
    }
    static const json& channel(const json& all, const std::string& topic) {
        for (const json& c : all["channels"])
            if (c["topic"] == topic) return c;
        throw std::runtime_error("no topic " + topic);
    }
    static std::size_t bytesOf(const std::string& base64) {
        std::size_t size = base64.size() / 4 * 3;
        for (std::size_t k = base64.size(); k > 0 && base64[k - 1] == '='; --k) --size;
        return size;
    }
};

TEST_F(Mcap, TheOfficialReaderFindsEveryMessageAndItsCheckSumsRight) {
    LIDAR_OBSTACLES_NEED_NODE("@mcap/core");
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --format csv,mcap"), 0) << err();
    const json all = readBack();
    ASSERT_FALSE(all.is_null());
    EXPECT_EQ(all["records"]["Chunk"], kScans);
    EXPECT_EQ(all["records"]["MessageIndex"], 5 * kScans);
    EXPECT_EQ(all["records"]["ChunkIndex"], kScans);
    EXPECT_EQ(all["statistics"]["chunks"], kScans);
    EXPECT_EQ(all["statistics"]["messages"], 5 * kScans);
    EXPECT_EQ(all["metadata"][0]["input"], kStreet);
    EXPECT_THAT(all["metadata"][0]["parameters"].get<std::string>(), HasSubstr("[region]"));
    ASSERT_EQ(all["channels"].size(), 5U);
    for (const json& c : all["channels"]) {
        EXPECT_EQ(c["messages"].size(), kScans) << c["topic"];
        EXPECT_EQ(c["encodings"], (json{"json", "jsonschema"}));
        for (std::size_t k = 0; k < kScans; ++k) EXPECT_EQ(c["messages"][k]["sequence"], k);
    }
}

TEST_F(Mcap, SchemasAndMessagesAreFoxgloves) {
    LIDAR_OBSTACLES_NEED_NODE("@foxglove/schemas");
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --format mcap"), 0) << err();
    const json file = readBack();
    for (const json& c : file["channels"]) {
        EXPECT_TRUE(c["isOfficial"].get<bool>()) << c["schema"] << " is not as published";
        EXPECT_EQ(c["invalid"], 0) << c["topic"];
    }
}

TEST_F(Mcap, BoxesPointsAndGridAreThoseOfTheScan) {
    LIDAR_OBSTACLES_NEED_NODE("@mcap/core");
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --format csv,mcap"), 0) << err();
    const json all = readBack();
    const json summary = json::parse(readFile(file("out/summary.json")));
    std::size_t returns = 0;
    for (std::size_t scan = 0; scan < kScans; ++scan) {
        const std::vector<CsvRow> rows = csv(scan);
        const json entities = channel(all, "/obstacles")["messages"][scan]["entities"];
        ASSERT_EQ(entities.size(), rows.size());
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const json& cube = entities[k]["cubes"][0];
            EXPECT_EQ(entities[k]["id"], rows[k].fields[2]);
            EXPECT_NEAR(cube["pose"]["position"]["x"].get<double>(), rows[k].at(4), 1e-4);
            EXPECT_NEAR(cube["size"]["z"].get<double>(), rows[k].at(9), 1e-4);
            EXPECT_NEAR(2 * std::atan2(cube["pose"]["orientation"]["z"].get<double>(),
                                       cube["pose"]["orientation"]["w"].get<double>()),
                        rows[k].at(10), 1e-5);
        }
        const json points = channel(all, "/points")["messages"][scan];
        const std::size_t stride = points["point_stride"];
        returns += bytesOf(points["data"]) / stride;
        EXPECT_EQ(bytesOf(points["data"]) % stride, 0U);
        const json& time = points["timestamp"];
        EXPECT_NEAR(time["sec"].get<double>() + time["nsec"].get<double>() * 1e-9, rows[0].at(0), 2e-6);
        const json grid = channel(all, "/grid")["messages"][scan];
        EXPECT_EQ(bytesOf(grid["data"]) % grid["column_count"].get<std::size_t>(), 0U);
    }
    EXPECT_EQ(returns, summary["returns"]);
    EXPECT_EQ(channel(all, "/tf")["messages"][0]["parent_frame_id"], "world");
}

TEST_F(Mcap, AFileWithoutObstaclesOrPosesIsWholeToo) {
    LIDAR_OBSTACLES_NEED_NODE("@mcap/core");
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --format mcap --to 1 --set region.front=1 --set "
                                                          "region.rear=1 --set ego.source=none"),
              0)
        << err();
    const json all = readBack();
    ASSERT_FALSE(all.is_null());
    EXPECT_EQ(channel(all, "/obstacles")["messages"].size(), 2U);
    EXPECT_EQ(channel(all, "/tf")["messages"].size(), 0U);
}

TEST_F(Mcap, AFullDiskIsAnErrorAndLeavesWholeChunks) {
    EXPECT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --format mcap", "trap '' XFSZ; ulimit -f 3000;"), 1);
    EXPECT_THAT(err(), HasSubstr("obstacles.mcap: cannot write"));
    const std::string left = readFile(file("out/obstacles.mcap"));
    ASSERT_GT(left.size(), 100000U);
    std::size_t at = 8;  // behind the magic: kind, length and content of each record
    while (at + 9 <= left.size()) {
        std::uint64_t length = 0;
        for (std::size_t k = 8; k > 0; --k) length = length << 8U | static_cast<unsigned char>(left[at + k]);
        at += 9 + length;
    }
    EXPECT_EQ(at, left.size());
    EXPECT_FALSE(std::filesystem::exists(file("out/obstacles.mcap.part")));
}

}  // namespace
}  // namespace lidar_obstacles
