// SPDX-License-Identifier: BSD-3-Clause
// Annotated rawlogs and exports: what obstacle-replay writes is read back with MRPT, with its rawlog-edit, and by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation3DScene.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CText.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "lidar_obstacles/mrpt_bridge/rawlog_writer.h"
#include "lidar_obstacles/mrpt_bridge/results.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "lidar_obstacles/types.h"
#include "support/rawlog_files.h"
#include "support/shell.h"
#include "support/temp_folder.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using mrpt::obs::CObservation3DScene;
using mrpt::obs::CObservationComment;
using testing::HasSubstr;

constexpr const char* kStreet = DATASETS "street_sample.rawlog";
constexpr std::size_t kScans = 8;

struct Row {
    std::size_t scan;
    std::vector<std::string> fields;
    double at(int column) const { return std::stod(fields[static_cast<std::size_t>(column)]); }
};

class Annotate : public testing::Test {
  protected:
    int replay(const std::string& arguments, const std::string& before = "") const {
        const std::string command = before + " '" OBSTACLE_REPLAY "' " + arguments + " --output '" + file("out") +
                                    "' >'" + file("stdout") + "' 2>'" + file("stderr") + "'";
        return test::shell(command);
    }
    std::string file(const std::string& name) const { return folder_.file(name); }
    std::string quoted(const std::string& name) const { return "'" + file(name) + "'"; }
    std::string err() const { return readFile(file("stderr")); }

    std::vector<Row> csv() const {
        std::istringstream in(readFile(file("out/obstacles.csv")));
        std::string line;
        std::getline(in, line);
        std::vector<Row> rows;
        while (std::getline(in, line)) {
            std::istringstream words(line);
            std::vector<std::string> fields;
            for (std::string field; std::getline(words, field, ',');) fields.push_back(field);
            rows.push_back({std::stoul(fields[1]), fields});
        }
        return rows;
    }
    std::vector<Row> csv(std::size_t scan) const {
        std::vector<Row> rows;
        for (const Row& row : csv())
            if (row.scan == scan) rows.push_back(row);
        return rows;
    }

    TempFolder folder_;
};

std::vector<SourceItem> itemsOf(const std::string& file) {
    const auto source = openScanSource(file);
    std::vector<SourceItem> items;
    while (const auto item = source->next()) items.push_back(*item);
    EXPECT_EQ(source->status(), SourceStatus::End) << source->message();
    return items;
}

std::string bytesOf(const mrpt::serialization::CSerializable& object) {
    mrpt::io::CMemoryStream stream;
    mrpt::serialization::archiveFrom(stream).WriteObject(&object);
    return {static_cast<const char*>(stream.getRawBufferData()), stream.getTotalBytesCount()};
}

TEST_F(Annotate, TheOriginalComesBackByteForByteWithASceneBehindEachScan) {
    ASSERT_EQ(replay(std::string(kStreet) + " --set tracking.enabled=false --annotate " + quoted("a.rawlog")), 0)
        << err();
    const auto original = itemsOf(kStreet), copy = itemsOf(file("a.rawlog"));
    ASSERT_EQ(copy.size(), original.size() + 1 + 2 * kScans);
    EXPECT_TRUE(std::dynamic_pointer_cast<CObservationComment>(copy[0].observation));
    std::size_t k = 1, scenes = 0;
    for (const SourceItem& item : original) {
        ASSERT_EQ(bytesOf(*copy[k].observation), bytesOf(*item.observation)) << k;
        const bool is_scan = item.observation->sensorLabel == "velodyne";
        ++k;
        if (!is_scan) continue;
        const auto scene = std::dynamic_pointer_cast<CObservation3DScene>(copy[k++].observation);
        ASSERT_TRUE(scene);
        EXPECT_EQ(scene->timestamp, item.observation->timestamp);
        const auto label = std::dynamic_pointer_cast<mrpt::opengl::CText>(scene->scene->getByName("sensor_label"));
        ASSERT_TRUE(label) << "MRPT saves no label of a scene but what stands in it";
        EXPECT_EQ(label->getString(), "velodyne_obstacles");
        EXPECT_EQ(copy[k++].observation->sensorLabel, "velodyne_results");
        ++scenes;
    }
    EXPECT_EQ(scenes, kScans);
}

