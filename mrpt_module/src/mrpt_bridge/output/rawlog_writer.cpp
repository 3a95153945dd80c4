// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/rawlog_writer.h"

#include <fcntl.h>
#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>
#include <unistd.h>
#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace lidar_obstacles {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, int reason) {
    throw std::runtime_error(file.string() + ": cannot write: " + std::strerror(reason ? reason : EIO));
}

}  // namespace

/// zlib's state, and the bytes of one compressed object.
struct RawlogWriter::Compressor {
    z_stream stream{};
    std::vector<std::uint8_t> bytes;

    Compressor() {
        constexpr int kLevel = 4;  // half the time of 6 and a twentieth larger
        constexpr int kGzip = 15 + 16, kMemory = 8;
        if (deflateInit2(&stream, kLevel, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
            throw std::bad_alloc();
    }
    ~Compressor() { deflateEnd(&stream); }
    Compressor(const Compressor&) = delete;
    Compressor& operator=(const Compressor&) = delete;

    /// One gzip member with this content, in `bytes`. @return its size.
    std::size_t compress(void* data, std::size_t size) {
        deflateReset(&stream);
        bytes.resize(deflateBound(&stream, size));
        stream.next_in = static_cast<Bytef*>(data);
        stream.avail_in = static_cast<uInt>(size);
        stream.next_out = bytes.data();
        stream.avail_out = static_cast<uInt>(bytes.size());
        if (deflate(&stream, Z_FINISH) != Z_STREAM_END) throw std::runtime_error("cannot compress an object");
        return stream.total_out;
    }
};

RawlogWriter::RawlogWriter(std::filesystem::path file)
    : file_(std::move(file)), part_(file_.string() + ".part"), compressor_(std::make_unique<Compressor>()) {
    descriptor_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(part_, errno);
}

RawlogWriter::~RawlogWriter() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
}

void RawlogWriter::append(const mrpt::serialization::CSerializable& object) {
    mrpt::io::CMemoryStream plain;
    mrpt::serialization::archiveFrom(plain).WriteObject(&object);
    const std::size_t size = compressor_->compress(plain.getRawBufferData(), plain.getTotalBytesCount());
    write(compressor_->bytes.data(), size);
    ++objects_;
}

void RawlogWriter::write(const std::uint8_t* data, std::size_t size) {
    for (std::size_t done = 0; done < size;) {
        const ssize_t n = ::write(descriptor_, data + done, size - done);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            const int reason = errno;
            // Takes off what is there of the object; where even that fails the file ends in a damaged one.
            if (::ftruncate(descriptor_, static_cast<off_t>(good_)) == 0)
                ::lseek(descriptor_, static_cast<off_t>(good_), SEEK_SET);
            fail(file_, reason);
        }
        done += static_cast<std::size_t>(n);
    }
    good_ += size;
}

void RawlogWriter::close() {
    if (descriptor_ < 0) return;
    const bool closed = ::close(std::exchange(descriptor_, -1)) == 0;
    if (closed && std::rename(part_.c_str(), file_.c_str()) == 0) return;
    const int reason = errno;
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
    fail(file_, reason);
}

}  // namespace lidar_obstacles
