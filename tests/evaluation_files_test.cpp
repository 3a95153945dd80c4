// SPDX-License-Identifier: BSD-3-Clause
// Reading truth and detections: what is right comes in as it stands, what is not is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lidar_obstacles/evaluation/detections.h"
#include "lidar_obstacles/evaluation/truth.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::evaluation {
namespace {

using testing::HasSubstr;

constexpr const char* kDetectionHeader =
    "timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points\n";
constexpr const char* kTruthHeader =
    "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points,range_nearest,visible_faces,"
    "occluded\n";
constexpr const char* kVanRow = "1560592800.078299,3,16,Van,10,1,1,5,2,2,0.5,2,-1,120,7.5,BL,0.25\n";

class EvaluationFiles : public testing::Test {
  protected:
    std::string write(const std::string& text) const {
        test::writeFile(folder_.file("rows.csv"), text);
        return folder_.file("rows.csv");
    }
    /// What reading says of the text; "" if it is content.
    template <class Read>
    std::string complaint(const std::string& text, Read&& read) const {
        try {
            read(write(text));
            return "";
        } catch (const CsvError& e) {
            return e.what();
        }
    }
    std::string truthComplaint(const std::string& text) const {
        return complaint(text, [](const std::string& f) { readTruth(f, TruthPose::Reference); });
    }
    std::string detectionComplaint(const std::string& text) const { return complaint(text, readDetections); }

