// SPDX-License-Identifier: BSD-3-Clause
// obstacle-evaluate: pages that play the worst scans of a report.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/shell.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using test::readFile;
using testing::HasSubstr;

class EvaluateReplays : public testing::Test {
  protected:
    std::string path(const std::string& name) const { return folder_.file(name); }
    /// Evaluates the street sample. @return the exit code.
    int run(const std::string& arguments, const std::string& output = "results") const {
        return test::shell("'" OBSTACLE_EVALUATE "' --rawlog " STREET_SAMPLE ".rawlog --truth " STREET_SAMPLE
                           "_gt.csv --output '" +
                           path(output) + "' " + arguments + " >'" + path("stdout") + "' 2>&1");
    }

  private:
    test::TempFolder folder_;
};

/// What a page says of itself.
json metaOf(const std::string& page) {
    const std::string mark = "id=\"meta\">";
    const std::size_t at = page.find(mark);
    if (at == std::string::npos) return {};
    return json::parse(page.substr(at + mark.size(), page.find("</script>", at) - at - mark.size()));
}

TEST_F(EvaluateReplays, TheWorstScansArePlayed) {
    ASSERT_EQ(run("--worst 2"), 0) << readFile(path("stdout"));
    const std::string page = readFile(path("results/report.html"));
    EXPECT_THAT(page, HasSubstr("<a href=\"replays/worst_01.html#scan="));
    EXPECT_THAT(page, HasSubstr("<a href=\"replays/worst_02.html#scan="));
    const json meta = metaOf(readFile(path("results/replays/worst_01.html")));
    EXPECT_EQ(meta["scans"], 8);
    EXPECT_THAT(meta["note"].get<std::string>(), HasSubstr("tracks are numbered anew"));
    EXPECT_FALSE(fs::exists(path("results/replays/worst_03.html")));
}

TEST_F(EvaluateReplays, DetectionsThatAreGivenArePlayed) {
    ASSERT_EQ(run("--no-report"), 0);
    EXPECT_FALSE(fs::exists(path("results/replays")));
    ASSERT_EQ(run("--worst 1 --detections '" + path("results/street_sample/obstacles.csv") + "'", "given"), 0)
        << readFile(path("stdout"));
    const json meta = metaOf(readFile(path("given/replays/worst_01.html")));
    EXPECT_EQ(meta["scans"], 8);
    EXPECT_THAT(meta["note"].get<std::string>(), HasSubstr("with the detections that were given"));
}

TEST_F(EvaluateReplays, NothingOfAnEarlierRunStays) {
    ASSERT_EQ(run("--worst 1"), 0);
    EXPECT_TRUE(fs::exists(path("results/replays/worst_01.html")));
    ASSERT_EQ(run("--no-report"), 0);
    EXPECT_FALSE(fs::exists(path("results/replays")));
}

}  // namespace
}  // namespace lidar_obstacles
