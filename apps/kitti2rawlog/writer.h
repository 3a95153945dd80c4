// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What comes out: a rawlog, its truth and the vehicle's poses.
#pragma once

#include <memory>
#include <string>

#include "sequence.h"

namespace lidar_obstacles::apps {

/// How a scan is stored.
enum class ScanClass : std::uint8_t {
    Velodyne,   ///< CObservationVelodyneScan with its point cloud filled, laser_id = plane
    PointCloud  ///< CObservationPointCloud: RawLogViewer shows it, rings are lost
};

struct WriterOptions {
    std::string prefix;
    int planes = 0;  ///< keep so many of the sensor's rings, evenly spaced; 0: all
    ScanClass scan_class = ScanClass::Velodyne;
};

/// Writes PREFIX.rawlog (gzip), PREFIX_gt.csv and, where poses are known, PREFIX_ego.csv. Images are copied to
/// PREFIX_Images/, where MRPT's programs look for them; the rawlog has their names, cameras and calibrations.
///
/// A return counts as an object's if it lies in its box, grown by 0.1 m to the sides and above, and higher than 0.1 m
/// above its bottom (which is ground).
class SequenceWriter {
  public:
    /// @param sensor_planes  of the recording.
    /// @throws std::invalid_argument if `planes` does not divide them; std::runtime_error if a file cannot be written.
    SequenceWriter(const WriterOptions& options, int sensor_planes);
    ~SequenceWriter();
    SequenceWriter(const SequenceWriter&) = delete;
    SequenceWriter& operator=(const SequenceWriter&) = delete;

    /// The next scan. @throws std::runtime_error naming the file, with no row of this scan kept; finish() keeps those
    ///     before it.
    void add(const Frame& frame);
    /// Completes the files: until then the rawlog is called *.part, and what is not finished is removed.
    /// @throws std::runtime_error
    void finish();

  private:
    struct Files;
    std::unique_ptr<Files> files_;
};

}  // namespace lidar_obstacles::apps