  private:
    test::TempFolder folder_;
};

TEST_F(EvaluationFiles, ATruthRowComesInAsItStands) {
    const auto objects = readTruth(write(std::string(kTruthHeader) + kVanRow), TruthPose::Observed);
    ASSERT_EQ(objects.size(), 1U);
    const TruthObject& o = objects[0];
    EXPECT_EQ(o.timestamp, 1560592800.078299);
    EXPECT_EQ(o.scan_index, 3);
    EXPECT_EQ(o.object_id, "16");
    EXPECT_EQ(o.type, "van");
    EXPECT_EQ(o.group, Group::Vehicle);
    EXPECT_EQ(o.box.center, Eigen::Vector3d(10, 1, 1));
    EXPECT_EQ(o.box.size, Eigen::Vector3d(5, 2, 2));
    EXPECT_EQ(o.box.yaw, 0.5);
    EXPECT_EQ(o.num_points, 120);
    EXPECT_EQ(o.occluded, 0.25);
}

TEST_F(EvaluationFiles, EveryPoseIsFoundInItsColumns) {
    const std::string file = write(
        "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points,x_mid,y_mid,z_mid,"
        "yaw_mid,t_obs,x_obs,y_obs,z_obs,yaw_obs,yaw_rate\n"
        "100,0,1,car,10,0,1,4,2,1.5,0.1,5,-2,50,11,1,1.1,0.2,100.05,12,2,1.2,0.3,0.4\n");
    const auto x = [&](TruthPose pose) { return readTruth(file, pose)[0].box; };
    EXPECT_EQ(x(TruthPose::Reference).center.x(), 10.0);
    EXPECT_EQ(x(TruthPose::MidScan).center, Eigen::Vector3d(11, 1, 1.1));
    EXPECT_EQ(x(TruthPose::Observed).center, Eigen::Vector3d(12, 2, 1.2));
    EXPECT_EQ(x(TruthPose::Observed).yaw, 0.3);
    // the plain pose moved by the object's own velocity for 50 ms
    EXPECT_NEAR(x(TruthPose::EgoCorrected).center.x(), 10.25, 1e-7);
    EXPECT_NEAR(x(TruthPose::EgoCorrected).center.y(), -0.1, 1e-7);
    EXPECT_NEAR(x(TruthPose::EgoCorrected).yaw, 0.12, 1e-7);
}

TEST_F(EvaluationFiles, APoseThatIsNotThereIsTheOnlyOne) {
    const std::string file = write(std::string(kTruthHeader) + kVanRow);
    for (const TruthPose pose :
         {TruthPose::Reference, TruthPose::MidScan, TruthPose::Observed, TruthPose::EgoCorrected})
        EXPECT_EQ(readTruth(file, pose)[0].box.center.x(), 10.0);
}

TEST_F(EvaluationFiles, AnObjectWithoutReturnsNeedNotHaveBeenSeenAnywhere) {
    const std::string head =
        "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points,x_obs,y_obs,z_obs,yaw_"
        "obs\n";
    const auto objects = readTruth(write(head + "100,0,1,car,10,0,1,4,2,1.5,0,0,0,0,,,,\n"), TruthPose::Observed);
    EXPECT_TRUE(std::isnan(objects.at(0).box.center.x()));
    EXPECT_THROW(readTruth(write(head + "100,0,1,car,10,0,1,4,2,1.5,0,0,0,7,,,,\n"), TruthPose::Observed), CsvError);
}

TEST_F(EvaluationFiles, ReturnsAreCountedByTheColumnAskedFor) {
    const std::string file = write(
        "timestamp,scan_index,object_id,type,x,y,z,length,width,height,yaw,vx,vy,num_points,num_points_label\n"
        "100,0,1,car,10,0,1,4,2,1.5,0,0,0,50,200\n");
    EXPECT_EQ(readTruth(file, TruthPose::Reference)[0].num_points, 50);
    EXPECT_EQ(readTruth(file, TruthPose::Reference, "num_points_label")[0].num_points, 200);
    EXPECT_EQ(readTruth(file, TruthPose::Reference, "nothing")[0].num_points, 50);
}

TEST_F(EvaluationFiles, ADetectionComesInAsItStandsWithMoreColumnsAndWindowsLineEnds) {
    const auto rows = readDetections(
        write("timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points,heading_std\r\n"
              "100.5,7,42,vehicle,10,1,1,5,2,2,-0.5,1,33,0.01\r\n\r\n"));
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_EQ(rows[0].timestamp, 100.5);
    EXPECT_EQ(rows[0].id, "42");
    EXPECT_EQ(rows[0].group, Group::Vehicle);
    EXPECT_TRUE(rows[0].heading_valid);
    EXPECT_EQ(rows[0].box.yaw, -0.5);
    EXPECT_EQ(rows[0].num_points, 33);
}

TEST_F(EvaluationFiles, WhatIsSaidOfATrackComesInAndAnEmptyCellSaysNothing) {
    const auto rows = readDetections(
        write("timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points,probability,age,"
              "seen,vx,vy,moving,direction_known\n"
              "100,0,1,vehicle,10,1,1,5,2,2,0,1,33,0.9,1.5,0,2,-1,1,0\n"
              "100,0,2,vehicle,20,1,1,5,2,2,0,1,33,,,,,,,\n"));
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].track.probability, 0.9);
    EXPECT_EQ(rows[0].track.age, 1.5);
    EXPECT_EQ(rows[0].track.seen, 0.0);
    EXPECT_EQ(rows[0].track.velocity, Eigen::Vector2d(2.0, -1.0));
    EXPECT_EQ(rows[0].track.moving, 1.0);
    EXPECT_EQ(rows[0].track.direction_known, 0.0);
    EXPECT_TRUE(std::isnan(rows[1].track.probability) && std::isnan(rows[1].track.velocity.x()));
}

TEST_F(EvaluationFiles, AHeaderAloneIsNoDetectionAtAll) {
    EXPECT_TRUE(readDetections(write(kDetectionHeader)).empty());
}

