// SPDX-License-Identifier: BSD-3-Clause
// obstacle-replay --gui: clicks, the table, the timeline, zones, labels, the parameters' panel.
#include "support/window_fixture.h"

namespace lidar_obstacles {
namespace {

using nlohmann::json;
using test::waitUntil;
using testing::ContainsRegex;
using testing::HasSubstr;
using namespace std::chrono_literals;

class Panels : public test::WindowTest {
  protected:
    void waitForSurvey() { ASSERT_TRUE(shows("surveyed", 8)); }
    /// Where the first box of a class is; its number comes first.
    json boxOf(const std::string& cls) {
        const json now = state();
        for (std::size_t k = 0; k < now["boxes"].size(); ++k)
            if (now["boxes"][k][0] == cls) return now["box_at"][k];
        return json::array({-1, 0, 0});
    }
    /// gt.csv: the boxes of pedestrians become phantoms.
    void writeTruthWithoutPedestrians() {
        std::istringstream all(test::readFile(STREET_SAMPLE "_gt.csv"));
        std::string without;
        for (std::string row; std::getline(all, row);)
            if (row.find(",pedestrian,") == std::string::npos) without += row + "\n";
        test::writeFile(folder_.file("gt.csv"), without);
    }
    void quit() {
        press("q");
        EXPECT_EQ(replay_->wait(), 0) << test::readFile(folder_.file("out"));
    }
};

TEST_F(Panels, AClickedBoxShowsItsNumbersItsHistoryAndWhy) {
    ASSERT_NO_FATAL_FAILURE(open());
    ASSERT_NO_FATAL_FAILURE(waitForSurvey());
    press("End");
    EXPECT_TRUE(shows("scan", 7));
    const json box = boxOf("pedestrian");
    click(box[1], box[2]);
    ASSERT_TRUE(shows("chosen", box[0]));
    ASSERT_TRUE(waitUntil([&] { return !state()["numbers"].empty(); }, 20s));
    const json now = state();
    for (const char* name : {"class", "size", "speed", "distance", "age", "returns"})
        EXPECT_TRUE(now["numbers"].contains(name)) << name;
    EXPECT_THAT(now["numbers"]["class"].get<std::string>(), HasSubstr("pedestrian, 0."));
    EXPECT_GT(now["history"].get<int>(), 1);
    EXPECT_EQ(now["plots"], json::array({"speed", "distance", "size", "class"}));
    ASSERT_FALSE(now["reasons"].empty());
    EXPECT_THAT(now["reasons"][0].get<std::string>(), HasSubstr("told: pedestrian"));
    EXPECT_EQ(now["camera"], "follow") << "a click is no drag";
    click(300.0, 520.0);
    EXPECT_TRUE(shows("chosen", nullptr)) << "beside everything";
    quit();
}

TEST_F(Panels, TheChosenBoxIsFoundAgainAfterAJump) {
    ASSERT_NO_FATAL_FAILURE(open());
    ASSERT_NO_FATAL_FAILURE(waitForSurvey());
    press("End");
    EXPECT_TRUE(shows("scan", 7));
    const json box = boxOf("vehicle");
    click(box[1], box[2]);
    ASSERT_TRUE(shows("chosen", box[0]));
    const auto width = [&] { return state()["numbers"].value("size", ""); };
    ASSERT_TRUE(waitUntil([&] { return !width().empty(); }, 20s));
    press("Left Left Left");
    EXPECT_TRUE(shows("scan", 4));
    EXPECT_TRUE(waitUntil([&] { return !width().empty(); }, 20s)) << "the car is there, under another number";
    quit();
}

TEST_F(Panels, TheTableIsSortedByAClickAndCentresOnARow) {
    ASSERT_NO_FATAL_FAILURE(open("--size 1200x800"));
    press("4");
    ASSERT_TRUE(waitUntil([&] { return state()["rows"].size() > 5; }, 20s));
    const json by_distance = state()["rows"];
    const json at = state()["header_at"]["id"];
    click(at);
    ASSERT_TRUE(waitUntil([&] { return state()["rows"] != by_distance; }, 20s));
    json sorted = state()["rows"];
    std::sort(sorted.begin(), sorted.end(), [](const json& a, const json& b) { return a.get<int>() < b.get<int>(); });
    EXPECT_EQ(state()["rows"], sorted);
    click(state()["row_at"][2]);
    EXPECT_TRUE(shows("chosen", sorted[2]));
    EXPECT_TRUE(shows("camera", "free"));
    const json now = state();
    for (const json& box : now["box_at"])
        if (box[0] == sorted[2]) {
            EXPECT_NEAR(box[1].get<double>(), now["scene"][2].get<double>() / 2, 2.0);
            EXPECT_NEAR(box[2].get<double>(), now["scene"][3].get<double>() / 2, 2.0);
        }
    quit();
}

TEST_F(Panels, TheTimelineSeeksJumpsToMarksAndPlaysARange) {
    ASSERT_NO_FATAL_FAILURE(open());
    ASSERT_NO_FATAL_FAILURE(waitForSurvey());
    const json marks = state()["marks"];
    ASSERT_GT(marks.size(), 3U);
    press("bracketright");
    EXPECT_TRUE(shows("scan", marks[0][0]));
    EXPECT_THAT(state()["message"].get<std::string>(), ContainsRegex("(new|lost) track: "));
    press("bracketleft");
    EXPECT_TRUE(shows("message", "no mark before this scan"));
    const json bar = state()["bar"];
    const double x = bar[0].get<double>() + bar[2].get<double>() * 5.0 / 7.0;
    click(x, bar[1].get<double>() + 5);
    EXPECT_TRUE(shows("scan", 5));
    press("slash Right slash");
    EXPECT_TRUE(shows("range", json::array({5, 6})));
    press("l Up Up Up Up Up space");
    EXPECT_TRUE(shows("playing", true));
    for (const int scan : {5, 6, 5}) EXPECT_TRUE(shows("scan", scan)) << "in a loop";
    press("space slash");
    EXPECT_TRUE(waitUntil([&] { return !state().contains("range"); }, 20s));
    quit();
}

TEST_F(Panels, PhantomsAgainstTheTruthAreMarks) {
    writeTruthWithoutPedestrians();
    ASSERT_NO_FATAL_FAILURE(open("--truth gt.csv"));
    ASSERT_NO_FATAL_FAILURE(waitForSurvey());
    std::size_t phantoms = 0;
    const json marks = state()["marks"];
    for (const json& mark : marks) {
        if (mark[1] != "phantom") continue;
        phantoms += mark[2].get<std::string>().find("pedestrian") == 0 ? 1 : 0;
        EXPECT_THAT(mark[2].get<std::string>(), HasSubstr("where the truth has nothing"));
    }
    EXPECT_GE(phantoms, 2U);
    quit();
}

TEST_F(Panels, TheFeaturesOfTheChosenBoxUnfold) {
    writeTruthWithoutPedestrians();
    ASSERT_NO_FATAL_FAILURE(open("--size 1200x900 --truth gt.csv"));
    ASSERT_NO_FATAL_FAILURE(waitForSurvey());
    const json box = boxOf("vehicle");
    click(box[1], box[2]);
    ASSERT_TRUE(shows("chosen", box[0]));
    ASSERT_TRUE(waitUntil([&] { return !state()["numbers"].empty(); }, 20s));
    EXPECT_TRUE(state()["features"].empty()) << "folded";
    click(state()["features_at"]);
    ASSERT_TRUE(waitUntil([&] { return !state()["features"].empty(); }, 20s));
    const json features = state()["features"];
    EXPECT_TRUE(features.contains("range"));
    EXPECT_THAT(features["length"].get<std::string>(), testing::EndsWith(" m"));
    takePicture("window_features.png");
    quit();
}

TEST_F(Panels, ZonesRegionAndMergesAreDrawn) {
    test::writeFile(folder_.file("zones.yaml"),
                    "zones:\n  - name: stop\n    polygon: [[4, -1.2], [9, -1.2], [9, 1.2], [4, 1.2]]\n"
                    "  - name: left\n    polygon: [[2, 2], [8, 2], [8, 5], [2, 5]]\n"
                    "  - name: behind\n    polygon: [[-40, -1], [-30, -1], [-30, 1], [-40, 1]]\n");
    ASSERT_NO_FATAL_FAILURE(open("--size 1120x760 --zones zones.yaml"));
    ASSERT_NO_FATAL_FAILURE(waitForSurvey());
    press("End");
    EXPECT_TRUE(shows("scan", 7));
    EXPECT_EQ(state()["zones"][0], json::array({"stop", "occupied"})) << "pedestrians cross";
    EXPECT_EQ(state()["layers"]["zones"], 3);
    const json vehicle = boxOf("vehicle");
    click(vehicle[1], vehicle[2]);
    EXPECT_TRUE(shows("chosen", vehicle[0]));
    takePicture("window.png");
    press("5 7");
    EXPECT_TRUE(showsLayer("region", true));
    EXPECT_GT(state()["layers"]["merges"].get<int>(), 10);
    quit();
}

TEST_F(Panels, LabelsDoNotCoverEachOtherAndTheSceneKeepsTwoThirds) {
    ASSERT_NO_FATAL_FAILURE(open("--size 640x480 --layers all --truth '" STREET_SAMPLE "_gt.csv'"));
    press("4 p");
    EXPECT_TRUE(shows("panel", true));
    ASSERT_TRUE(waitUntil([&] { return state()["rows"].size() > 5; }, 20s));
    const json now = state();
    EXPECT_EQ(now["window"], json::array({640, 480}));
    EXPECT_GE(3 * now["scene"][2].get<double>() * now["scene"][3].get<double>(), 2.0 * 640 * 480);
    const json labels = now["labels"];
    EXPECT_GE(labels.size(), 4U);
    std::size_t rings = 0;
    for (std::size_t a = 0; a < labels.size(); ++a) {
        rings += labels[a][0] == "10 m" || labels[a][0] == "20 m" ? 1 : 0;
        for (std::size_t b = 0; b < a; ++b) {
            const json& p = labels[a][1];
            const json& q = labels[b][1];
            const bool apart = p[0].get<double>() >= q[0].get<double>() + q[2].get<double>() ||
                               q[0].get<double>() >= p[0].get<double>() + p[2].get<double>() ||
                               p[1].get<double>() >= q[1].get<double>() + q[3].get<double>() ||
                               q[1].get<double>() >= p[1].get<double>() + p[3].get<double>();
            EXPECT_TRUE(apart) << labels[a] << labels[b];
        }
    }
    EXPECT_GE(rings, 1U) << "the circles have their distances";
    quit();
}

TEST_F(Panels, ParametersAreInGroupsThatOpenForTheChosenOne) {
    ASSERT_NO_FATAL_FAILURE(
        open("--size 1120x760 --set pipeline.algorithm=16-plane --truth '" STREET_SAMPLE "_gt.csv'"));
    ASSERT_NO_FATAL_FAILURE(waitForSurvey());
    press("End 4 5 p");
    EXPECT_TRUE(shows("scan", 7));
    EXPECT_TRUE(shows("open_groups", json::array({"pipeline"})));
    ASSERT_TRUE(waitUntil([&] { return state()["rows"].size() > 5; }, 20s));
    takePicture("window_tracks.png");
    for (int k = 0; k < 4; ++k) press("Down");
    EXPECT_TRUE(waitUntil([&] { return state()["open_groups"].size() == 2; }, 20s)) << state()["open_groups"];
    quit();
}

TEST_F(Panels, AChangedParameterHasAStarUntilItIsTheDefaultAgain) {
    ASSERT_NO_FATAL_FAILURE(open("--set pipeline.algorithm=16-plane"));
    press("p");
    EXPECT_TRUE(shows("starred", json::array({"pipeline.algorithm"})));
    press("BackSpace");
    EXPECT_TRUE(shows("starred", json::array()));
    EXPECT_EQ(state()["open_groups"], json::array({"pipeline"})) << "its row is there, without a star";
    press("plus");
    EXPECT_TRUE(shows("starred", json::array({"pipeline.algorithm"})));
    quit();
}

TEST_F(Panels, TheLegendNamesTheVisibleLayersAndGoesByItsKey) {
    ASSERT_NO_FATAL_FAILURE(open("--layers ground,merges"));
    const json lines = json::array({"ground", "joined", "not joined"});
    EXPECT_TRUE(shows("legend", lines));
    press("8");
    EXPECT_TRUE(shows("legend", json::array()));
    press("8 g");
    EXPECT_TRUE(shows("legend", json::array({"joined", "not joined"})));
    quit();
}

}  // namespace
}  // namespace lidar_obstacles
