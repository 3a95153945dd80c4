// SPDX-License-Identifier: BSD-3-Clause
#include "camera_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

namespace lidar_obstacles::apps {
namespace {

using mrpt::img::DistortionModel;

constexpr double kNearest = 0.1;  ///< of what is projected, along the view [m]
constexpr int kPieces = 12;       ///< of an edge: lenses bend it, and part of it may be behind the camera
constexpr double kMargin = 1.1;   ///< how far beyond the image's corners a lens is trusted

cv::Matx33d matrixOf(const mrpt::img::TCamera& camera) {
    return {camera.fx(), 0.0, camera.cx(), 0.0, camera.fy(), camera.cy(), 0.0, 0.0, 1.0};
}

std::vector<double> lensOf(const mrpt::img::TCamera& camera) {
    switch (camera.distortion) {
        case DistortionModel::plumb_bob:  // in OpenCV's order
            return {camera.dist.begin(), camera.dist.end()};
        case DistortionModel::kannala_brandt:
            return {camera.k1(), camera.k2(), camera.dist[2], camera.dist[3]};
        case DistortionModel::none:
            break;
    }
    return {0.0, 0.0, 0.0, 0.0};
}

/// The steepest of the rays through the image's corners: sideways per metre ahead.
double widestOf(const mrpt::img::TCamera& camera, const Eigen::Vector2d& size) {
    const std::vector<cv::Point2d> corners = {{0, 0}, {size.x(), 0}, {0, size.y()}, {size.x(), size.y()}};
    std::vector<cv::Point2d> rays;
    if (camera.distortion == DistortionModel::kannala_brandt)
        cv::fisheye::undistortPoints(corners, rays, matrixOf(camera), lensOf(camera));
    else
        cv::undistortPoints(corners, rays, matrixOf(camera), lensOf(camera));
    double widest = 0.0;
    for (const cv::Point2d& ray : rays) widest = std::max(widest, std::hypot(ray.x, ray.y));
    return std::isfinite(widest) ? kMargin * widest : std::numeric_limits<double>::infinity();
}

std::array<Eigen::Vector3d, 8> cornersOf(const OrientedBox& box) {
    const Eigen::AngleAxisd turn(box.yaw, Eigen::Vector3d::UnitZ());
    std::array<Eigen::Vector3d, 8> corners;
    for (std::size_t k = 0; k < 8; ++k) {
        const Eigen::Vector3d sign((k & 1U) ? 0.5 : -0.5, (k & 2U) ? 0.5 : -0.5, (k & 4U) ? 0.5 : -0.5);
        corners[k] = box.center + turn * sign.cwiseProduct(box.size);
    }
    return corners;
}

}  // namespace

CameraImage cameraImageOf(const mrpt::obs::CObservationImage& observation, const ExternalFiles& files) {
    CameraImage image;
    image.label = observation.sensorLabel;
    image.time = mrpt::Clock::toDouble(observation.timestamp);
    image.camera = observation.cameraParams;
    image.T_vehicle_camera =
        Eigen::Isometry3d(observation.cameraPose.getHomogeneousMatrixVal<mrpt::math::CMatrixDouble44>().asEigen());
    mrpt::img::CImage stored = observation.image;
    if (stored.isExternallyStored()) {
        const std::string name = stored.getExternalStorageFile();
        const auto place = files.find(name);
        stored = mrpt::img::CImage();
        if (!place) {
            image.problem = name + ": no such file in " + files.folder().string() + " or beside the rawlog";
        } else if (!stored.loadFromFile((place->folder / place->file).string())) {
            image.problem = (place->folder / place->file).string() + ": no image in it";
        }
    }
    if (!image.problem.empty()) return image;
    if (stored.isEmpty())
        image.problem = "the image is empty";
    else
        image.image = stored.colorImage();
    return image;
}

CameraProjection::CameraProjection(const CameraImage& image)
    : camera_(image.camera), T_camera_vehicle_(image.T_vehicle_camera.inverse()) {
    if (image.image.isEmpty()) return;
    size_ = {static_cast<double>(image.image.getWidth()), static_cast<double>(image.image.getHeight())};
    const double width = camera_.ncols, height = camera_.nrows;
    const bool same_shape = width > 0.0 && std::abs(width * size_.y() - height * size_.x()) < 0.5 * size_.maxCoeff();
    if (same_shape && width != size_.x())
        camera_.scaleToResolution(static_cast<unsigned>(size_.x()), static_cast<unsigned>(size_.y()));
    calibrated_ = camera_.fx() > 0.0 && camera_.fy() > 0.0;
    if (calibrated_) widest_ = widestOf(camera_, size_);
}

std::optional<Eigen::Vector2d> CameraProjection::pixelOf(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d p = T_camera_vehicle_ * point;
    if (!calibrated_ || p.z() < kNearest) return std::nullopt;
    if (camera_.distortion == DistortionModel::none)
        return Eigen::Vector2d(camera_.fx() * p.x() / p.z() + camera_.cx(),
                               camera_.fy() * p.y() / p.z() + camera_.cy());
    if (std::hypot(p.x(), p.y()) > widest_ * p.z()) return std::nullopt;
    const std::vector<cv::Point3d> points = {{p.x(), p.y(), p.z()}};
    std::vector<cv::Point2d> pixels;
    const cv::Vec3d none(0, 0, 0);
    if (camera_.distortion == DistortionModel::kannala_brandt)
        cv::fisheye::projectPoints(points, pixels, none, none, matrixOf(camera_), lensOf(camera_));
    else
        cv::projectPoints(points, none, none, matrixOf(camera_), lensOf(camera_), pixels);
    return Eigen::Vector2d(pixels[0].x, pixels[0].y);
}

bool CameraProjection::meetsImage(const ImageLine& line) const {
    const Eigen::Vector2d low = line.first.cwiseMin(line.second), high = line.first.cwiseMax(line.second);
    return high.x() >= 0.0 && high.y() >= 0.0 && low.x() < size_.x() && low.y() < size_.y();
}

std::vector<ImageLine> CameraProjection::edgesOf(const OrientedBox& box) const {
    std::vector<ImageLine> lines;
    const auto corners = cornersOf(box);
    bool seen = false;
    for (std::size_t k = 0; k < 8; ++k)
        for (const std::size_t bit : {1U, 2U, 4U}) {
            if (k & bit) continue;
            auto before = pixelOf(corners[k]);
            for (int step = 1; step <= kPieces; ++step) {
                const double share = static_cast<double>(step) / kPieces;
                const auto here = pixelOf((1.0 - share) * corners[k] + share * corners[k | bit]);
                if (before && here) lines.emplace_back(*before, *here);
                seen = seen || (before && here && meetsImage(lines.back()));
                before = here;
            }
        }
    if (!seen) lines.clear();
    return lines;
}

}  // namespace lidar_obstacles::apps
