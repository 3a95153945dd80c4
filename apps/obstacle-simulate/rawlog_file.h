/// @file
/// A gzip rawlog that is complete or not there.
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <filesystem>
#include <memory>

namespace lidar_obstacles::apps {

/// Until close() it is called `<name>.part`. Unlike MRPT's own stream it reports what the disk refuses at the end.
class RawlogFile {
  public:
    /// @throws std::runtime_error naming the file and the reason.
    explicit RawlogFile(std::filesystem::path file);
    /// Removes the file unless it was closed.
    ~RawlogFile();
    RawlogFile(const RawlogFile&) = delete;
    RawlogFile& operator=(const RawlogFile&) = delete;

    /// @throws std::runtime_error naming the file and the reason.
    void append(const mrpt::serialization::CSerializable& object);
    /// Completes the file and gives it its name. @throws std::runtime_error
    void close();

  private:
    std::filesystem::path file_, part_;
    void* stream_;  ///< zlib's; null when closed
};

}  // namespace lidar_obstacles::apps
