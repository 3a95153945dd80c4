// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Pictures -> .mp4, through the program ffmpeg.
#pragma once

#include <mrpt/img/CImage.h>
#include <sys/types.h>

#include <filesystem>
#include <string>

namespace lidar_obstacles::apps {

/// A video that grows picture by picture. Until close() it is called `<name>.part`; a file of that name from an earlier
/// run is replaced only then.
class VideoFile {
  public:
    /// @param size  "800x600": of all pictures, even numbers.
    /// @throws std::runtime_error if ffmpeg is not installed.
    VideoFile(std::filesystem::path file, const std::string& size, double frames_per_second);
    /// Closes it; a video that is not complete is taken away.
    ~VideoFile();
    VideoFile(const VideoFile&) = delete;
    VideoFile& operator=(const VideoFile&) = delete;

    /// @throws std::runtime_error naming the file if ffmpeg has given up; its own words stand on stderr.
    void append(const mrpt::img::CImage& picture);
    /// @throws std::runtime_error as append().
    void close();

  private:
    int wait();
    [[noreturn]] void fail();

    std::filesystem::path file_;
    std::filesystem::path part_;
    int socket_ = -1;
    pid_t ffmpeg_ = -1;
};

}  // namespace lidar_obstacles::apps
