// SPDX-License-Identifier: BSD-3-Clause
#include "camera_images.h"

namespace lidar_obstacles::apps {

std::string CameraImages::next(const ScanStore& store) {
    const auto cameras = store.cameras();
    if (cameras.empty()) return "no images of cameras in this recording";
    const std::size_t next = camera_ ? *camera_ + 1 : 0;
    camera_ = next < cameras.size() ? std::optional(next) : std::nullopt;
    return camera_ ? "images of " + cameras[next] : "no images";
}

std::shared_ptr<const CameraImage> CameraImages::beside(const ScanStore& store, std::size_t index) {
    const auto cameras = store.cameras();
    const bool is_there = camera_ && *camera_ < cameras.size();
    const auto number = is_there ? store.imageBeside(cameras[*camera_], index) : std::nullopt;
    if (!number) {
        shown_.reset();
    } else if (!shown_ || label_ != cameras[*camera_] || number_ != *number) {
        label_ = cameras[*camera_];
        number_ = *number;
        shown_ = std::make_shared<const CameraImage>(store.readImage(label_, number_));
    }
    return shown_;
}

}  // namespace lidar_obstacles::apps
