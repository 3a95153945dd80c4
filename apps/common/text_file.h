// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Text files that are complete or not there: a disk that runs full is an error and leaves whole rows only.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace lidar_obstacles::apps {

/// A file that grows by blocks. Until close() it is called `<name>.part`; a file of that name from an earlier run is
/// replaced only then. Two runs cannot write the same file at a time. A block that cannot be written is taken off
/// again, so that the file ends with the one before.
class TextFile {
  public:
    /// @throws std::runtime_error naming the file and the reason, also where another run is writing it.
    explicit TextFile(std::filesystem::path file);
    /// Closes it; errors are lost here.
    ~TextFile();
    TextFile(const TextFile&) = delete;
    TextFile& operator=(const TextFile&) = delete;

    /// Appends a block and hands it to the system.
    /// @throws std::runtime_error naming the file and the reason; the file is closed with what was good. If nothing
    /// was, a file of that name from an earlier run stays.
    void append(const std::string& block);
    /// Gives the file its name. @throws std::runtime_error
    void close();
    /// Takes the file away instead.
    void discard();

  private:
    std::filesystem::path file_;
    std::filesystem::path part_;
    int lock_ = -1;  ///< of the part, held until it has its name
    std::ofstream out_;
    std::uintmax_t good_ = 0;
};

/// Writes a whole file. @throws std::runtime_error naming the file and the reason.
void writeTextFile(const std::filesystem::path& file, const std::string& text);

}  // namespace lidar_obstacles::apps
