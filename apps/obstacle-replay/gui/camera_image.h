// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Images of a recording's cameras, and where the scene's boxes are in them. No window.
#pragma once

#include <mrpt/img/CImage.h>
#include <mrpt/img/TCamera.h>
#include <mrpt/obs/CObservationImage.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/external_files.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::apps {

/// An image, and the camera that took it.
struct CameraImage {
    std::string label;
    double time = 0.0;        ///< [s since the epoch]
    mrpt::img::CImage image;  ///< in colour; empty if there is a problem
    mrpt::img::TCamera camera;
    Eigen::Isometry3d T_vehicle_camera = Eigen::Isometry3d::Identity();  ///< camera: x right, y down, z along the view
    std::string problem;  ///< why there is no image, in one line; empty if there is one
};

/// The image of an observation; one that is stored in a file of its own is read.
CameraImage cameraImageOf(const mrpt::obs::CObservationImage& observation, const ExternalFiles& files);

/// A line in an image [pixels].
using ImageLine = std::pair<Eigen::Vector2d, Eigen::Vector2d>;

/// Where points of the vehicle frame are in an image: a pinhole camera without distortion, with that of a lens
/// (plumb bob), or a fisheye (Kannala and Brandt). Pixel (0, 0) is the middle of the first one.
class CameraProjection {
  public:
    /// The calibration may be told for another size of the image: it is scaled then. Where that has another shape it
    /// is taken as it is: MRPT says 640 x 480 of what nobody told.
    explicit CameraProjection(const CameraImage& image);

    /// False without a focal length: nothing can be drawn then.
    bool isCalibrated() const { return calibrated_; }
    /// None for what the camera cannot see: nearer than 0.1 m, behind it, or so far to the side that the lens's model
    /// does not hold. It may lie outside of the image.
    std::optional<Eigen::Vector2d> pixelOf(const Eigen::Vector3d& point) const;
    /// The edges of a box in short pieces, as far as the camera sees them; empty if no piece meets the image.
    std::vector<ImageLine> edgesOf(const OrientedBox& box) const;

  private:
    bool meetsImage(const ImageLine& line) const;

    mrpt::img::TCamera camera_;
    Eigen::Isometry3d T_camera_vehicle_;
    Eigen::Vector2d size_;  ///< of the image [pixels]
    double widest_ = 0.0;   ///< sideways per metre ahead: where the model of the lens ends
    bool calibrated_ = false;
};

}  // namespace lidar_obstacles::apps
