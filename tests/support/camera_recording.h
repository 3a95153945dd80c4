// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Small rawlogs with scans and images of cameras.
#pragma once

#include <mrpt/obs/CObservationImage.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "support/rawlog_files.h"

namespace lidar_obstacles::test {

/// A camera that looks along the vehicle's x: its x is right, its y down, its z ahead.
inline Eigen::Isometry3d aheadFrom(const Eigen::Vector3d& at) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    T.translation() = at;
    return T;
}

/// 640 x 480, 90 degrees wide, without distortion, at (2, 0, 1.5) of the vehicle, looks ahead.
inline std::shared_ptr<mrpt::obs::CObservationImage> cameraObservation(const std::string& label, double time) {
    auto image = std::make_shared<mrpt::obs::CObservationImage>();
    image->sensorLabel = label;
    image->timestamp = mrpt::Clock::fromDouble(time);
    image->cameraPose =
        mrpt::poses::CPose3D(mrpt::math::CMatrixDouble44(Eigen::Matrix4d(aheadFrom({2.0, 0.0, 1.5}).matrix())));
    image->cameraParams.setIntrinsicParamsFromValues(320.0, 320.0, 320.0, 240.0);
    image->image.resize(640, 480, mrpt::img::CH_RGB);
    image->image.filledRectangle(0, 0, 639, 479, mrpt::img::TColor(150, 180, 220));
    image->image.filledRectangle(0, 240, 639, 479, mrpt::img::TColor(90, 90, 80));
    return image;
}

/// Scans 0.1 s apart; 0.02 s after each of the first ones an image of the camera "front", then one of "rear".
struct CameraRecording {
    bool compressed = true;
    std::size_t scans = 3, images = 3;
    std::string folder;  ///< images are files LABEL_K.png in it; empty: they are in the rawlog
};

inline void writeCameraRecording(const std::string& path, const CameraRecording& what) {
    constexpr double kBegin = 1'000'000.0;
    Objects objects;
    if (!what.folder.empty()) std::filesystem::create_directories(what.folder);
    for (std::size_t k = 0; k < what.scans; ++k) {
        const double time = kBegin + 0.1 * static_cast<double>(k);
        objects.push_back(scanLabelled("velodyne", time));
        for (const char* label : {"front", "rear"}) {
            if (k >= what.images) continue;
            const auto image = cameraObservation(label, time + 0.02);
            const std::string name = std::string(label) + "_" + std::to_string(k) + ".png";
            if (!what.folder.empty()) {
                const std::string file = what.folder + "/" + name;
                if (!image->image.saveToFile(file)) throw std::runtime_error("cannot write " + file);
                image->image.setExternalStorage(name);
            }
            objects.push_back(image);
        }
    }
    writeRawlog(path, objects, what.compressed);
}

}  // namespace lidar_obstacles::test
