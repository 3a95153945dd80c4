// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A labelled recording, whatever the layout of its files.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// A labelled object; vehicle frame.
struct LabelledObject {
    std::string id;
    std::string type;  ///< lower case, in the words that the evaluation knows; "misc": neither wanted nor false
    OrientedBox box;
    int occluded = 0;  ///< 0: fully visible .. 3: unknown, as KITTI counts
};

/// An image of a camera without distortion, and where it looks.
struct FrameImage {
    std::filesystem::path file;
    std::string camera;                                                  ///< its name
    double timestamp = 0.0;                                              ///< seconds since the epoch
    double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;                       ///< [pixels]
    Eigen::Isometry3d T_vehicle_camera = Eigen::Isometry3d::Identity();  ///< camera: x right, y down, z along the view
};

/// One scan with its labels.
struct Frame {
    double timestamp = 0.0;               ///< seconds since the epoch
    std::vector<Eigen::Vector3f> points;  ///< sensor frame [m]
    std::vector<float> intensity;         ///< 0 .. 1
    std::vector<std::uint16_t> ring;      ///< 0 = lowest
    Eigen::Isometry3d T_vehicle_sensor = Eigen::Isometry3d::Identity();
    std::optional<Eigen::Isometry3d> T_world_vehicle;
    std::vector<LabelledObject> objects;
    std::optional<FrameImage> image;  ///< none: not asked for, or the recording lacks it
};

/// The scans of a recording, loaded one by one.
struct Sequence {
    std::size_t frames = 0;
    int planes = 0;                          ///< of the sensor
    std::function<Frame(std::size_t)> load;  ///< throws std::runtime_error naming the file that is not right
    std::string remark = {};                 ///< what the recording lacks; empty if nothing
};

/// What is to be converted.
struct SequenceOptions {
    std::string folder;
    std::string sequence;            ///< "0001" (tracking), "00" (odometry) or the name of a scene (nuScenes)
    double sensor_height = 1.73;     ///< of KITTI's sensor above the ground: the vehicle frame begins below it [m]
    double start_time = 1317000000;  ///< of recordings without times [s]; their scans are 0.1 s apart
    bool images = false;             ///< also of the left colour camera (KITTI) or the front camera (nuScenes)
};

/// KITTI object: velodyne/NNNNNN.bin, calib/NNNNNN.txt, label_2/NNNNNN.txt (without it: no objects). Single frames:
/// ids are unique over all of them.
/// @throws std::runtime_error if there are no scans; so do the others.
Sequence openKittiObject(const SequenceOptions& options);

/// KITTI tracking: velodyne/SSSS/NNNNNN.bin, calib/SSSS.txt, label_02/SSSS.txt, oxts/SSSS.txt (the last two may be
/// missing).
Sequence openKittiTracking(const SequenceOptions& options);

/// KITTI raw: a drive's folder with velodyne_points/data and timestamps.txt, oxts/data, tracklet_labels.xml (the last
/// two may be missing), and calib_imu_to_velo.txt beside it in the folder of the day. Line n of timestamps.txt is the
/// scan called n; scans without a file in oxts/data have no pose.
Sequence openKittiRaw(const SequenceOptions& options);

/// KITTI odometry: sequences/SS/velodyne/NNNNNN.bin, times.txt and calib.txt, poses/SS.txt (may be missing), or the
/// folder of one sequence with poses.txt in it. Line n of the files is the scan called n. The world's frame is the
/// vehicle's at the beginning. No labels.
Sequence openKittiOdometry(const SequenceOptions& options);

/// nuScenes: the folder with samples/, sweeps/ and v1.0-*/; all LIDAR_TOP sweeps of a scene. Keyframes are labelled.
Sequence openNuScenes(const SequenceOptions& options);

}  // namespace lidar_obstacles::apps
