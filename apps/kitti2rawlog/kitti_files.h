// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Calibrations, labels and poses as KITTI writes them (Geiger et al. 2013, and the development kits' readme files).
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "input_text.h"
#include "sequence.h"

namespace lidar_obstacles::apps {

/// Where the camera's labels and the inertial unit's poses are, seen from the velodyne.
struct KittiCalibration {
    Eigen::Isometry3d T_velo_camera = Eigen::Isometry3d::Identity();  ///< rectified camera 0 -> velodyne
    Eigen::Isometry3d T_velo_imu = Eigen::Isometry3d::Identity();
};

/// calib/NNNNNN.txt (object) or calib/SSSS.txt (tracking): R0_rect or R_rect, Tr_velo_to_cam or Tr_velo_cam,
/// Tr_imu_to_velo or Tr_imu_velo.
/// @throws std::runtime_error naming the file if one of them is missing or has another size.
KittiCalibration readCameraCalibration(const std::filesystem::path& file);

/// calib_imu_to_velo.txt (raw): R, T. @throws as above.
Eigen::Isometry3d readImuToVelo(const std::filesystem::path& file);

/// calib.txt of an odometry sequence: Tr, the velodyne in the left camera's frame. @throws as above.
Eigen::Isometry3d readOdometryCalibration(const std::filesystem::path& file);

/// The left colour camera, seen from the vehicle.
struct KittiCamera {
    double fx = 0.0, fy = 0.0, cx = 0.0, cy = 0.0;  ///< of its rectified images [pixels]
    Eigen::Isometry3d T_vehicle_camera = Eigen::Isometry3d::Identity();

    /// Its image in a file. None if there is no such file.
    std::optional<FrameImage> image(const std::filesystem::path& file, double timestamp) const;
};

/// P2 or P_rect_02 of a calibration: the projection from the rectified camera 0. @throws as above.
KittiCamera readColourCamera(const std::filesystem::path& file, const Eigen::Isometry3d& T_vehicle_rect0);

/// The rectified camera 0 seen from the velodyne (raw): calib_velo_to_cam.txt and calib_cam_to_cam.txt of the folder of
/// a day. @throws as above.
Eigen::Isometry3d readRawCamera(const std::filesystem::path& day);

/// @throws std::runtime_error naming the folder if it is not there: images were asked for.
void requireImages(const std::filesystem::path& folder);

/// Twelve numbers: the upper three rows of a transform, row by row. @throws std::runtime_error naming file and line.
Eigen::Isometry3d isometryOf(const Words& row);

/// A label of the camera's frame in the vehicle frame.
/// @param words       the line of label_2, or of label_02 from its third word on.
/// @param first       number of the word that holds the type.
/// @param T_vehicle_camera  of the rectified camera 0.
/// @return nullopt for DontCare, which has no place in space.
std::optional<LabelledObject> objectOfLabel(const Words& words, std::size_t first,
                                            const Eigen::Isometry3d& T_vehicle_camera);

/// tracklet_labels.xml (raw): objects of each frame; ids are the tracklets' numbers.
/// @param T_vehicle_velo  the tracklets are told in the velodyne's frame.
/// @throws std::runtime_error naming the file if it is no such file.
std::map<std::size_t, std::vector<LabelledObject>> readTracklets(const std::filesystem::path& file,
                                                                 const Eigen::Isometry3d& T_vehicle_velo);

/// Places a row of oxts (latitude, longitude, altitude, roll, pitch, yaw ...) in a Mercator plane in metres: x east,
/// y north, z up.
/// @param latitude_deg  whose scale the plane has: that of the first row of a drive.
Eigen::Isometry3d poseOfOxts(const Words& words, double latitude_deg);

/// Planes of KITTI's velodyne, and the time between its scans [s].
constexpr int kKittiPlanes = 64;
constexpr double kKittiPeriod = 0.1;

/// KITTI's velodyne on the vehicle, whose frame begins on the ground below it.
Eigen::Isometry3d vehicleVelo(const SequenceOptions& options);

/// The .bin files of a folder, by number, or by name if that is none. @throws std::runtime_error if there are none.
std::vector<std::filesystem::path> scansIn(const std::filesystem::path& folder);

/// "2 scans between the others are missing, the first is 4", by their numbers; empty if none is.
std::string missingOf(const std::vector<std::filesystem::path>& scans);

/// Number in a file's name: 000042.bin is 42. @throws std::runtime_error for another name.
std::size_t numberOf(const std::filesystem::path& file);

/// "Car" -> "car", "Person_sitting" -> "person_sitting"; "Misc" -> "misc".
std::string kittiType(const std::string& word);

/// "2011-09-26 13:02:25.964389445" (UTC) as seconds since the epoch. @throws std::runtime_error naming the text.
double secondsOf(const std::string& date_and_time);

}  // namespace lidar_obstacles::apps
