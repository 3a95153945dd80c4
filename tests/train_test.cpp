// SPDX-License-Identifier: BSD-3-Clause
// Recordings of the user's own in the training: what their truth boxes say of each return, and what obstacle-train
// says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>

#include "box_labels.h"
#include "hold_out.h"
#include "importances.h"
#include "lidar_obstacles/evaluation/csv_table.h"
#include "lidar_obstacles/evaluation/truth.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "lidar_obstacles/simulation/labels.h"
#include "recording_truth.h"
#include "samples.h"
#include "support/shell.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::apps {
namespace {

using test::readFile;
using test::shell;
using test::writeFile;
using testing::AllOf;
using testing::HasSubstr;

constexpr LabelledView kAllAround{M_PI, 50.0};
constexpr const char* kHeader = "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points\n";

LabelledBox carAhead() {
    return {{{10.0, 0.0, 0.75}, {4.0, 1.8, 1.5}, M_PI / 2.0}, 30, 7, ObjectKind::Car};  // across the road
}

/// The label of one return.
simulation::ReturnLabel at(const Eigen::Vector3f& point, const std::vector<LabelledBox>& boxes,
                           const LabelledView& view = kAllAround) {
    PointCloud cloud;
    cloud.xyz = {point};
    return labelsByBoxes(cloud, boxes, view).at(0);
}

bool isStructure(const simulation::ReturnLabel& label) {
    return label.id == 0 && classOf(label.kind) == ObstacleClass::Structure;
}

TEST(ModelCard, TheFirstQuestionsWeighMost) {
    // length, then width; to judge: one leaf, and a tree that asks for the range alone
    const std::string model =
        "grouping 1 0\ntrees 1\ntree 5\n3 1.5 1\n4 0.5 3\n0 0.1\n0 0.2\n0 -0.1\n"
        "verdict 1 0\ntrees 2\ntree 1\n0 0.1\ntree 3\n2 9 1\n0 1\n0 2\n";
    EXPECT_THAT(importancesText(model), AllOf(HasSubstr("* to form groups: `length` 67 %, `width` 33 %.\n"),
                                              HasSubstr("* to judge: `range` 100 %.\n")));
}

TEST(ModelCard, OfTheBuiltInModelTellsWhatItsTreesAskFor) {
    EXPECT_THAT(readFile(MODELS "recognizer.md"), HasSubstr(importancesText(readFile(MODELS "recognizer.txt"))));
}

TEST(BoxLabels, AReturnInABoxIsTheObjects) {
    const auto label = at({10.8f, 1.9f, 1.0f}, {carAhead()});
    EXPECT_EQ(label.id, 7);
    EXPECT_EQ(label.kind, ObjectKind::Car);
    EXPECT_EQ(at({10.0f, 2.05f, 1.0f}, {carAhead()}).id, 7) << "5 cm out of it";
}

TEST(BoxLabels, NearABoxNobodyKnowsAndFartherItIsStructure) {
    EXPECT_EQ(at({10.0f, 2.4f, 1.0f}, {carAhead()}).id, kUnsure);
    EXPECT_EQ(at({10.0f, 0.0f, 1.9f}, {carAhead()}).id, kUnsure) << "above it";
    EXPECT_TRUE(isStructure(at({10.0f, 2.6f, 1.0f}, {carAhead()})));
    EXPECT_TRUE(isStructure(at({10.0f, 0.0f, 3.0f}, {carAhead()}))) << "a crown over the car";
    EXPECT_TRUE(isStructure(at({10.0f, 2.6f, 1.0f}, {})));
}

TEST(BoxLabels, OfSeveralBoxesTheSmallestCounts) {
    const LabelledBox person{{{9.3, 0.0, 0.9}, {0.6, 0.6, 1.8}, 0.0}, 20, 3, ObjectKind::Pedestrian};
    EXPECT_EQ(at({9.3f, 0.0f, 1.0f}, {carAhead(), person}).id, 3);
    EXPECT_EQ(at({9.3f, 0.0f, 1.0f}, {person, carAhead()}).id, 3);
}

TEST(BoxLabels, NothingIsKnownOutOfTheViewBeyondTheFarthestBoxOrInABoxLeftOpen) {
    EXPECT_EQ(at({0.0f, 10.0f, 1.0f}, {}, {M_PI / 4.0, 50.0}).id, kUnsure);
    EXPECT_EQ(at({60.0f, 0.0f, 1.0f}, {}).id, kUnsure);
    LabelledBox open = carAhead();
    open.kind.reset();
    EXPECT_EQ(at({10.0f, 0.0f, 1.0f}, {open}).id, kUnsure);
}

TEST(BoxLabels, TypesAreKindsClassesOrLeftOpen) {
    EXPECT_EQ(labelledTypeOf("van").kind, ObjectKind::Van);
    EXPECT_EQ(labelledTypeOf("hedge").kind, ObjectKind::Hedge);
    EXPECT_EQ(classOf(*labelledTypeOf("vehicle").kind), ObstacleClass::Vehicle);
    EXPECT_EQ(classOf(*labelledTypeOf("bicycle").kind), ObstacleClass::Cyclist) << "as the evaluation reads it";
    EXPECT_TRUE(labelledTypeOf("dontcare").known);
    EXPECT_FALSE(labelledTypeOf("dontcare").kind);
    EXPECT_FALSE(labelledTypeOf("spaceship").known);
}

/// A group that nobody can name teaches nothing; one with a few such returns does.
TEST(TruthOfGroups, GroupsOfReturnsNobodyKnowsAreLeftOut) {
    DetectionResult found;
    found.hypotheses.resize(2);
    for (std::int32_t i = 0; i < 20; ++i) found.hypotheses[i / 10].points.push_back(i);
    std::vector<simulation::ReturnLabel> labels(20, {7, ObjectKind::Car});
    labels[0].id = labels[1].id = labels[10].id = kUnsure;
    PointCloud cloud;
    cloud.xyz.assign(20, {5.0f, 0.0f, 0.5f});
    const std::vector<Truth> truth = truthOf(found, cloud, labels);
    EXPECT_FALSE(truth[0].known);
    EXPECT_TRUE(truth[1].known);
    EXPECT_EQ(truth[1].thing, 7);
}

/// The side of a car, 4 m long, and one return of something else so far behind it.
Truth truthOfCarAndOneMore(float behind) {
    PointCloud cloud;
    DetectionResult found;
    found.hypotheses.resize(1);
    for (int k = 0; k <= 40; ++k) cloud.xyz.emplace_back(0.1f * static_cast<float>(k), 3.0f, 0.5f);
    cloud.xyz.emplace_back(4.0f + behind, 3.0f, 0.5f);
    for (std::int32_t i = 0; i < 42; ++i) found.hypotheses[0].points.push_back(i);
    std::vector<simulation::ReturnLabel> labels(42, {7, ObjectKind::Car});
    labels.back() = {8, ObjectKind::Hedge};
    return truthOf(found, cloud, labels).front();
}

TEST(TruthOfGroups, AFewReturnsOfTheNextThingMakeAMixtureWhereTheyLieWellOutside) {
    EXPECT_EQ(truthOfCarAndOneMore(0.3f).category, Category::Vehicle);
    EXPECT_EQ(truthOfCarAndOneMore(0.8f).category, Category::Mixture);
    EXPECT_EQ(truthOfCarAndOneMore(0.8f).verdict, Category::Vehicle) << "what is boxed is a car all the same";
}

class TruthFile : public testing::Test {
  protected:
    std::string write(const std::string& name, const std::string& rows) const {
        writeFile(folder_.file(name), rows);
        return folder_.file(name);
    }
    test::TempFolder folder_;
};

TEST_F(TruthFile, IsReadByTheStampsOfItsScansWithThoseThatHoldNoObject) {
    const std::string file = write("a_gt.csv", std::string(kHeader) + "100.0,0,car-1,car,10,0,1,4,2,1.5,0,0,0,30\n" +
                                                   "100.0,0,man,person,5,5,1,1,1,2,0,0,0,12\n" +
                                                   "100.2,2,man,person,5,5,1,1,1,2,0,0,0,12\n");
    write("a_ego.csv", "scan_index,timestamp,x,y,z,roll,pitch,yaw\n0,100.0,0,0,0,0,0,0\n1,100.1,0,0,0,0,0,0\n");
    const RecordingTruth truth = readRecordingTruth(file);
    ASSERT_EQ(truth.scans.size(), 3U);
    EXPECT_EQ(truth.scans.at(100.0).size(), 2U);
    EXPECT_TRUE(truth.scans.at(100.1).empty());
    EXPECT_EQ(truth.scans.at(100.0)[1].id, truth.scans.at(100.2)[0].id) << "one object";
    EXPECT_NEAR(truth.reach, 10.0 + std::hypot(2.0, 1.0), 1e-9);
    EXPECT_EQ(scanAt(truth, 100.03)->first, 100.0);
    EXPECT_EQ(scanAt(truth, 100.07)->first, 100.1);
    EXPECT_TRUE(scanAt(truth, 100.3) == truth.scans.end());
}

TEST_F(TruthFile, OfAnUnknownTypeNamesTheLine) {
    const std::string file = write("b_gt.csv", std::string(kHeader) + "100.0,0,1,car,10,0,1,4,2,1.5,0,0,0,30\n" +
                                                   "100.0,0,2,spaceship,10,5,1,4,2,1.5,0,0,0,30\n");
    try {
        readRecordingTruth(file);
        FAIL();
    } catch (const evaluation::CsvError& e) {
        EXPECT_THAT(e.what(),
                    AllOf(HasSubstr("b_gt.csv:3: type: 'spaceship'"), HasSubstr("car, van"), HasSubstr("ignore")));
    }
}

/// Two seconds of the shipped street, every second turn of the sensor.
class Train : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<test::TempFolder>();
        simulated_ =
            shell("'" OBSTACLE_SIMULATE "' '" SCENARIOS "street.yaml' --from 20 --to 22 --stride 2 --output '" +
                  file("site") + "' >/dev/null 2>&1");
    }
    static void TearDownTestSuite() { folder_.reset(); }
    void SetUp() override { ASSERT_EQ(simulated_, 0); }

    static std::string file(const std::string& name) { return folder_->file(name); }
    /// The smallest training there is, with these options; its exit code. What it says is in file("err").
    static int train(const std::string& options) {
        const std::string scenes = std::to_string(leastScenes());
        return shell("'" OBSTACLE_TRAIN "' --scenes " + scenes + " --rounds 2 --depth 3 --output '" +
                     file("model.txt") + "' " + options + " >/dev/null 2>'" + file("err") + "'");
    }
    static std::string quoted(const std::string& name) { return "'" + file(name) + "'"; }

    static inline std::unique_ptr<test::TempFolder> folder_;
    static inline int simulated_ = -1;
};

