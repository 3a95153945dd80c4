// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Inputs from pipes.
#pragma once

#include <string>

namespace lidar_obstacles::apps {

/// An input that can be read from its beginning as often as it takes. What can be read once only (a pipe, a socket;
/// "-" is the standard input) is copied to a temporary file, which is gone when the program ends, whatever way.
class RereadableInput {
  public:
    /// @throws std::runtime_error naming the input if it cannot be copied. A file that is not there is no error here.
    explicit RereadableInput(const std::string& input);
    ~RereadableInput();
    RereadableInput(const RereadableInput&) = delete;
    RereadableInput& operator=(const RereadableInput&) = delete;

    /// What to open.
    const std::string& path() const { return path_; }

  private:
    std::string path_;
    int copy_ = -1;  ///< file descriptor; -1: the input itself is read
};

}  // namespace lidar_obstacles::apps
