// SPDX-License-Identifier: BSD-3-Clause
// kitti2rawlog from end to end, on recordings of a few points whose answers are known by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRobotPose.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "support/kitti_recording.h"

namespace lidar_obstacles {
namespace {

using namespace test;
namespace fs = std::filesystem;
using evaluation::TruthObject;
using nlohmann::json;
using testing::HasSubstr;

TEST_F(Kitti2Rawlog, ASecondInputLeavesNoPosesOfTheFirst) {
    writePoints("in/velodyne/000000.bin", turn(63, 0, 90));
    write("out_ego.csv", "scan_index,timestamp,x,y,z,roll,pitch,yaw\n");  // of a recording with poses
    ASSERT_EQ(run("--layout object").code, 0);
    EXPECT_FALSE(fs::exists(path("out_ego.csv")));
    EXPECT_TRUE(fs::exists(path("out.rawlog")));
    EXPECT_TRUE(fs::exists(path("out_gt.csv")));
}

TEST_F(Kitti2Rawlog, HelpHasNoControlBytes) {
    ASSERT_EQ(run("--help").code, 0);
    const std::string text = readFile(path("stdout"));
    EXPECT_THAT(text, HasSubstr("{velodyne,pointcloud}"));
    for (const char c : text) ASSERT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20);
    EXPECT_THAT(run("--scan-clas pointcloud").err, HasSubstr("did you mean --scan-class?"));
}

TEST_F(Kitti2Rawlog, AFullTurnKeepsItsPlanesAndPlaces) {
    writePoints("in/velodyne/000000.bin", turn(63, 0, 90));
    ASSERT_EQ(run("--layout object").code, 0);
    const PointCloud cloud = contents().clouds.at(0);
    ASSERT_EQ(cloud.size(), 64U * 90U);
    for (std::size_t k = 0; k < cloud.size(); ++k) {
        EXPECT_NEAR(cloud.intensity[k], cloud.ring[k] / 100.0, 0.5 / 255.0 + 1e-6);
    }
    EXPECT_NEAR(cloud.sensor_origin.z(), kHeight, 1e-6);
    EXPECT_NEAR((cloud.xyz[0] - cloud.sensor_origin).norm(), 10.0, 1e-5);
    EXPECT_TRUE(truth().empty());
    EXPECT_FALSE(fs::exists(path("out_ego.csv")));
}

TEST_F(Kitti2Rawlog, PlanesAreCountedFromTheGroundWhereTheSkyGivesNoReturns) {
    writePoints("in/velodyne/000000.bin", turn(57, 0, 90));
    ASSERT_EQ(run("").code, 0);
    const PointCloud cloud = contents().clouds.at(0);
    EXPECT_EQ(*std::max_element(cloud.ring.begin(), cloud.ring.end()), 57);
    EXPECT_EQ(cloud.ring.back(), 0);
}

TEST_F(Kitti2Rawlog, PlanesAreCountedFromTheTopWhereTheCloudIsCutToTheCamerasView) {
    Points cut;
    for (int plane = 63; plane >= 20; --plane) {  // the lower ones end below the picture
        for (const auto& [from, to] : {std::pair(0.0, 40.0), std::pair(320.0, 360.0)}) {
            const Points part = turn(plane, plane, 20, from, to);
            cut.insert(cut.end(), part.begin(), part.end());
        }
    }
    writePoints("in/velodyne/000000.bin", cut);
    ASSERT_EQ(run("").code, 0);
    const PointCloud cloud = contents().clouds.at(0);
    EXPECT_EQ(cloud.ring.front(), 63);
    EXPECT_EQ(cloud.ring.back(), 20);
}

TEST_F(Kitti2Rawlog, JitterOfTheAzimuthIsNoNewPlane) {
    Points jitter = turn(63, 0, 90);
    for (std::size_t k = 1; k + 1 < jitter.size(); k += 5) {
        if (k % 90 != 89) std::swap(jitter[k], jitter[k + 1]);  // 4 degrees back and forth
    }
    writePoints("in/velodyne/000000.bin", jitter);
    ASSERT_EQ(run("").code, 0);
    const PointCloud cloud = contents().clouds.at(0);
    std::size_t wrong = 0;
    for (std::size_t k = 0; k < cloud.size(); ++k) wrong += std::abs(cloud.intensity[k] * 100.0 - cloud.ring[k]) > 0.5;
    EXPECT_EQ(wrong, 0U);
}

TEST_F(Kitti2Rawlog, DecimationKeepsThePlanesThatTheDetectorWouldKeep) {
    writePoints("in/velodyne/000000.bin", turn(63, 0, 36));
    SensorParams decimating;
    decimating.planes = 16;
    ASSERT_EQ(run("").code, 0);
    const PointCloud by_detector = contents(decimating).clouds.at(0);
    ASSERT_EQ(run("--planes 16").code, 0);
    const PointCloud by_converter = contents().clouds.at(0);
    EXPECT_EQ(by_converter.ring, by_detector.ring);
    EXPECT_EQ(by_converter.xyz, by_detector.xyz);
    EXPECT_NEAR(by_converter.intensity.front() * 100.0, 61.0, 0.5);
}

TEST_F(Kitti2Rawlog, LabelsOfTheCameraComeIntoTheVehicleFrame) {
    Points points = turn(63, 0, 36);
    points.insert(points.begin(), {{20.27F, 2.0F, -1.0F, 0.5F}, {20.27F, 2.0F, -1.75F, 0.5F}});
    writePoints("in/velodyne/000007.bin", points);
    write("in/calib/000007.txt", calibration());
    write("in/label_2/000007.txt",
          "Car 0.10 1 -1.5 0 0 10 10 1.5 1.6 4.0 -2.0 1.73 20.0 -1.570796\n"
          "DontCare -1 -1 -10 0 0 10 10 -1 -1 -1 -1000 -1000 -1000 -10\n"
          "Person_sitting 0 0 0 0 0 10 10 1.2 0.6 0.8 3.0 1.6 8.0 0.0\n");
    ASSERT_EQ(run("").code, 0);
    const auto objects = truth();
    ASSERT_EQ(objects.size(), 2U);
    const TruthObject& car = objects[0];
    // camera (-2, 1.73 - 0.75, 20) less (0, -0.08, -0.27): 20.27 ahead, 2 to the left, 1.06 below the sensor
    EXPECT_NEAR(car.box.center.x(), 20.27, 1e-4);
    EXPECT_NEAR(car.box.center.y(), 2.0, 1e-4);
    EXPECT_NEAR(car.box.center.z(), kHeight - 1.06, 1e-4);
    EXPECT_EQ(car.box.size, Eigen::Vector3d(4.0, 1.6, 1.5));
    EXPECT_NEAR(car.box.yaw, 0.0, 1e-5) << "rotation_y = -90 degrees looks straight ahead";
    EXPECT_EQ(car.type, "car");
    EXPECT_EQ(car.object_id, "000007_0");
    EXPECT_EQ(car.occluded, 1.0);
    EXPECT_EQ(car.num_points, 1) << "the second lies within 0.1 m of the bottom: ground";
    EXPECT_EQ(objects[1].type, "person_sitting");
    EXPECT_NEAR(objects[1].box.yaw, -M_PI / 2, 1e-5) << "rotation_y = 0 looks to the right";
    EXPECT_EQ(objects[1].group, evaluation::Group::Pedestrian);
}

TEST_F(Kitti2Rawlog, RectificationIsUndone) {
    writePoints("in/velodyne/000000.bin", turn(63, 0, 36));
    std::string turned = calibration();  // the rectified camera is turned by 90 degrees: its x is the camera's -z
    turned.replace(turned.find("R0_rect: 1 0 0 0 1 0 0 0 1"), 26, "R0_rect: 0 0 -1 0 1 0 1 0 0");
    write("in/calib/000000.txt", turned);
    write("in/label_2/000000.txt", "Car 0 0 0 0 0 10 10 1.5 1.6 4.0 -20.0 1.73 -2.0 0.0\n");
    ASSERT_EQ(run("").code, 0);
    const TruthObject car = truth().at(0);
    EXPECT_NEAR(car.box.center.x(), 20.27, 1e-4);
    EXPECT_NEAR(car.box.center.y(), 2.0, 1e-4);
    EXPECT_NEAR(std::abs(car.box.yaw), M_PI, 1e-5);
}

TEST_F(Kitti2Rawlog, TrackingHasTracksAndPoses) {
    for (const char* scan : {"000000", "000001", "000003"})  // one is missing, as in some sequences
        writePoints(std::string("in/velodyne/0004/") + scan + ".bin", turn(63, 0, 36));
    std::string tracking = calibration();
    for (const auto& [old, now] : {std::pair("R0_rect:", "R_rect"), std::pair("Tr_velo_to_cam:", "Tr_velo_cam"),
                                   std::pair("Tr_imu_to_velo:", "Tr_imu_velo")})
        tracking.replace(tracking.find(old), std::strlen(old), now);
    write("in/calib/0004.txt", tracking);
    write("in/label_02/0004.txt",
          "0 -1 DontCare -1 -1 -10 0 0 10 10 -1 -1 -1 -1000 -1000 -1000 -10\n"
          "1 12 Van 0 0 0 0 0 10 10 2.0 1.8 5.0 0 1.73 10 -1.570796\n"
          "3 12 Van 0 2 0 0 0 10 10 2.0 1.8 5.0 0 1.73 14 -1.570796\n");
    std::string oxts;  // 0.0001 degrees north a step is 11.13 m; looking north
    for (int k = 0; k < 4; ++k) oxts += std::to_string(49.0 + 0.0001 * k) + " 8.4 112.5 0 0 1.5707963 0 0 0\n";
    write("in/oxts/0004.txt", oxts);
    ASSERT_EQ(run("--sequence 0004 --start-time 1000").code, 0);
    const auto objects = truth();
    ASSERT_EQ(objects.size(), 2U);
    EXPECT_EQ(objects[0].object_id, "12");
    EXPECT_EQ(objects[0].scan_index, 1);
    EXPECT_EQ(objects[1].scan_index, 2);
    EXPECT_NEAR(objects[1].timestamp, 1000.3, 1e-6);
    EXPECT_NEAR(objects[1].box.center.x(), 14.27, 1e-4);
    const auto ego = evaluation::readEgoPoses(path("out_ego.csv"));
    ASSERT_EQ(ego.size(), 3U);
    EXPECT_NEAR(ego[0].position.norm(), 0.0, 1e-3);
    EXPECT_NEAR(ego[2].position.y(), 3 * 11.1319, 2e-3);
    EXPECT_NEAR(ego[2].position.x(), 0.0, 1e-3);
    EXPECT_NEAR(ego[2].rpy.z(), M_PI / 2, 1e-5);
    const Contents c = contents();
    ASSERT_EQ(c.poses.size(), 3U);
    EXPECT_EQ(c.poses[2]->sensorLabel, "ego_rtk");
    EXPECT_NEAR(c.poses[2]->pose.mean.y(), ego[2].position.y(), 1e-3);
    EXPECT_NEAR(c.clouds[2].timestamp, 1000.3, 1e-6);
}

TEST_F(Kitti2Rawlog, RawHasTimesTrackletsAndPoses) {
    const std::string drive = "in/2011_09_26/drive_0001_sync/";
    for (const char* scan : {"0000000000", "0000000001"}) {
        writePoints(drive + "velodyne_points/data/" + scan + ".bin", turn(63, 0, 36));
        write(drive + "oxts/data/" + scan + ".txt",
              scan[9] == '0' ? "49 8.4 112 0 0 0 0 0\n" : "49 8.4 113 0 0 0 0 0\n");
    }
    write(drive + "velodyne_points/timestamps.txt", "2011-09-26 13:02:25.964389445\n2011-09-26 13:02:26.067000000\n");
    write("in/2011_09_26/calib_imu_to_velo.txt",
          "calib_time: 25-May-2012 16:47:16\nR: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n");
    write(drive + "tracklet_labels.xml",
          "<?xml version=\"1.0\" encoding=\"UTF-8\" standalone=\"yes\" ?>\n<boost_serialization><tracklets>"
          "<count>1</count><item_version>1</item_version><item><objectType>Cyclist</objectType><h>1.7</h><w>0.6</w>"
          "<l>1.8</l><first_frame>1</first_frame><poses><count>1</count><item_version>2</item_version><item>"
          "<tx>10</tx><ty>-2</ty><tz>-1.7</tz><rx>0</rx><ry>0</ry><rz>0.5</rz><state>2</state><occlusion>1</occlusion>"
          "</item></poses></item></tracklets></boost_serialization>\n");
    const Outcome r = run("", "in/2011_09_26/drive_0001_sync/");
    ASSERT_EQ(r.code, 0) << r.err;
    const auto objects = truth();
    ASSERT_EQ(objects.size(), 1U);
    EXPECT_EQ(objects[0].scan_index, 1);
    EXPECT_NEAR(objects[0].timestamp, 1317042146.067, 1e-6);
    EXPECT_EQ(objects[0].type, "cyclist");
    EXPECT_NEAR(objects[0].box.center.x(), 10.0, 1e-4);
    EXPECT_NEAR(objects[0].box.center.z(), kHeight - 1.7 + 0.85, 1e-4);
    EXPECT_NEAR(objects[0].box.yaw, 0.5, 1e-5);
    EXPECT_EQ(objects[0].box.size, Eigen::Vector3d(1.8, 0.6, 1.7));
    const auto ego = evaluation::readEgoPoses(path("out_ego.csv"));
    EXPECT_NEAR(ego.at(1).position.z(), 1.0, 1e-4);
}

/// A scene of two sweeps, the second a keyframe with a bus and a barrier.
class NuScenes : public Kitti2Rawlog {
  protected:
    NuScenes() {
        const std::string tables = "in/v1.0-mini/";
        const json ahead_is_y = {std::sqrt(0.5), 0, 0, -std::sqrt(0.5)};  // the sensor's y looks ahead
        const json turned = {std::sqrt(0.5), 0, 0, std::sqrt(0.5)};       // the vehicle looks along the world's y
        const auto table = [&](const char* name, const json& rows) { write(tables + name + ".json", rows.dump()); };
        table("scene", {{{"token", "s"}, {"name", "scene-0001"}}, {{"token", "t"}, {"name", "scene-0002"}}});
        table("sample", {{{"token", "a"}, {"scene_token", "s"}}, {{"token", "b"}, {"scene_token", "t"}}});
        table("sensor", {{{"token", "lidar"}, {"channel", "LIDAR_TOP"}}, {{"token", "cam"}, {"channel", "CAM_BACK"}}});
        table("calibrated_sensor",
              {{{"token", "cl"}, {"sensor_token", "lidar"}, {"translation", {0.9, 0, 1.8}}, {"rotation", ahead_is_y}},
               {{"token", "cc"}, {"sensor_token", "cam"}, {"translation", {0, 0, 1}}, {"rotation", turned}}});
        table("ego_pose", {{{"token", "p"}, {"translation", {100, 200, 0}}, {"rotation", turned}}});
        const auto sweep = [](const char* token, const char* sample, const char* sensor, double time, bool key) {
            return json{{"token", token},
                        {"sample_token", sample},
                        {"calibrated_sensor_token", sensor},
                        {"ego_pose_token", "p"},
                        {"timestamp", time},
                        {"filename", "sweeps/" + std::string(token) + ".pcd.bin"},
                        {"is_key_frame", key}};
        };
        table("sample_data",
              {sweep("two", "a", "cl", 1532402927700000, true), sweep("one", "a", "cl", 1532402927650000, false),
               sweep("picture", "a", "cc", 1532402927650000, true), sweep("other", "b", "cl", 1, true)});
        table("instance",
              {{{"token", "i"}, {"category_token", "bus"}}, {{"token", "j"}, {"category_token", "barrier"}}});
        table("category", {{{"token", "bus"}, {"name", "vehicle.bus.rigid"}},
                           {{"token", "barrier"}, {"name", "movable_object.barrier"}}});
        const auto label = [&](const char* token, const char* sample, const char* instance) {
            return json{{"token", token},          {"sample_token", sample},        {"instance_token", instance},
                        {"visibility_token", "3"}, {"translation", {95, 220, 1.5}}, {"size", {2.5, 11, 3.0}},
                        {"rotation", turned}};
        };
        table("sample_annotation", {label("1", "a", "i"), label("2", "a", "j"), label("3", "b", "i")});
        for (const char* token : {"one", "two"})
            writePoints(std::string("in/sweeps/") + token + ".pcd.bin", sweepPoints());
    }
    /// 32 planes, 0 = lowest: one point 10 m ahead in each, and one on the bus.
    static Points sweepPoints() {
        Points points;
        for (int ring = 0; ring < 32; ++ring)
            points.push_back({0.F, 10.F, -3.F + 0.2F * static_cast<float>(ring), 51.F, static_cast<float>(ring)});
        points.push_back({-5.F, 14.F, 0.F, 255.F, 20.F});
        return points;
    }
};

TEST_F(NuScenes, SweepsLabelsAndPosesComeIntoTheVehicleFrame) {
    const Outcome r = run("--sequence scene-0001");
    ASSERT_EQ(r.code, 0) << r.err;
    const Contents c = contents();
    ASSERT_EQ(c.clouds.size(), 2U);
    EXPECT_NEAR(c.clouds[0].timestamp, 1532402927.65, 1e-6);
    EXPECT_NEAR((c.clouds[0].xyz[0] - Eigen::Vector3f(10.9F, 0.F, -1.2F)).norm(), 0.0, 1e-4);
    EXPECT_EQ(c.clouds[0].ring[5], 5);
    EXPECT_NEAR(c.clouds[0].intensity[0], 0.2, 0.5 / 255 + 1e-6);
    const auto objects = truth();
    ASSERT_EQ(objects.size(), 2U);
    const TruthObject& bus = objects[0];
    EXPECT_EQ(bus.scan_index, 1) << "the keyframe";
    EXPECT_EQ(bus.type, "bus");
    EXPECT_NEAR(bus.box.center.x(), 20.0, 1e-4);
    EXPECT_NEAR(bus.box.center.y(), 5.0, 1e-4);
    EXPECT_NEAR(bus.box.yaw, 0.0, 1e-5);
    EXPECT_EQ(bus.box.size, Eigen::Vector3d(11, 2.5, 3));
    EXPECT_EQ(bus.num_points, 1);
    EXPECT_EQ(bus.occluded, 1.0);
    EXPECT_EQ(objects[1].type, "misc");
    EXPECT_NEAR(c.poses.at(1)->pose.mean.yaw(), M_PI / 2, 1e-9);
    EXPECT_NEAR(evaluation::readEgoPoses(path("out_ego.csv")).at(0).position.y(), 200.0, 1e-9);
}

TEST_F(NuScenes, RingsThatCountFromTheTopAreTurnedAround) {
    Points upside_down = sweepPoints();
    for (auto& p : upside_down) p[4] = 31.F - p[4];
    writePoints("in/sweeps/one.pcd.bin", upside_down);
    ASSERT_EQ(run("--sequence scene-0001").code, 0);
    EXPECT_EQ(contents().clouds.at(0).ring[5], 5);
}

TEST_F(NuScenes, TheSceneHasToBeNamed) {
    const Outcome r = run("");
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, HasSubstr("one of: scene-0001, scene-0002"));
    write("in/v1.0-mini/sensor.json", "[{\"token\": \"lidar\"");
    EXPECT_THAT(run("--sequence scene-0001").err, HasSubstr("sensor.json"));
}

