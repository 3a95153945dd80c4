// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/capture_stream.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "mrpt_bridge/input/gz_error.h"

namespace lidar_obstacles {
namespace {

ssize_t readCookie(void* file, char* to, std::size_t size) {
    return gzread(static_cast<gzFile>(file), to, static_cast<unsigned>(std::min<std::size_t>(size, 1U << 30U)));
}

int closeCookie(void* file) { return gzclose(static_cast<gzFile>(file)) == Z_OK ? 0 : EOF; }

[[noreturn]] void failToOpen(const std::string& path, const std::string& reason) {
    throw std::runtime_error("cannot open " + path + ": " + reason);
}

/// What zlib unpacks, as the stream that libpcap reads from. zlib hands on what is not compressed as it is.
std::FILE* streamOf(gzFile file) {
    std::FILE* stream = fopencookie(file, "rb", {readCookie, nullptr, nullptr, closeCookie});
    if (stream) std::setvbuf(stream, nullptr, _IOFBF, 1U << 16U);
    return stream;
}

}  // namespace

CaptureStream::CaptureStream(const std::string& path) {
    std::error_code ec;
    if (std::filesystem::is_directory(path, ec)) failToOpen(path, "a directory");
    errno = 0;
    file_ = gzopen(path.c_str(), "rb");
    if (!file_) failToOpen(path, std::strerror(errno ? errno : ENOMEM));
    std::FILE* stream = streamOf(file_);
    if (!stream) {
        gzclose(file_);
        failToOpen(path, std::strerror(errno));
    }
    std::array<char, PCAP_ERRBUF_SIZE> error{};
    handle_ = pcap_fopen_offline(stream, error.data());
    if (!handle_) {
        const std::string broken = gzErrorOf(file_);
        std::fclose(stream);
        failToOpen(path, broken.empty() ? error.data() : broken);
    }
    const int type = pcap_datalink(handle_);
    if (!isKnownLinkType(type)) {
        pcap_close(handle_);
        const char* const name = pcap_datalink_val_to_description(type);
        throw std::runtime_error("cannot read " + path + ": captures of link type " + std::to_string(type) +
                                 (name ? std::string(" (") + name + ")" : "") + " are not supported");
    }
    const auto size = std::filesystem::file_size(path, ec);
    size_ = ec ? 0.0 : static_cast<double>(size);
    reader_.emplace(type);
}

CaptureStream::~CaptureStream() { pcap_close(handle_); }

bool CaptureStream::next(pcap_pkthdr*& header, const std::uint8_t*& frame) {
    const int result = pcap_next_ex(handle_, &header, &frame);
    if (result == 1) return true;
    damage_ = gzErrorOf(file_);
    if (damage_.empty() && result != PCAP_ERROR_BREAK) damage_ = pcap_geterr(handle_);
    return false;
}

double CaptureStream::progress() const {
    return size_ > 0.0 ? std::clamp(static_cast<double>(gzoffset(file_)) / size_, 0.0, 1.0) : 1.0;
}

}  // namespace lidar_obstacles