TEST_F(Annotate, AScenesBoxesAndLabelsAreThoseOfTheCsv) {
    ASSERT_EQ(replay(std::string(kStreet) + " --annotate " + quoted("a.rawlog")), 0) << err();
    std::size_t scan = 0;
    for (const SourceItem& item : itemsOf(file("a.rawlog"))) {
        const auto found = std::dynamic_pointer_cast<CObservation3DScene>(item.observation);
        if (!found) continue;
        auto& scene = *found->scene;
        for (const Row& row : csv(scan)) {
            const auto box = std::dynamic_pointer_cast<mrpt::opengl::CBox>(scene.getByName("box_" + row.fields[2]));
            ASSERT_TRUE(box);
            EXPECT_NEAR(box->getPose().x, row.at(4), 1e-4);
            EXPECT_NEAR(box->getPose().yaw, row.at(10), 1e-5);
            const auto label =
                std::dynamic_pointer_cast<mrpt::opengl::CText>(scene.getByName("label_" + row.fields[2]));
            ASSERT_TRUE(label);
            const bool followed = std::stoi(row.fields[2]) < kFirstUntrackedId;
            const std::string number = followed ? " " + row.fields[2] : "";
            EXPECT_THAT(label->getString(), testing::StartsWith(row.fields[3] + number + ", "));
        }
        EXPECT_TRUE(scene.getByName("clustered"));
        EXPECT_TRUE(scene.getByName("ground"));
        EXPECT_FALSE(scene.getByName("grid")) << "it would cover the points in the viewers";
        ++scan;
    }
    EXPECT_EQ(scan, kScans);
}

TEST_F(Annotate, AProgramReadsTheResultsOfTheCsvBack) {
    ASSERT_EQ(replay(std::string(kStreet) + " --annotate " + quoted("a.rawlog")), 0) << err();
    std::size_t scan = 0;
    for (const SourceItem& item : itemsOf(file("a.rawlog"))) {
        const auto found = readResults(*item.observation);
        if (!found) continue;
        const auto rows = csv(scan++);
        ASSERT_EQ(found->obstacles.size(), rows.size());
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const Obstacle& o = found->obstacles[k];
            EXPECT_NEAR(found->timestamp, rows[k].at(0), 1e-6);
            EXPECT_EQ(o.id, static_cast<int>(rows[k].at(2)));
            EXPECT_EQ(toString(o.cls), rows[k].fields[3]);
            EXPECT_NEAR(o.box.center.x(), rows[k].at(4), 1e-4);
            EXPECT_NEAR(o.box.yaw, rows[k].at(10), 1e-5);
            EXPECT_EQ(o.track.has_value(), !rows[k].fields.at(22).empty()) << "age";
        }
    }
    EXPECT_EQ(scan, kScans);
}

TEST_F(Annotate, TheCommentHoldsTheRunsParametersAsAConfigFile) {
    ASSERT_EQ(replay(std::string(kStreet) + " --set grid.resolution=0.15 --annotate " + quoted("a.rawlog")), 0)
        << err();
    const auto comment = std::dynamic_pointer_cast<CObservationComment>(itemsOf(file("a.rawlog"))[0].observation);
    ASSERT_TRUE(comment);
    EXPECT_EQ(parseParams(comment->text, "comment").grid.resolution, 0.15);
    EXPECT_THAT(comment->text, HasSubstr("street_sample.rawlog"));
}

TEST_F(Annotate, MrptLoadsItWhole) {
    ASSERT_EQ(replay(std::string(kStreet) + " --annotate " + quoted("a.rawlog")), 0) << err();
    mrpt::obs::CRawlog rawlog;
    ASSERT_TRUE(rawlog.loadFromRawLogFile(file("a.rawlog")));
    EXPECT_EQ(rawlog.size(), itemsOf(kStreet).size() + 2 * kScans) << "the comment is not an entry";
    EXPECT_THAT(rawlog.getCommentText(), HasSubstr("[grid]"));
}

TEST_F(Annotate, ACommentOfTheRecordingIsKept) {
    auto comment = std::make_shared<CObservationComment>();
    comment->text = "Monza, third lap";
    writeRawlog(file("in.rawlog"), {comment, scanLabelled("lidar")}, false);
    ASSERT_EQ(replay(quoted("in.rawlog") + " --annotate " + quoted("a.rawlog")), 0) << err();
    const auto items = itemsOf(file("a.rawlog"));
    ASSERT_EQ(items.size(), 4u) << "one comment, the scan, the scene, the results";
    const auto merged = std::dynamic_pointer_cast<CObservationComment>(items[0].observation);
    ASSERT_TRUE(merged);
    EXPECT_THAT(merged->text, HasSubstr("Monza, third lap"));
    EXPECT_THAT(merged->text, HasSubstr("[grid]"));
}