TEST_F(Kitti2Rawlog, PointCloudsAreForThoseWhoLookAtThem) {
    writePoints("in/velodyne/000000.bin", turn(63, 0, 36));
    ASSERT_EQ(run("--scan-class pointcloud").code, 0);
    const Contents c = contents();
    EXPECT_TRUE(std::dynamic_pointer_cast<mrpt::obs::CObservationPointCloud>(c.scans.at(0)));
    EXPECT_EQ(c.clouds.at(0).size(), 64U * 36U);
}

TEST_F(Kitti2Rawlog, AFullDiskIsAnErrorAndLeavesTheFilesOfAnEarlierRun) {
    writePoints("in/velodyne/000000.bin", turn(63, 0, 36));
    for (const char* name : {"out.rawlog", "out_gt.csv", "out_ego.csv"}) write(name, "of an earlier run");
    fs::create_symlink("/dev/full", path("out.rawlog.part"));
    const Outcome r = run("");
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, testing::AllOf(HasSubstr("out.rawlog"), HasSubstr("No space left on device")));
    EXPECT_FALSE(fs::is_symlink(path("out.rawlog.part")));
    for (const char* name : {"out.rawlog", "out_gt.csv", "out_ego.csv"})
        EXPECT_EQ(readFile(path(name)), "of an earlier run") << name;
}

