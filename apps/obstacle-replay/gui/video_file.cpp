// SPDX-License-Identifier: BSD-3-Clause
#include "video_file.h"

#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <utility>
#include <vector>

extern char** environ;

namespace lidar_obstacles::apps {
namespace {

/// Starts a program whose standard input is the given socket, in a process group of its own: Ctrl-C, which goes to all
/// of a group, is for us to handle. @return its process id; -1 if it is not installed.
pid_t start(std::vector<std::string> words, int input) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    pid_t pid = -1;
    const int error = posix_spawnp(&pid, arguments[0], &actions, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    return error == 0 ? pid : -1;
}

}  // namespace

VideoFile::VideoFile(std::filesystem::path file, const std::string& size, double frames_per_second)
    : file_(std::move(file)), part_(file_) {
    part_ += ".part";
    char rate[32];
    std::snprintf(rate, sizeof rate, "%.3f", frames_per_second);
    std::array<int, 2> ends{};
    // a socket and not a pipe: writing to one that ffmpeg has closed is an error and no signal
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) fail();
    socket_ = ends[0];
    ffmpeg_ = start({"ffmpeg",  "-loglevel", "error",      "-y",       "-f",   "rawvideo",    "-pix_fmt",
                     "bgr24",   "-s",        size,         "-r",       rate,   "-i",          "-",
                     "-c:v",    "libx264",   "-preset",    "veryfast", "-crf", "20",          "-pix_fmt",
                     "yuv420p", "-movflags", "+faststart", "-f",       "mp4",  part_.string()},
                    ends[1]);
    ::close(ends[1]);
    if (ffmpeg_ > 0) return;
    ::close(socket_);
    throw std::runtime_error(file_.string() + ": ffmpeg is not installed (Debian: ffmpeg); --record DIR needs none");
}

VideoFile::~VideoFile() {
    if (socket_ < 0) return;
    wait();
    std::error_code error;
    std::filesystem::remove(part_, error);
}

void VideoFile::append(const mrpt::img::CImage& picture) {
    const std::size_t row = picture.getWidth() * 3;
    for (std::size_t y = 0; y < picture.getHeight(); ++y) {
        const auto* data = picture.ptrLine<std::uint8_t>(static_cast<unsigned>(y));
        for (std::size_t done = 0; done < row;) {
            const ssize_t n = send(socket_, data + done, row - done, MSG_NOSIGNAL);
            if (n < 0 && errno == EINTR) continue;
            if (n <= 0) fail();
            done += static_cast<std::size_t>(n);
        }
    }
}

void VideoFile::close() {
    if (wait() != 0) fail();
    std::error_code error;
    std::filesystem::rename(part_, file_, error);
    if (error) fail();
}

/// Ends the input and waits for ffmpeg. @return its exit code.
int VideoFile::wait() {
    ::close(std::exchange(socket_, -1));
    int status = 0;
    while (waitpid(ffmpeg_, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 1;
}

void VideoFile::fail() {
    std::error_code error;
    std::filesystem::remove(part_, error);
    throw std::runtime_error(file_.string() + ": cannot write the video");
}

}  // namespace lidar_obstacles::apps