TEST_F(Annotate, SensoryFramesStayFrames) {
    Objects objects;
    for (int k = 0; k < 3; ++k) {
        auto frame = std::make_shared<mrpt::obs::CSensoryFrame>();
        frame->insert(scanLabelled("lidar", 1e6 + k));
        objects.push_back(std::make_shared<mrpt::obs::CActionCollection>());
        objects.push_back(frame);
    }
    writeRawlog(file("in.rawlog"), objects, true);
    ASSERT_EQ(replay(quoted("in.rawlog") + " --annotate " + quoted("a.rawlog")), 0) << err();
    mrpt::obs::CRawlog rawlog;
    ASSERT_TRUE(rawlog.loadFromRawLogFile(file("a.rawlog")));
    ASSERT_EQ(rawlog.size(), 6u);
    for (std::size_t k = 0; k < 6; k += 2) {
        EXPECT_EQ(rawlog.getType(k), mrpt::obs::CRawlog::etActionCollection);
        ASSERT_EQ(rawlog.getType(k + 1), mrpt::obs::CRawlog::etSensoryFrame);
        const auto frame = rawlog.getAsObservations(k + 1);
        ASSERT_EQ(frame->size(), 3u);
        EXPECT_TRUE(std::dynamic_pointer_cast<CObservation3DScene>(frame->getObservationByIndex(1)));
    }
}

TEST_F(Annotate, AFullDiskIsAnErrorThatNamesTheFile) {
    EXPECT_EQ(replay(std::string(kStreet) + " --annotate " + quoted("a.rawlog"), "ulimit -f 400; trap '' XFSZ;"), 1);
    EXPECT_THAT(err(), HasSubstr(file("a.rawlog") + ": cannot write: File too large"));
    EXPECT_FALSE(std::filesystem::exists(file("a.rawlog")));
    EXPECT_FALSE(std::filesystem::exists(file("a.rawlog.part")));
}

TEST_F(Annotate, TheInputIsNotOverwritten) {
    std::filesystem::copy_file(kStreet, file("in.rawlog"));
    EXPECT_EQ(replay(quoted("in.rawlog") + " --annotate " + quoted("in.rawlog")), 2);
    EXPECT_THAT(err(), HasSubstr("is the input"));
    EXPECT_EQ(readFile(file("in.rawlog")), readFile(kStreet));
    EXPECT_EQ(replay(std::string(kStreet) + " --annotate /nonexistent/a.rawlog"), 1);
    EXPECT_THAT(err(), HasSubstr("/nonexistent/a.rawlog"));
}

TEST_F(Annotate, RawlogEditListsIt) {
    LIDAR_OBSTACLES_NEED(rawlog_edit, programNamed("rawlog-edit"));
    ASSERT_EQ(replay(std::string(kStreet) + " --annotate " + quoted("a.rawlog")), 0) << err();
    const auto listing = [&](const std::string& operation) {
        const std::string command = "'" + rawlog_edit + "' " + operation + " -i " + quoted("a.rawlog") +
                                    " --text-file-output " + quoted("list.txt") + " -w >" + quoted("listing") + " 2>&1";
        EXPECT_EQ(std::system(command.c_str()), 0) << readFile(file("listing"));
        return readFile(file("listing"));
    };
    const std::string info = listing("--info");
    const std::size_t entries = itemsOf(kStreet).size() + 1 + 2 * kScans;
    EXPECT_THAT(info, HasSubstr("Overall number of objects         : " + std::to_string(entries)));
    EXPECT_THAT(info, HasSubstr("Observations format               : Yes"));
    EXPECT_THAT(info, testing::ContainsRegex("velodyne / +8 /"));
    EXPECT_THAT(info, testing::ContainsRegex("velodyne_results / +8 /"));
    const std::string described = listing("--describe");
    std::size_t scenes = 0;
    for (auto at = described.find("ClassName: mrpt::obs::CObservation3DScene"); at != std::string::npos;
         at = described.find("ClassName: mrpt::obs::CObservation3DScene", at + 1))
        ++scenes;
    EXPECT_EQ(scenes, kScans);
}

