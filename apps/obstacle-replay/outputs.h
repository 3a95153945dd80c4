// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The files obstacle-replay writes.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "common/text_file.h"
#include "exports.h"
#include "exports/replay_page.h"
#include "gui/recorder.h"
#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/health.h"
#include "lidar_obstacles/mrpt_bridge/annotated_rawlog.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"
#include "lidar_obstacles/zones.h"
#include "options.h"

namespace lidar_obstacles::apps {

/// A scan and what watches it.
struct Watched {
    const SequenceResult& found;
    const HealthReport& health;
    const ZoneMonitor* zones = nullptr;  ///< null: there are none
};

/// The output folder: obstacles.csv, and per selected scan a scene, a grid and a picture.
/// All functions throw std::runtime_error that names the file if something cannot be written.
class Outputs {
  public:
    /// Makes the folder, takes away what an earlier run left in it, and makes the renderer if there will be pictures.
    Outputs(const Options& options, const DetectorParams& params);

    /// With --annotate: begins the annotated rawlog, to which the returned source copies what is read.
    /// @throws UsageError if it is the input.
    std::unique_ptr<ScanSource> annotate(std::unique_ptr<ScanSource> source, const Options& options,
                                         const DetectorParams& params);

    /// Draws the scans that follow into options.show.record. @throws std::runtime_error if that cannot be.
    void startRecording(const Options& options, const DetectorParams& params);
    /// One scan; `processed` counts the scans since the start, `scan_index` those of the input.
    /// Voxels of the detector's 3D filter, the returns that it took out, and zones are drawn into the scene.
    void add(std::size_t processed, std::size_t scan_index, const Watched& scan, const ObstacleDetector& detector);
    /// Writes own_body.txt, which region.own_body can name. @return its path.
    std::string writeOwnBody(const OwnBody& body, const std::string& comment);
    /// Completes the files and writes summary.json. @param note  what the page of --report says of the run's end.
    void finish(const std::string& summary, const std::string& note);
    /// Takes the obstacles away: the run was wrong from the start.
    void discard();
    /// Scans that were added.
    std::size_t scans() const { return scans_; }

  private:
    std::filesystem::path fileOf(const char* kind, std::size_t scan_index, const char* extension) const;
    void draw(std::size_t processed, std::size_t scan_index, const Watched& scan, const ObstacleDetector& detector);
    void writeGrid(std::size_t scan_index, const OccupancyGrid& grid) const;

    std::size_t scans_ = 0;
    std::size_t frames_ = 0;  ///< that poses made of the scans were told in so far
    Selection scenes_;
    Selection grids_;
    Selection pictures_;
    SceneOptions scene_options_;
    CameraView view_;
    std::filesystem::path folder_;
    bool low_ = true;  ///< low things were looked for
    std::optional<SceneRenderer> renderer_;
    std::optional<Exports> exports_;
    std::optional<TextFile> merges_;  ///< with --explain
    std::optional<AnnotatedRawlog> annotated_;
    std::unique_ptr<Recorder> recorder_;
    std::unique_ptr<ReplayPage> page_;
    std::string input_;
};

}  // namespace lidar_obstacles::apps
