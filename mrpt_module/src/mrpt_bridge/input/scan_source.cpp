#include "lidar_obstacles/mrpt_bridge/scan_source.h"

#include <zlib.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/pcap_reader.h"
#include "lidar_obstacles/mrpt_bridge/rawlog_reader.h"

namespace lidar_obstacles {
namespace {

enum class Content : std::uint8_t { Rawlog, Capture, CompressedCapture };

Content contentOf(const std::string& path) {
    errno = 0;
    gzFile file = gzopen(path.c_str(), "rb");
    if (!file) throw std::runtime_error("cannot open " + path + ": " + std::strerror(errno ? errno : ENOMEM));
    std::array<unsigned char, 4> head{};
    const int got = gzread(file, head.data(), 4);
    const bool compressed = gzdirect(file) == 0;
    gzclose(file);
    if (got != 4) return Content::Rawlog;
    // pcap in either byte order, with micro- or nanoseconds; pcapng.
    constexpr std::array<std::array<unsigned char, 4>, 5> kMagic{{{0xd4, 0xc3, 0xb2, 0xa1},
                                                                  {0xa1, 0xb2, 0xc3, 0xd4},
                                                                  {0x4d, 0x3c, 0xb2, 0xa1},
                                                                  {0xa1, 0xb2, 0x3c, 0x4d},
                                                                  {0x0a, 0x0d, 0x0d, 0x0a}}};
    for (const auto& magic : kMagic)
        if (head == magic) return compressed ? Content::CompressedCapture : Content::Capture;
    return Content::Rawlog;
}

}  // namespace

std::unique_ptr<ScanSource> openScanSource(const std::string& path) {
    const Content content = contentOf(path);
    if (content == Content::CompressedCapture)
        throw std::runtime_error("cannot read " + path + ": a compressed capture; unpack it first (gunzip)");
    if (content == Content::Capture) return std::make_unique<PcapReader>(path);
    return std::make_unique<RawlogReader>(path);
}

std::map<std::string, std::size_t> lidarLabels(const std::string& path, std::size_t max_objects) {
    std::map<std::string, std::size_t> labels;
    const auto source = openScanSource(path);
    while (const auto item = source->next()) {
        if (item->object >= max_objects) break;
        if (item->observation && isLidarScan(*item->observation)) ++labels[item->observation->sensorLabel];
    }
    return labels;
}

}  // namespace lidar_obstacles
