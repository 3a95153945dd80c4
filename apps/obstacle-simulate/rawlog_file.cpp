#include "rawlog_file.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace lidar_obstacles::apps {
namespace {

gzFile toGz(void* stream) { return static_cast<gzFile>(stream); }

[[noreturn]] void fail(const std::filesystem::path& file) {
    throw std::runtime_error(file.string() + ": cannot write: " + std::strerror(errno ? errno : EIO));
}

}  // namespace

RawlogFile::RawlogFile(std::filesystem::path file) : file_(std::move(file)), part_(file_.string() + ".part") {
    errno = 0;
    stream_ = gzopen(part_.c_str(), "wb4");  // level 4: half the time of 6 and a twentieth larger
    if (!stream_) fail(file_);
}

RawlogFile::~RawlogFile() {
    if (!stream_) return;
    gzclose(toGz(stream_));
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
}

void RawlogFile::append(const mrpt::serialization::CSerializable& object) {
    mrpt::io::CMemoryStream bytes;
    mrpt::serialization::archiveFrom(bytes).WriteObject(&object);
    const auto size = static_cast<unsigned>(bytes.getTotalBytesCount());
    errno = 0;
    if (gzwrite(toGz(stream_), bytes.getRawBufferData(), size) != static_cast<int>(size)) fail(file_);
}

void RawlogFile::close() {
    errno = 0;
    const int result = gzclose(toGz(std::exchange(stream_, nullptr)));
    if (result == Z_OK && std::rename(part_.c_str(), file_.c_str()) == 0) return;
    const int reason = errno;
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
    errno = reason;
    fail(file_);
}

}  // namespace lidar_obstacles::apps
