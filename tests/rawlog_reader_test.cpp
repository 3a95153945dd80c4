// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/rawlog_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include "support/rawlog_files.h"
#include "support/temp_folder.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::Not;

std::vector<SourceItem> readAll(ScanSource& source) {
    std::vector<SourceItem> items;
    while (auto item = source.next()) items.push_back(*item);
    return items;
}

/// Odometry step, as rawlogs in action/sensory-frame format hold it.
mrpt::obs::CActionCollection::Ptr movement(double dx) {
    mrpt::obs::CActionRobotMovement2D step;
    step.computeFromOdometry(mrpt::poses::CPose2D(dx, 0, 0), {});
    auto actions = std::make_shared<mrpt::obs::CActionCollection>();
    actions->insert(step);
    return actions;
}

mrpt::obs::CSensoryFrame::Ptr frameOf(std::initializer_list<mrpt::obs::CObservation::Ptr> observations) {
    auto frame = std::make_shared<mrpt::obs::CSensoryFrame>();
    for (const auto& observation : observations) frame->insert(observation);
    return frame;
}

class PlainAndGzip : public testing::TestWithParam<bool> {
  protected:
    std::string write(const Objects& objects) const {
        writeRawlog(folder_.file("log"), objects, GetParam());
        return folder_.file("log");
    }
    TempFolder folder_;
};

TEST_P(PlainAndGzip, ObservationsComeInOrderAndTheEndIsClean) {
    RawlogReader reader(write({scanLabelled("a", 1.0), scanLabelled("b", 2.0), scanLabelled("a", 3.0)}));
    const auto items = readAll(reader);
    ASSERT_EQ(items.size(), 3u);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(items[i].object, i);
        EXPECT_EQ(items[i].action, nullptr);
        EXPECT_NEAR(mrpt::Clock::toDouble(items[i].observation->timestamp), static_cast<double>(i) + 1.0, 1e-6);
    }
    EXPECT_EQ(items[1].observation->sensorLabel, "b");
    EXPECT_EQ(reader.status(), SourceStatus::End);
    EXPECT_EQ(reader.objects(), 3u);
    EXPECT_EQ(reader.message(), "");
    EXPECT_EQ(reader.remarks(), "");
    EXPECT_EQ(reader.progress(), 1.0);
    EXPECT_EQ(reader.next(), std::nullopt) << "the end stays the end";
}

TEST_P(PlainAndGzip, FramesGiveTheirObservationsAndActionsStayBetween) {
    RawlogReader reader(write({movement(0.5), frameOf({scanLabelled("a"), scanLabelled("b")}), movement(0.7),
                               frameOf({}), frameOf({scanLabelled("a")})}));
    const auto items = readAll(reader);
    ASSERT_EQ(items.size(), 5u);
    const std::size_t objects[] = {0, 1, 1, 2, 4};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(items[i].object, objects[i]);
        EXPECT_NE(items[i].action == nullptr, items[i].observation == nullptr) << "exactly one is set";
    }
    const auto step = items[3].action->getActionByClass<mrpt::obs::CActionRobotMovement2D>();
    EXPECT_NEAR(step->rawOdometryIncrementReading.x(), 0.7, 1e-9);
    EXPECT_EQ(reader.status(), SourceStatus::End);
    EXPECT_EQ(reader.objects(), 5u);
}

TEST_P(PlainAndGzip, OtherObjectsArePassedOverAndCounted) {
    auto pose = std::make_shared<mrpt::poses::CPose3DPDFGaussian>();
    RawlogReader reader(write({pose, scanLabelled("a")}));
    EXPECT_EQ(readAll(reader).size(), 1u);
    EXPECT_EQ(reader.status(), SourceStatus::End);
    EXPECT_THAT(reader.remarks(), HasSubstr("1 object"));
}

TEST_P(PlainAndGzip, ACutInsideAnObjectIsDamageThatNamesFileAndObject) {
    const std::string path = write({scanLabelled("a"), scanLabelled("a"), scanLabelled("a")});
    const std::string whole = readFile(path);
    writeFile(path, whole.substr(0, whole.size() - whole.size() / 6));
    RawlogReader reader(path);
    EXPECT_EQ(readAll(reader).size(), 2u) << "what stands before the cut is delivered";
    EXPECT_EQ(reader.status(), SourceStatus::Damaged);
    EXPECT_THAT(reader.message(), HasSubstr(path));
    EXPECT_THAT(reader.message(), HasSubstr("object 2"));
    EXPECT_THAT(reader.message(), Not(HasSubstr("\n"))) << "one line, no call stack";
    EXPECT_LT(reader.message().size(), path.size() + 200);
    EXPECT_EQ(reader.next(), std::nullopt);
}

