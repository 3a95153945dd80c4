// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A recording with what was found in it, for MRPT's own tools.
#pragma once

#include <mrpt/obs/CObservation3DScene.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/rawlog_writer.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles {

/// Coloured points, boxes, headings and labels of one scan as RawLogViewer shows them, stamped as the scan. Without the
/// occupancy grid: the viewers' fixed clip planes let a carpet below the ground cover what stands on it.
///
/// `sensorLabel` is that of the scan with "_obstacles" behind it, or "obstacles" where the scan has none. MRPT does not
/// save the label of a CObservation3DScene, so the scene shows it too: object `sensor_label`, at the vehicle.
/// @throws std::invalid_argument if the result is not one of this cloud.
mrpt::obs::CObservation3DScene::Ptr toSceneObservation(const PointCloud& cloud, const DetectionResult& result,
                                                       const std::string& scan_label, const SceneOptions& options = {});

/// Copies a recording, object by object, and puts two observations behind each scan that something is told about: a
/// CObservation3DScene, to be looked at, and the results, to be read by programs (results.h).
///
/// The format stays what it was: the observations of a sensory frame stay together, and those two join them. The
/// comment is written first; one that the recording has already is appended to it, as MRPT keeps one for a rawlog.
/// Memory does not grow with the recording.
/// An object is for one thread at a time.
class AnnotatedRawlog {
  public:
    /// @param comment  e.g. the parameters of the run (dumpParams()).
    /// @throws std::runtime_error naming the file if it cannot be written.
    AnnotatedRawlog(std::filesystem::path file, std::string comment);
    /// Removes the file unless it was closed.
    ~AnnotatedRawlog();

    /// The next object of the recording. @throws std::runtime_error naming the file if it cannot be written.
    void copy(const SourceItem& item);
    /// What was found in the scan that was copied last. @throws as copy(); as toSceneObservation()
    void annotate(const PointCloud& cloud, const DetectionResult& result, const SceneOptions& options = {});
    /// Completes the file. @throws std::runtime_error
    void close();

  private:
    void append(const mrpt::obs::CObservation::Ptr& observation);
    void writeComment(const std::string& of_recording);
    void writePending();

    RawlogWriter writer_;
    std::string comment_;
    bool has_comment_ = false;  ///< it is written
    bool has_actions_ = false;  ///< the recording is made of actions and frames
    std::optional<std::size_t> object_;
    std::string scan_label_;                             ///< of the scan copied last
    mrpt::Clock::time_point time_ = INVALID_TIMESTAMP;   ///< of the observation copied last
    std::vector<mrpt::obs::CObservation::Ptr> pending_;  ///< of the object that is being copied
    std::size_t copied_ = 0;                             ///< of these, from the recording
};

/// Hands on what another source reads, and copies it to an annotated rawlog on the way.
/// An object is for one thread at a time.
class CopyingSource : public ScanSourceFilter {
  public:
    CopyingSource(std::unique_ptr<ScanSource> source, AnnotatedRawlog& to)
        : ScanSourceFilter(*source), owned_(std::move(source)), to_(to) {}

    /// @throws std::runtime_error if the copy cannot be written.
    std::optional<SourceItem> next() override;

  private:
    std::unique_ptr<ScanSource> owned_;
    AnnotatedRawlog& to_;
};

}  // namespace lidar_obstacles
