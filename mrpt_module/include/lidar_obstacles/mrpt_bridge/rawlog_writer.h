// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Rawlogs that end with a whole object, whatever happens.
#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace lidar_obstacles {

/// Writes a gzip rawlog, object by object. Until close() it is called `<name>.part`.
///
/// Each object is compressed for itself (a gzip member; readers take a row of them for one stream) and handed to the
/// system at once. So a file that was cut off by a full disk or a killed process holds whole objects only up to the
/// last one, and memory does not grow.
/// An object is for one thread at a time.
class RawlogWriter {
  public:
    /// @throws std::runtime_error naming the file and the reason.
    explicit RawlogWriter(std::filesystem::path file);
    /// Removes the file unless it was closed.
    ~RawlogWriter();
    RawlogWriter(const RawlogWriter&) = delete;
    RawlogWriter& operator=(const RawlogWriter&) = delete;

    /// @throws std::runtime_error naming the file and the reason; what was written before is whole and close() keeps
    ///     it.
    void append(const mrpt::serialization::CSerializable& object);
    /// Completes the file and gives it its name. @throws std::runtime_error
    void close();

    /// Objects written.
    std::size_t objects() const { return objects_; }

  private:
    struct Compressor;

    void write(const std::uint8_t* data, std::size_t size);

    std::filesystem::path file_, part_;
    std::unique_ptr<Compressor> compressor_;
    int descriptor_ = -1;  ///< of the open file
    std::uint64_t good_ = 0;
    std::size_t objects_ = 0;
};

}  // namespace lidar_obstacles
