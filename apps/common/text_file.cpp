// SPDX-License-Identifier: BSD-3-Clause
#include "common/text_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace lidar_obstacles::apps {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file) {
    throw std::runtime_error(file.string() + ": cannot write: " + std::strerror(errno ? errno : EIO));
}

/// True if a file that was opened is still the one of that name: the run that held it may have renamed it meanwhile.
bool isStillThere(int descriptor, const std::filesystem::path& file) {
    struct stat open{}, named{};
    return ::fstat(descriptor, &open) == 0 && ::stat(file.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
           open.st_dev == named.st_dev;
}

/// A file that no other run holds; file systems that know no locks let everyone have it.
int locked(const std::filesystem::path& file) {
    for (;;) {
        errno = 0;
        const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (descriptor < 0) fail(file);
        const bool taken = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
        if (!taken && isStillThere(descriptor, file)) return descriptor;
        ::close(descriptor);
        if (taken) throw std::runtime_error(file.string() + ": cannot write: another run is writing it");
    }
}

}  // namespace

TextFile::TextFile(std::filesystem::path file)
    : file_(std::move(file)), part_(file_.string() + ".part"), lock_(locked(part_)) {
    errno = 0;
    out_.open(part_, std::ios::binary | std::ios::trunc);
    if (!out_) fail(part_);
}

TextFile::~TextFile() {
    try {
        close();
    } catch (const std::exception&) {  // close() before if it matters
    }
    ::close(lock_);
}

void TextFile::append(const std::string& block) {
    errno = 0;
    out_ << block << std::flush;
    if (out_) {
        good_ += block.size();
        return;
    }
    const int reason = errno;
    if (good_ == 0) {
        discard();
    } else {
        out_.close();
        std::error_code ignored;
        std::filesystem::resize_file(part_, good_, ignored);
        std::filesystem::rename(part_, file_, ignored);
    }
    errno = reason;
    fail(file_);
}

void TextFile::close() {
    if (!out_.is_open()) return;
    errno = 0;
    out_.close();
    if (!out_ || std::rename(part_.c_str(), file_.c_str()) != 0) fail(file_);
}

void TextFile::discard() {
    out_.close();
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
}

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
    TextFile out(file);
    out.append(text);
    out.close();
}

}  // namespace lidar_obstacles::apps