TEST_P(PlainAndGzip, ProgressRisesWithTheFile) {
    RawlogReader reader(write(Objects(20, scanLabelled("a"))));
    double last = 0.0;
    while (reader.next()) {
        EXPECT_GE(reader.progress(), last);
        last = reader.progress();
        EXPECT_LE(last, 1.0);
    }
    EXPECT_EQ(reader.progress(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Rawlog, PlainAndGzip, testing::Bool(),
                         [](const auto& test) { return test.param ? "Gzip" : "Plain"; });

class RawlogFile : public testing::Test {
  protected:
    TempFolder folder_;
    std::string path_ = folder_.file("log");
};

TEST_F(RawlogFile, ThatIsEmptyEndsAtObjectZero) {
    writeFile(path_, "");
    RawlogReader reader(path_);
    EXPECT_EQ(reader.next(), std::nullopt);
    EXPECT_EQ(reader.status(), SourceStatus::End);
    EXPECT_EQ(reader.objects(), 0u);
}

TEST_F(RawlogFile, OfGarbageIsDamagedAtObjectZero) {
    for (const std::string& garbage : {std::string("# a text file\nwith two lines\n"), std::string(5000, '\xff')}) {
        writeFile(path_, garbage);
        RawlogReader reader(path_);
        EXPECT_EQ(reader.next(), std::nullopt);
        EXPECT_EQ(reader.status(), SourceStatus::Damaged);
        EXPECT_THAT(reader.message(), HasSubstr("object 0"));
    }
}

TEST_F(RawlogFile, WithAClassMrptDoesNotKnowIsDamagedAndNamesIt) {
    writeRawlog(path_, {scanLabelled("a"), scanLabelled("a")}, false);
    std::string content = readFile(path_);
    const std::string name = "CObservationVelodyneScan";
    content.replace(content.rfind(name), name.size(), "CObservationUnknownThing");
    writeFile(path_, content);
    RawlogReader reader(path_);
    EXPECT_EQ(readAll(reader).size(), 1u);
    EXPECT_EQ(reader.status(), SourceStatus::Damaged);
    EXPECT_THAT(reader.message(), HasSubstr("CObservationUnknownThing"));
}

TEST_F(RawlogFile, WhoseGzipChecksumIsWrongIsDamaged) {
    writeRawlog(path_, {scanLabelled("a")}, true);
    std::string content = readFile(path_);
    content[content.size() - 6] = static_cast<char>(content[content.size() - 6] ^ 1);
    writeFile(path_, content);
    RawlogReader reader(path_);
    readAll(reader);
    EXPECT_EQ(reader.status(), SourceStatus::Damaged);
}

TEST_F(RawlogFile, ThatIsMissingOrAFolderIsAnErrorThatNamesIt) {
    for (const std::string& path : {folder_.file("nothing"), folder_.file(".")}) try {
            RawlogReader reader(path);
            FAIL() << path << " was opened";
        } catch (const std::runtime_error& e) {
            EXPECT_THAT(e.what(), HasSubstr(path));
        }
    EXPECT_THROW(openScanSource(folder_.file("nothing")), std::runtime_error);
    EXPECT_THROW(lidarLabels(folder_.file("nothing")), std::runtime_error);
}

TEST_F(RawlogFile, TellsTheLabelsOfItsLidars) {
    auto comment = std::make_shared<mrpt::obs::CObservationComment>();
    writeRawlog(path_, {scanLabelled("front"), comment, scanLabelled("rear"), scanLabelled("front")}, true);
    EXPECT_EQ(lidarLabels(path_), (std::map<std::string, std::size_t>{{"front", 2}, {"rear", 1}}));
    EXPECT_EQ(lidarLabels(path_, 2), (std::map<std::string, std::size_t>{{"front", 1}}));
}

TEST(RawlogSample, OfDebianHoldsOneScan) {
    LIDAR_OBSTACLES_NEED(path, mrptDataset("test_velodyne_VLP16.rawlog"));
    EXPECT_EQ(lidarLabels(path), (std::map<std::string, std::size_t>{{"Velodyne1_SCAN", 1}}));
}

TEST(RawlogSample, InActionAndFrameFormatIsReadToItsEnd) {
    LIDAR_OBSTACLES_NEED(path, mrptDataset("localization_demo.rawlog"));
    RawlogReader reader(path);
    std::size_t actions = 0, observations = 0;
    while (const auto item = reader.next()) ++(item->action ? actions : observations);
    EXPECT_EQ(reader.status(), SourceStatus::End) << reader.message();
    EXPECT_GT(actions, 10u);
    EXPECT_GT(observations, 10u);
}

TEST(RawlogLabelled, ScansAndPosesAreAllThere) {
    LIDAR_OBSTACLES_NEED(path, labelledData("kitti_0001_16.rawlog"));
    RawlogReader reader(path);
    EXPECT_EQ(readAll(reader).size(), 214u) << "107 scans, 107 ego poses";
    EXPECT_EQ(reader.status(), SourceStatus::End);
    EXPECT_EQ(lidarLabels(path).size(), 1u);
}

}  // namespace
}  // namespace lidar_obstacles
