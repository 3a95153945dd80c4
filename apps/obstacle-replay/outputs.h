/// @file
/// The files obstacle-replay writes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "common/text_file.h"
#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "lidar_obstacles/types.h"
#include "options.h"

namespace lidar_obstacles::apps {

/// The output folder: obstacles.csv, and per selected scan a scene, a grid and a picture.
/// All functions throw std::runtime_error that names the file if something cannot be written.
class Outputs {
  public:
    /// Makes the folder, takes an earlier run's summary out of it, and makes the renderer if there will be pictures.
    explicit Outputs(const Options& options);

    /// One scan; `processed` counts the scans since the start, `scan_index` those of the input.
    /// Voxels of the detector's 3D filter and the returns that it took out are drawn into the scene.
    void add(std::size_t processed, std::size_t scan_index, const SequenceResult& found,
             const ObstacleDetector& detector);
    /// Completes obstacles.csv and writes summary.json.
    void finish(const std::string& summary);
    /// Takes obstacles.csv away: the run was wrong from the start.
    void discard() { csv_->discard(); }

  private:
    std::filesystem::path fileOf(const char* kind, std::size_t scan_index, const char* extension) const;
    void writeGrid(std::size_t scan_index, const OccupancyGrid& grid) const;

    Selection scenes_;
    Selection grids_;
    Selection pictures_;
    SceneOptions scene_options_;
    CameraView view_;
    std::filesystem::path folder_;
    std::optional<SceneRenderer> renderer_;
    std::optional<TextFile> csv_;
};

}  // namespace lidar_obstacles::apps