TEST_F(Annotate, JsonLinesHoldTheSameAsTheCsv) {
    ASSERT_EQ(replay(std::string(kStreet) + " --format csv,jsonl"), 0) << err();
    std::istringstream in(readFile(file("out/obstacles.jsonl")));
    std::size_t scan = 0;
    for (std::string line; std::getline(in, line); ++scan) {
        const auto json = nlohmann::json::parse(line);
        EXPECT_EQ(json["scan_index"], scan);
        const auto rows = csv(scan);
        ASSERT_EQ(json["obstacles"].size(), rows.size());
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const auto& o = json["obstacles"][k];
            EXPECT_EQ(o["class"], rows[k].fields[3]);
            EXPECT_NEAR(json["timestamp"].get<double>(), rows[k].at(0), 1e-6);
            EXPECT_NEAR(o["x"].get<double>(), rows[k].at(4), 1e-9);
            EXPECT_NEAR(o["yaw"].get<double>(), rows[k].at(10), 1e-9);
            EXPECT_EQ(o["num_points"], static_cast<int>(rows[k].at(12)));
        }
    }
    EXPECT_EQ(scan, kScans);
}

TEST_F(Annotate, KittiLabelsGiveTheSameBoxesBack) {
    ASSERT_EQ(replay(std::string(kStreet) + " --format csv,kitti"), 0) << err();
    const std::map<std::string, std::string> types{{"vehicle", "Car"},
                                                   {"pedestrian", "Pedestrian"},
                                                   {"cyclist", "Cyclist"},
                                                   {"structure", "Misc"},
                                                   {"unknown", "Misc"}};
    for (std::size_t scan = 0; scan < kScans; ++scan) {
        std::istringstream in(readFile(file("out/kitti/00000" + std::to_string(scan) + ".txt")));
        const auto rows = csv(scan);
        std::size_t k = 0;
        for (std::string line; std::getline(in, line); ++k) {
            ASSERT_LT(k, rows.size());
            std::istringstream words(line);
            std::string type;
            double truncated, occluded, alpha, left, top, right, bottom, h, w, l, x, y, z, ry, score;
            ASSERT_TRUE(words >> type >> truncated >> occluded >> alpha >> left >> top >> right >> bottom >> h >> w >>
                        l >> x >> y >> z >> ry >> score);
            EXPECT_EQ(type, types.at(rows[k].fields[3]));
            // KITTI: corner offset (along l, h) = (l/2 cos ry, -l/2 sin ry) in (x right, z forward), y down.
            EXPECT_NEAR(z, rows[k].at(4), 1e-3);
            EXPECT_NEAR(-x, rows[k].at(5), 1e-3);
            EXPECT_NEAR(-y + h / 2, rows[k].at(6), 2e-3);
            EXPECT_NEAR(l, rows[k].at(7), 1e-3);
            EXPECT_NEAR(w, rows[k].at(8), 1e-3);
            const double ahead_forward = -std::sin(ry), ahead_left = -std::cos(ry);
            EXPECT_NEAR(normalizeAngle(std::atan2(ahead_left, ahead_forward) - rows[k].at(10)), 0.0, 2e-4);
            EXPECT_NEAR(score, rows[k].at(21), 1e-9) << "the probability of the class";
        }
        EXPECT_EQ(k, rows.size());
    }
}

TEST_F(Annotate, LabelsInAFolderThatNoRunWroteToStay) {
    std::filesystem::create_directories(file("out/kitti"));
    writeFile(file("out/kitti/000007.txt"), "mine");
    ASSERT_EQ(replay(std::string(kStreet) + " --format csv --to 1"), 0) << err();
    EXPECT_EQ(readFile(file("out/kitti/000007.txt")), "mine");
}

TEST_F(Annotate, WhatWasNotAskedForIsNotLeftFromAnEarlierRun) {
    ASSERT_EQ(replay(std::string(kStreet) + " --format csv,kitti,jsonl"), 0) << err();
    writeFile(file("out/kitti/notes.txt"), "mine");
    ASSERT_EQ(replay(std::string(kStreet) + " --format kitti --to 1"), 0) << err();
    EXPECT_FALSE(std::filesystem::exists(file("out/obstacles.csv")));
    EXPECT_FALSE(std::filesystem::exists(file("out/obstacles.jsonl")));
    EXPECT_TRUE(std::filesystem::exists(file("out/kitti/000001.txt")));
    EXPECT_FALSE(std::filesystem::exists(file("out/kitti/000002.txt")));
    EXPECT_EQ(readFile(file("out/kitti/notes.txt")), "mine");
    EXPECT_EQ(replay(std::string(kStreet) + " --format csv,xml"), 2);
    EXPECT_THAT(err(), HasSubstr("--format xml"));
}

}  // namespace
}  // namespace lidar_obstacles
