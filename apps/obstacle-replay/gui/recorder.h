// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A run as pictures, one per scan: what the window shows, drawn without a display.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "lidar_obstacles/mrpt_bridge/scene_layers.h"
#include "overlay.h"
#include "video_file.h"
#include "view_options.h"

namespace lidar_obstacles::apps {

/// What is recorded, and from where.
struct Recording {
    std::string input;  ///< name of the file that is replayed, for the titles
    ViewOptions options;
    CameraView view;
    DetectorParams params;
};

/// Draws scans into a folder (frame_NNNNNN.png, by the number of the scan) or an .mp4 that plays as fast as they were
/// recorded.
class Recorder {
  public:
    /// Takes the frames of an earlier recording out of the folder.
    /// @throws std::runtime_error if nothing can be drawn or written.
    explicit Recorder(const Recording& recording);

    /// @param zones  as they are after the scan; null: there are none.
    /// @throws std::runtime_error naming the file if it cannot be written.
    void add(std::size_t scan_index, const SequenceResult& found, const ObstacleDetector& detector,
             const ZoneMonitor* zones);
    /// Completes the video. @throws std::runtime_error
    void finish();

  private:
    mrpt::img::CImage draw(const std::shared_ptr<ShownScan>& scan);
    void write(const mrpt::img::CImage& picture, double time);
    void openVideo(double frames_per_second);

    Recording recording_;
    TruthByScan truth_;
    SceneRenderer renderer_;
    SceneLayers layers_;
    Overlay overlay_;
    TrackTails tails_;
    double first_time_ = 0.0;
    std::unique_ptr<VideoFile> video_;
    std::optional<mrpt::img::CImage> waiting_;  ///< the first picture, until the second one tells how fast they come
};

}  // namespace lidar_obstacles::apps
