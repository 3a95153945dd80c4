// SPDX-License-Identifier: BSD-3-Clause
// obstacle-replay --report: the page is read as text, and opened, played and clicked in a headless browser.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>

#include "exports/replay_page.h"
#include "support/node.h"
#include "support/replay_run.h"

namespace lidar_obstacles {
namespace {

using nlohmann::json;
using test::CsvRow;
using test::readFile;
using testing::AllOf;
using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kStreet = DATASETS "street_sample.rawlog";

class Report : public testing::Test, public test::ReplayRun {
  protected:
    /// What a browser sees of a page; null where there is none.
    json browse(const std::string& page) const {
        const int code = test::shell("node '" LIDAR_OBSTACLES_NODE "/play_page.mjs' '" + page + "' '" + file("shot") +
                                     "' 1280x800 2 >'" + file("json") + "' 2>'" + file("node_err") + "'");
        EXPECT_EQ(code, 0) << readFile(file("node_err"));
        return code == 0 ? json::parse(readFile(file("json"))) : json();
    }
    static bool hasBrowser() { return test::shell("command -v chromium >/dev/null") == 0; }
    static json metaOf(const std::string& page) {
        const std::string mark = "id=\"meta\">";
        const std::size_t at = page.find(mark) + mark.size();
        return json::parse(page.substr(at, page.find("</script>", at) - at));
    }
    static std::size_t linesOf(const std::string& page) {
        const std::size_t at = page.find("id=\"scans\">\n") + 12;
        const auto begin = page.begin() + static_cast<std::ptrdiff_t>(at);
        return static_cast<std::size_t>(
            std::count(begin, page.begin() + static_cast<std::ptrdiff_t>(page.find("</script>", at)), '\n'));
    }
};

TEST_F(Report, ThePageIsOneFileThatAsksForNoOther) {
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --report " + file("page.html")), 0) << err();
    const std::string page = readFile(file("page.html"));
    EXPECT_THAT(page, AllOf(HasSubstr("<!DOCTYPE html>"), EndsWith("</html>\n")));
    for (const char* word : {"http://", "https://", " src=", " href=", "@import", "fetch(", "import("})
        EXPECT_THAT(page, Not(HasSubstr(word)));
    EXPECT_EQ(metaOf(page)["scans"], 8);
    EXPECT_EQ(metaOf(page)["points"], metaOf(page)["returns"]);
    EXPECT_EQ(linesOf(page), 8U);
    EXPECT_LT(page.size(), 600000U);
    EXPECT_FALSE(std::filesystem::exists(file("page.html.part")));
}

TEST_F(Report, TheSameRunWritesTheSamePage) {
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --to 3 --report " + file("a.html")), 0) << err();
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --to 3 --report " + file("b.html")), 0) << err();
    EXPECT_TRUE(readFile(file("a.html")) == readFile(file("b.html")));
}

TEST_F(Report, TheInputIsNotOverwrittenAndAFileThatCannotBeWrittenIsAnError) {
    std::filesystem::copy_file(kStreet, file("drive.rawlog"));
    EXPECT_EQ(run(OBSTACLE_REPLAY, file("drive.rawlog") + " --report " + file("drive.rawlog")), 2);
    EXPECT_THAT(err(), HasSubstr("is the input"));
    EXPECT_EQ(std::filesystem::file_size(file("drive.rawlog")), std::filesystem::file_size(kStreet));
    EXPECT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --report " + file("no/page.html")), 1);
    EXPECT_THAT(err(), HasSubstr("no/page.html.part: cannot write"));
    std::filesystem::create_symlink("/dev/full", file("full.html.part"));
    EXPECT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --to 1 --report " + file("full.html")), 1);
    EXPECT_THAT(err(), HasSubstr("full.html: cannot write"));
    EXPECT_FALSE(std::filesystem::is_symlink(file("full.html"))) << "half a page is none";
    EXPECT_FALSE(std::filesystem::is_symlink(file("full.html.part")));
}

TEST_F(Report, ARunThatFindsNoScanLeavesNoPage) {
    EXPECT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --from 100 --report " + file("page.html")), 2);
    EXPECT_FALSE(std::filesystem::exists(file("page.html")));
    EXPECT_FALSE(std::filesystem::exists(file("page.html.part")));
}

/// A scan of a hedge with many returns and one vehicle with few.
SequenceResult hedgeAndVehicle(double time) {
    SequenceResult found;
    found.cloud.timestamp = time;
    std::mt19937 random(static_cast<unsigned>(time));
    const auto metres = [&](unsigned steps) { return 0.01F * static_cast<float>(random() % steps); };
    for (int k = 0; k < 20000; ++k)
        found.cloud.xyz.emplace_back(10.0F + metres(300), metres(4000) - 20.0F, metres(200));
    Obstacle vehicle;
    vehicle.cls = ObstacleClass::Vehicle;
    vehicle.box.size = {4.0, 2.0, 1.5};
    for (std::int32_t k = 0; k < 300; ++k) vehicle.points.push_back(3 * k);
    found.detection.obstacles.push_back(vehicle);
    return found;
}

TEST_F(Report, PagesAreBoundedByThinningAndSaySo) {
    apps::ReplayPage page(file("small.html"), {400'000, 10, 40'000});
    for (int k = 0; k < 25; ++k) {
        const SequenceResult found = hedgeAndVehicle(k);
        page.add({static_cast<std::size_t>(k), found, std::nullopt});
    }
    page.finish({"test", "hedge", ""});
    const std::string text = readFile(file("small.html"));
    EXPECT_LT(text.size(), 400'000U + 80'000U) << "scans, and the page itself";
    EXPECT_GT(text.size(), 300'000U) << "the room is used";
    const json meta = metaOf(text);
    EXPECT_EQ(meta["every"], 3);
    EXPECT_EQ(linesOf(text), 9U);
    EXPECT_LT(meta["points"].get<double>(), 9 * 20000);
    EXPECT_GT(meta["points"].get<double>(), 9 * 2000);
    LIDAR_OBSTACLES_NEED_NODE("");
    if (!hasBrowser()) GTEST_SKIP() << "there is no chromium";
    const json seen = browse(file("small.html"));
    EXPECT_EQ(seen["kinds"]["vehicle"], 300) << "road users are not thinned";
    EXPECT_LT(seen["kinds"]["none"], 19700);
    EXPECT_THAT(seen["note"].get<std::string>(), AllOf(HasSubstr("Thinned to fit"), HasSubstr("One scan of 3")));
}

TEST_F(Report, ABrowserLoadsItPlaysItAndAClickSelects) {
    LIDAR_OBSTACLES_NEED_NODE("");
    if (!hasBrowser()) GTEST_SKIP() << "there is no chromium (Debian: chromium)";
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --report " + file("page.html")), 0) << err();
    const json seen = browse(file("page.html"));
    ASSERT_FALSE(seen.is_null());
    EXPECT_TRUE(seen["failed"].is_null()) << seen["failed"];
    EXPECT_EQ(seen["errors"], json::array());
    EXPECT_EQ(seen["scans"], 8);
    EXPECT_GT(seen["colors"], 50) << "points, grid and boxes are drawn";
    EXPECT_GT(seen["played"], 0);
    // What the page unpacked is what the run found.
    std::map<std::string, int> returns;
    for (const CsvRow& row : csv(0)) returns[row.fields[3]] += static_cast<int>(row.at(12));
    for (const auto& [name, count] : returns) EXPECT_EQ(seen["kinds"][name], count) << name;
    // A click on a box shows its numbers.
    ASSERT_TRUE(seen["aimed"].is_object());
    EXPECT_EQ(seen["picked"], seen["aimed"]["id"]);
    EXPECT_EQ(seen["stillPicked"], seen["picked"]) << "turning the view is no click";
    EXPECT_EQ(seen["plots"], 4);
    for (const CsvRow& row : csv(0)) {
        if (std::stoi(row.fields[2]) != seen["picked"]) continue;
        const std::string distance = seen["numbers"]["distance"];
        EXPECT_NEAR(std::stod(distance), row.at(15), 0.006);
        EXPECT_THAT(seen["numbers"]["returns, planes"].get<std::string>(), HasSubstr(row.fields[12]));
    }
    EXPECT_TRUE(seen["turned"].get<bool>());
    EXPECT_EQ(seen["slidTo"], 7);
    EXPECT_TRUE(seen["left"].is_null()) << "Escape selects nothing";
    EXPECT_GT(seen["listed"], 0);
    EXPECT_NE(seen["themes"][0], seen["themes"][1]);
    EXPECT_TRUE(std::filesystem::exists(file("shot_picked.png")));
}

}  // namespace
}  // namespace lidar_obstacles
