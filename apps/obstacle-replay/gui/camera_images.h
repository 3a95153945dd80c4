// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Which image of a recording is shown beside a scan.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "camera_image.h"
#include "scan_store.h"

namespace lidar_obstacles::apps {

/// Knows which camera is chosen: at first the first one of the recording.
class CameraImages {
  public:
    /// The next camera; behind the last one none. @return what is shown now, in words.
    std::string next(const ScanStore& store);
    /// The image of the chosen camera that belongs to a scan: the nearest in time of those that the store knows. Null
    /// where there is none, or none is wanted. To be called from the thread that reads scans.
    std::shared_ptr<const CameraImage> beside(const ScanStore& store, std::size_t index);
    /// What beside() has given last.
    const std::shared_ptr<const CameraImage>& shown() const { return shown_; }

  private:
    std::optional<std::size_t> camera_ = 0;  ///< its place among those of the store; not set: none is wanted
    std::string label_;                      ///< of shown_
    std::size_t number_ = 0;                 ///< likewise
    std::shared_ptr<const CameraImage> shown_;
};

}  // namespace lidar_obstacles::apps
