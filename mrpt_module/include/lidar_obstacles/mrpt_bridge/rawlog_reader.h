// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Rawlogs, object by object.
#pragma once

#include <deque>
#include <memory>

#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace lidar_obstacles {

class ExternalClouds;
class LidarNames;

/// Streams a rawlog of either format (single observations, or actions and sensory frames), plain or gzip.
///
/// Objects of other classes than observations, frames and actions are passed over and counted in remarks(). A class
/// that MRPT does not know, a file cut inside an object and a gzip stream that fails its own checks are damage. A
/// plain file cut exactly between two objects looks like a shorter one.
///
/// Points that are stored in files of their own (CObservationPointCloud; NAME_Images/ beside the rawlog) are read with
/// the observation. Where that cannot be the item is a gap, counted in remarks().
/// An object is for one thread at a time.
class RawlogReader : public ScanSource {
  public:
    /// @param start  byte at which to begin: 0, or an objectBegin() of a file that is not compressed.
    /// @param with_clouds  false: points in files of their own are not read.
    /// @throws std::runtime_error naming the file if it cannot be opened, or is compressed and `start` is not 0.
    explicit RawlogReader(const std::string& path, std::uint64_t start = 0, bool with_clouds = true);
    ~RawlogReader() override;

    std::optional<SourceItem> next() override;
    SourceStatus status() const override { return status_; }
    std::size_t objects() const override { return objects_; }
    const std::string& message() const override { return message_; }
    std::string remarks() const override;
    double progress() const override;

    /// Byte of the (uncompressed) file at which the object that next() gave last begins.
    std::uint64_t objectBegin() const { return object_begin_; }
    bool isCompressed() const;

  private:
    class GzArchive;

    bool readObject();
    void add(const mrpt::obs::CObservation::Ptr& observation, std::size_t number);
    void fail(const std::string& reason);

    std::string path_;
    std::unique_ptr<GzArchive> archive_;
    std::deque<SourceItem> pending_;  ///< of the object read last
    SourceStatus status_ = SourceStatus::Open;
    std::size_t objects_ = 0;
    std::uint64_t object_begin_ = 0;
    std::unique_ptr<ExternalClouds> clouds_;  ///< null: they are not read
    std::unique_ptr<LidarNames> names_;
    std::size_t passed_over_ = 0;
    std::size_t gaps_ = 0;
    std::string first_gap_;  ///< why
    std::string message_;
};

}  // namespace lidar_obstacles