/// The simulator knows what every return hit: the rule of the boxes is held against it.
TEST_F(Train, TheRuleOfBoxesAgreesWithWhatTheReturnsHit) {
    const RecordingTruth truth = readRecordingTruth(file("site_gt.csv"));
    simulation::LabelsReader labels(file("site_labels.bin"));
    const auto source = openScanSource(file("site.rawlog"));
    std::map<bool, std::array<int, 2>> agree;  // returns of road users; of others: {right, wrong}, unsure left out
    SensorParams all;
    all.min_range = 0.0;
    all.max_range = 300.0;
    for (int scans = 0; scans < 3;) {
        const auto item = source->next();
        ASSERT_TRUE(item);
        if (!item->observation || !isLidarScan(*item->observation)) continue;
        ++scans;
        const auto cloud = toPointCloud(*item->observation, all);
        const auto hit = labels.next();
        ASSERT_TRUE(cloud && hit);
        ASSERT_EQ(cloud->size(), hit->returns.size());
        const auto scan = scanAt(truth, cloud->timestamp);
        ASSERT_TRUE(scan != truth.scans.end());
        const auto told = labelsByBoxes(*cloud, scan->second, {M_PI, truth.reach});
        for (std::size_t i = 0; i < told.size(); ++i) {
            const auto& [id, kind] = hit->returns[i];
            if (told[i].id == kUnsure || kind == ObjectKind::Ground) continue;
            const bool is_object = id > 0;
            ++agree[is_object][is_object ? told[i].kind != kind : told[i].id != 0];
        }
    }
    ASSERT_GT(agree[true][0], 1000);
    ASSERT_GT(agree[false][0], 10000);
    EXPECT_LT(agree[true][1], 0.01 * agree[true][0]);
    EXPECT_LT(agree[false][1], 0.01 * agree[false][0]);
}

