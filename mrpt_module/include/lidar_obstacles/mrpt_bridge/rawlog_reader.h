/// @file
/// Rawlogs, object by object.
#pragma once

#include <deque>
#include <memory>

#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace lidar_obstacles {

/// Streams a rawlog of either format (single observations, or actions and sensory frames), plain or gzip.
///
/// Objects of other classes than observations, frames and actions are passed over and counted in remarks(). A class
/// that MRPT does not know, a file cut inside an object and a gzip stream that fails its own checks are damage. A
/// plain file cut exactly between two objects looks like a shorter one.
class RawlogReader : public ScanSource {
  public:
    /// @param start  byte at which to begin: 0, or an objectBegin() of a file that is not compressed.
    /// @throws std::runtime_error naming the file if it cannot be opened, or is compressed and `start` is not 0.
    explicit RawlogReader(const std::string& path, std::uint64_t start = 0);
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
    void fail(const std::string& reason);

    std::string path_;
    std::unique_ptr<GzArchive> archive_;
    std::deque<SourceItem> pending_;  ///< of the object read last
    SourceStatus status_ = SourceStatus::Open;
    std::size_t objects_ = 0;
    std::uint64_t object_begin_ = 0;
    std::size_t passed_over_ = 0;
    std::string message_;
};

}  // namespace lidar_obstacles
