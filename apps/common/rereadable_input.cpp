// SPDX-License-Identifier: BSD-3-Clause
#include "common/rereadable_input.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "common/nameless_file.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what, int error) {
    throw std::runtime_error(what + ": " + std::strerror(error));
}

void writeAll(int file, const char* data, std::size_t size) {
    while (size > 0) {
        const ssize_t done = write(file, data, size);
        if (done < 0 && errno != EINTR) fail("cannot write a temporary copy of the input", errno);
        if (done < 0) continue;
        data += done;
        size -= static_cast<std::size_t>(done);
    }
}

void copyAll(const std::string& input, int from, int to) {
    std::array<char, 1U << 16U> buffer{};
    for (;;) {
        const ssize_t got = read(from, buffer.data(), buffer.size());
        if (got == 0) return;
        if (got < 0 && errno != EINTR) fail("cannot read " + input, errno);
        if (got > 0) writeAll(to, buffer.data(), static_cast<std::size_t>(got));
    }
}

}  // namespace

RereadableInput::RereadableInput(const std::string& input) : path_(input == "-" ? "/dev/stdin" : input) {
    std::error_code ec;
    const fs::file_status status = fs::status(path_, ec);
    const bool once = fs::is_fifo(status) || fs::is_socket(status);
    if (!once) return;
    const int from = open(path_.c_str(), O_RDONLY | O_CLOEXEC);
    if (from < 0) fail("cannot open " + path_, errno);
    try {
        copy_ = openNamelessFile();
        copyAll(path_, from, copy_);
    } catch (...) {
        close(from);
        if (copy_ >= 0) close(copy_);
        throw;
    }
    close(from);
    path_ = "/proc/self/fd/" + std::to_string(copy_);
}

RereadableInput::~RereadableInput() {
    if (copy_ >= 0) close(copy_);
}

}  // namespace lidar_obstacles::apps