TEST(HoldOut, HasEveryKindOfSceneAndLeavesEveryKindToLearnFrom) {
    const std::size_t kinds = simulation::randomScenes().size();
    for (const std::size_t scenes :
         {2 * kinds, 2 * kinds + 3, 3 * kinds, 5 * kinds - 1, std::size_t{75}, std::size_t{1000}}) {
        std::set<std::size_t> kept_back, learned;
        std::size_t count = 0;
        for (std::size_t k = 0; k < scenes; ++k) {
            count += isKeptBack(k, scenes);
            (isKeptBack(k, scenes) ? kept_back : learned).insert(k % kinds);
        }
        EXPECT_EQ(kept_back.size(), kinds) << scenes;
        EXPECT_EQ(learned.size(), kinds) << scenes;
        EXPECT_LE(2 * count, scenes) << scenes;
        if (scenes >= 5 * kinds) {
            EXPECT_LE(5 * count, scenes) << "every fifth set at most, of " << scenes;
        }
    }
}

TEST_F(Train, RefusesFewerScenesThanCanBeKeptBack) {
    const std::string one_less = std::to_string(leastScenes() - 1);
    EXPECT_EQ(shell("'" OBSTACLE_TRAIN "' --scenes " + one_less + " >/dev/null 2>'" + file("err") + "'"), 2);
    EXPECT_THAT(readFile(file("err")), AllOf(HasSubstr("--scenes: Value " + one_less + " not in range"),
                                             HasSubstr(std::to_string(leastScenes()))));
}