TEST_F(EvaluationFiles, WhatIsWrongIsNamedWithItsPlace) {
    const std::string head = kDetectionHeader;
    const std::string good = "100,0,1,vehicle,10,1,1,5,2,2,0,1,33\n";
    EXPECT_THAT(detectionComplaint(head + good + "100,0,1,vehicle,abc,1,1,5,2,2,0,1,33\n"),
                HasSubstr("rows.csv:3: x: 'abc' is not a number"));
    EXPECT_THAT(detectionComplaint(head + "100,0,1,vehicle,10,1,1,5,2,2,0,1\n"),
                HasSubstr("rows.csv:2: 12 cells, expected 13"));
    EXPECT_THAT(detectionComplaint(head + "100,0.5,1,vehicle,10,1,1,5,2,2,0,1,33\n"),
                HasSubstr("scan_index: '0.5' is not a whole number"));
    EXPECT_THAT(detectionComplaint(head + "100,0,1,vehicle,nan,1,1,5,2,2,0,1,33\n"), HasSubstr("x: 'nan'"));
    EXPECT_THAT(detectionComplaint(head + "100,0,1,vehicle,10,1,1,-5,2,2,0,1,33\n"),
                HasSubstr("length: '-5' is negative"));
    EXPECT_THAT(detectionComplaint(head + "100,0,1,vehicle,10,1,1,5,2,2,0,yes,33\n"),
                HasSubstr("heading_valid: 'yes' is neither 0 nor 1"));
    EXPECT_THAT(
        detectionComplaint("timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points,vx\n"
                           "100,0,1,vehicle,10,1,1,5,2,2,0,1,33,fast\n"),
        HasSubstr("vx: 'fast' is not a number"));
    EXPECT_THAT(detectionComplaint(head + "100,0,1,,10,1,1,5,2,2,0,1,33\n"), HasSubstr("class: empty"));
    EXPECT_THAT(detectionComplaint("timestamp,scan_index\n"), HasSubstr("rows.csv:1: no column 'id'"));
    EXPECT_THAT(detectionComplaint("timestamp,x,x\n"), HasSubstr("column 'x' is named twice"));
    EXPECT_THAT(detectionComplaint(""), HasSubstr("no header"));
    EXPECT_THAT(truthComplaint(head + good), HasSubstr("no column 'object_id'"));
    EXPECT_THAT(truthComplaint(std::string(kTruthHeader) + "1,0,16,van,,1,1,5,2,2,0.5,2,-1,120,7.5,BL,0.25\n"),
                HasSubstr("rows.csv:2: x: ''"));
}

TEST_F(EvaluationFiles, AFileThatIsNotThereIsNamed) {
    try {
        readDetections("/nowhere/obstacles.csv");
        FAIL() << "nothing was said";
    } catch (const std::runtime_error& e) {
        EXPECT_THAT(e.what(), HasSubstr("/nowhere/obstacles.csv: cannot read: No such file"));
    }
}

TEST_F(EvaluationFiles, ClutterAndEgoPosesComeIn) {
    const auto boxes = readStaticBoxes(write("type,x,y,z,length,width,height,yaw\nwall,1,2,3,4,5,6,0.7\n"));
    ASSERT_EQ(boxes.size(), 1U);
    EXPECT_EQ(boxes[0].type, "wall");
    EXPECT_EQ(boxes[0].box.size, Eigen::Vector3d(4, 5, 6));
    const auto ego =
        readEgoPoses(write("scan_index,timestamp,x,y,z,roll,pitch,yaw,speed\n4,100.5,1,2,3,0.1,0.2,0.3,5\n"));
    ASSERT_EQ(ego.size(), 1U);
    EXPECT_EQ(ego[0].scan_index, 4);
    EXPECT_EQ(ego[0].rpy, Eigen::Vector3d(0.1, 0.2, 0.3));
}

TEST(Groups, OfTypesAreThoseOfTheLabels) {
    EXPECT_EQ(groupOf("tram"), Group::Vehicle);
    EXPECT_EQ(groupOf("person_sitting"), Group::Pedestrian);
    EXPECT_EQ(groupOf("rider"), Group::Cyclist);
    EXPECT_EQ(groupOf("animal"), Group::Other);
    EXPECT_EQ(groupOf("unknown"), Group::Other);
    EXPECT_STREQ(toString(Group::Vehicle), "vehicle");
}

}  // namespace
}  // namespace lidar_obstacles::evaluation
