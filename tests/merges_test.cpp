// SPDX-License-Identifier: BSD-3-Clause
// What the grouping weighed: as a list, in a scene, and in the file that obstacle-replay --explain writes.
#include <gtest/gtest.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "lidar_obstacles/grouping.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "support/shell.h"

namespace lidar_obstacles {
namespace {

namespace fs = std::filesystem;

/// Returns 0 and 1 are one thing, 2 stands alone: 3 = 0 + 1 was chosen, 4 = 3 + 2 was not.
std::vector<Hypothesis> threePieces() {
    std::vector<Hypothesis> tree(5);
    for (int k = 0; k < 3; ++k) tree[static_cast<std::size_t>(k)].points = {k};
    tree[3].part = {0, 1};
    tree[3].points = {0, 1};
    tree[3].whole = 0.9f;
    tree[3].cut = 1.8f;
    tree[3].chosen = true;
    tree[4].part = {3, 2};
    tree[4].points = {0, 1, 2};
    tree[4].whole = 0.1f;
    tree[2].cut = 0.7f;
    tree[2].chosen = true;
    return tree;
}

TEST(Merges, TellWhatWasWonAndWhatWasTaken) {
    const std::vector<Merge> merges = mergesOf(threePieces());
    ASSERT_EQ(merges.size(), 2u);
    EXPECT_EQ(merges[0].whole, 3);
    EXPECT_TRUE(merges[0].taken);
    EXPECT_GT(merges[0].together, merges[0].apart);
    EXPECT_EQ(merges[1].part, (std::array<int, 2>{3, 2}));
    EXPECT_FALSE(merges[1].taken);
    EXPECT_NEAR(merges[1].apart, 2.5f, 1e-6f);
    EXPECT_LT(merges[1].together, merges[1].apart);
    EXPECT_TRUE(mergesOf({}).empty());
}

TEST(Merges, AreLinesOfAnExplainedScene) {
    PointCloud cloud;
    cloud.xyz = {{5.F, 0.F, 1.F}, {6.F, 0.F, 1.F}, {8.F, 3.F, 1.F}};
    DetectionResult result;
    result.ground.is_ground = {0, 0, 0};
    result.ground.height = {1.F, 1.F, 1.F};
    result.hypotheses = threePieces();
    const auto lines = [&](const char* name, bool explain) -> std::size_t {
        SceneOptions options;
        options.explain = explain;
        const auto scene = toScene(cloud, result, options);
        const auto found = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(scene->getByName(name));
        return found ? found->size() : 0;
    };
    EXPECT_EQ(lines("merges_taken", true), 1u);
    EXPECT_EQ(lines("merges_refused", true), 1u);
    EXPECT_EQ(lines("merges_taken", false), 0u);
}

TEST(Merges, AreAFileOfAnExplainedReplayOnly) {
    const fs::path folder = fs::temp_directory_path() / ("lidar_obstacles_merges_" + std::to_string(getpid()));
    const auto replay = [&](const std::string& more) {
        return test::shell("'" OBSTACLE_REPLAY "' '" STREET_SAMPLE "' --to 1 --output '" + folder.string() + "' " +
                           more + " > /dev/null");
    };
    ASSERT_EQ(replay("--explain"), 0);
    std::ifstream in(folder / "merges.csv");
    std::string line;
    std::getline(in, line);
    EXPECT_EQ(
        line.rfind("timestamp,scan_index,hypothesis,part_a,part_b,x,y,num_points,gap,apart,together,taken,told", 0),
        0u);
    std::map<std::string, int> told;
    while (std::getline(in, line)) {
        std::stringstream words(line);
        std::string word;
        std::vector<std::string> row;
        while (std::getline(words, word, ',')) row.push_back(word);
        ASSERT_EQ(row.size(), 22u) << line;
        ++told[row[11] + row[12]];
    }
    EXPECT_GT(told["1vehicle"], 0);
    EXPECT_GT(told["0mixture"], 0);
    ASSERT_EQ(replay(""), 0);
    EXPECT_FALSE(fs::exists(folder / "merges.csv"));
    fs::remove_all(folder);
}

}  // namespace
}  // namespace lidar_obstacles