TEST_F(Kitti2Rawlog, ADiskThatRunsFullLeavesWholeScansAndTheirTruth) {
    for (const char* scan : {"000000", "000001", "000002", "000003"}) {
        writePoints(std::string("in/velodyne/") + scan + ".bin", turn(63, 0, 90));
        write(std::string("in/calib/") + scan + ".txt", calibration());
        write(std::string("in/label_2/") + scan + ".txt", "Car 0 0 0 0 0 10 10 1.5 1.6 4.0 -2.0 1.73 20.0 -1.570796\n");
    }
    ASSERT_EQ(run("").code, 0);
    ASSERT_EQ(truth().size(), 4U);
    const auto blocks = fs::file_size(path("out.rawlog")) / 512 / 2;  // room for half of it
    const Outcome r = run("", "in", "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + ";");
    EXPECT_EQ(r.code, 1);
    EXPECT_THAT(r.err, testing::AllOf(HasSubstr("out.rawlog: cannot write"), HasSubstr("the scans before it")));
    const std::size_t scans = contents().clouds.size();
    EXPECT_GT(scans, 0U);
    EXPECT_LT(scans, 4U);
    EXPECT_EQ(truth().size(), scans);
}

TEST_F(Kitti2Rawlog, WhatIsWrongIsNamedAndNothingIsLeftBehind) {
    write("in/velodyne/000000.bin", "17 bytes, not 16.");
    const Outcome cut = run("");
    EXPECT_EQ(cut.code, 1);
    EXPECT_THAT(cut.err, HasSubstr("000000.bin: 17 bytes"));
    EXPECT_FALSE(fs::exists(path("out.rawlog")));
    EXPECT_FALSE(fs::exists(path("out.rawlog.part")));
    EXPECT_FALSE(fs::exists(path("out_gt.csv")));

    writePoints("in/velodyne/000000.bin", turn(70, 0, 36));
    EXPECT_THAT(run("").err, HasSubstr("71 rings found, the sensor has 64"));

    writePoints("in/velodyne/000000.bin", turn(63, 0, 36));
    write("in/label_2/000000.txt", "Car 0 0\n");
    write("in/calib/000000.txt", "P0: 1\n");
    EXPECT_THAT(run("").err, HasSubstr("000000.txt: no R0_rect in it"));
    write("in/calib/000000.txt", calibration());
    EXPECT_THAT(run("").err, HasSubstr("000000.txt:1: only 3 words"));

    EXPECT_EQ(run("--planes 7").code, 2);
    EXPECT_EQ(run("--layout other").code, 2);
    EXPECT_EQ(run("--from 5").code, 1);
    fs::remove_all(path("in"));
    EXPECT_THAT(run("").err, HasSubstr("no such folder"));
}

}  // namespace
}  // namespace lidar_obstacles