TEST_F(Train, SaysInTheCardWhatWasAdded) {
    ASSERT_EQ(train("--every 1 --add " + quoted("site.rawlog") + " --truth " + quoted("site_gt.csv")), 0)
        << readFile(file("err"));
    const std::string card = readFile(file("model.txt.md"));
    ASSERT_EQ(shell("cd '" + folder_->file("") + "' && md5sum site.rawlog site_gt.csv | cut -d' ' -f1 >md5"), 0);
    const std::string md5 = readFile(file("md5"));
    EXPECT_THAT(card,
                AllOf(HasSubstr("site.rawlog " + md5.substr(0, 32)), HasSubstr("site_gt.csv " + md5.substr(33, 32)),
                      HasSubstr("| 10 / 10 / 10 |"), HasSubstr("The recordings alone:"),
                      testing::Not(HasSubstr("nothing recorded")), testing::Not(HasSubstr(file("site")))));
    // Two of ten scans were kept back, each by 16, 8 and 4 rings.
    EXPECT_THAT(card, HasSubstr("Groups chosen in 6 scans"));
    EXPECT_THAT(card, testing::ContainsRegex("Of [1-9][0-9]* vehicles of 15 returns or more"));
    EXPECT_THAT(card, HasSubstr(importancesText(readFile(file("model.txt")))));
}

TEST_F(Train, LearnsNothingFromWhatIsLeftOut) {
    ASSERT_EQ(train("--without length,fill --noise 0.02"), 0) << readFile(file("err"));
    EXPECT_THAT(readFile(file("model.txt.md")),
                AllOf(HasSubstr("Without the features `length` `fill`."), HasSubstr("0.02 m in all scenes")));
    const std::string model = readFile(file("model.txt"));
    EXPECT_THAT(model, HasSubstr("feature length -1e30 1e30\n"));
    for (const char* uncalibrated : {"\ngrouping 1 0 0 ", "\nverdict 1 0 0 "})
        EXPECT_THAT(model, testing::Not(HasSubstr(uncalibrated))) << "so few scenes calibrate, too";
    const std::string split = "\n" + std::to_string(static_cast<int>(Feature::Length) + 1) + " ";
    EXPECT_THAT(model, testing::Not(HasSubstr(split)));
    EXPECT_THAT(model, HasSubstr("\n" + std::to_string(static_cast<int>(Feature::Top) + 1) + " ")) << "others are used";
    EXPECT_EQ(train("--without lenght"), 2);
    EXPECT_THAT(readFile(file("err")), HasSubstr("--without: there is no feature 'lenght'"));
}

TEST_F(Train, SaysWhatIsWrongWithARecordingBeforeItSimulatesAnything) {
    EXPECT_EQ(train("--add " + quoted("site.rawlog")), 2);
    EXPECT_THAT(readFile(file("err")), HasSubstr("each --add needs a --truth: there are 1 of --add and 0 of --truth"));

    EXPECT_EQ(train("--add " + quoted("site.rawlog") + " --truth " + quoted("none_gt.csv")), 1);
    EXPECT_THAT(readFile(file("err")), HasSubstr("none_gt.csv"));

    writeFile(file("other_gt.csv"), std::string(kHeader) + "100.0,0,1,car,10,0,1,4,2,1.5,0,0,0,30\n");
    EXPECT_EQ(train("--add " + quoted("site.rawlog") + " --truth " + quoted("other_gt.csv")), 1);
    EXPECT_THAT(readFile(file("err")),
                AllOf(HasSubstr("other_gt.csv: truth of other stamps: its scans are from 100.000 to 100.000 s"),
                      HasSubstr("site.rawlog from ")));

    EXPECT_EQ(train("--every 5 --add " + quoted("site.rawlog") + " --truth " + quoted("site_gt.csv")), 1);
    EXPECT_THAT(readFile(file("err")), HasSubstr("2 scans to use (labelled: 10, every: 5); 5 or more are needed"));
    EXPECT_THAT(readFile(file("err")), testing::Not(HasSubstr("scene 0")));
}

}  // namespace
}  // namespace lidar_obstacles::apps
