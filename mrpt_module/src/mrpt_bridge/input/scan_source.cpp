// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/scan_source.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/pcap_reader.h"
#include "lidar_obstacles/mrpt_bridge/rawlog_reader.h"

namespace lidar_obstacles {
namespace {

enum class Content : std::uint8_t { Rawlog, Capture, Other };

/// The first bytes of a file, unpacked if it is a gzip file.
std::string headOf(const std::string& path) {
    errno = 0;
    gzFile file = gzopen(path.c_str(), "rb");
    if (!file) throw std::runtime_error("cannot open " + path + ": " + std::strerror(errno ? errno : ENOMEM));
    std::string head(128, '\0');
    const int got = gzread(file, head.data(), static_cast<unsigned>(head.size()));
    head.resize(static_cast<std::size_t>(std::max(got, 0)));
    gzclose(file);
    return head;
}

bool beginsWith(const std::string& bytes, std::string_view mark) { return bytes.compare(0, mark.size(), mark) == 0; }

/// True if the bytes may be the begin of an MRPT object: the length of a class name, and the name. Nothing is said
/// against a file that ends before that.
bool mayBeObject(const std::string& bytes) {
    if (bytes.empty()) return true;
    const auto length = static_cast<std::size_t>(static_cast<unsigned char>(bytes[0]) & 0x7FU);
    const std::string name = bytes.substr(1, length);
    return length > 0 && std::all_of(name.begin(), name.end(), [](unsigned char c) {
               return std::isalnum(c) != 0 || std::strchr("_:<>", c) != nullptr;
           });
}

Content contentOf(const std::string& head) {
    using namespace std::string_view_literals;
    // pcap in either byte order, with micro- or nanoseconds; pcapng.
    for (const auto magic :
         {"\xd4\xc3\xb2\xa1"sv, "\xa1\xb2\xc3\xd4"sv, "\x4d\x3c\xb2\xa1"sv, "\xa1\xb2\x3c\x4d"sv, "\x0a\x0d\x0d\x0a"sv})
        if (beginsWith(head, magic)) return Content::Capture;
    return mayBeObject(head) ? Content::Rawlog : Content::Other;
}

/// "a PNG picture, " for kinds of files that are taken for recordings by mistake; "" for others.
std::string kindOf(const std::string& head) {
    using namespace std::string_view_literals;
    constexpr std::array<std::pair<std::string_view, const char*>, 5> kKinds{{{"\x89PNG"sv, "a PNG picture, "},
                                                                              {"\xff\xd8\xff"sv, "a JPEG picture, "},
                                                                              {"PK\x03\x04"sv, "a ZIP archive, "},
                                                                              {"%PDF"sv, "a PDF document, "},
                                                                              {"#ROSBAG"sv, "a ROS bag, "}}};
    for (const auto& [mark, kind] : kKinds)
        if (beginsWith(head, mark)) return kind;
    return "";
}

/// What cannot be read again from its beginning cannot even be looked at.
void refusePipe(const std::string& path) {
    std::error_code ec;
    const auto type = std::filesystem::status(path, ec).type();
    if (type == std::filesystem::file_type::fifo || type == std::filesystem::file_type::socket)
        throw std::runtime_error("cannot read " + path + ": a pipe can be read once only; save it to a file first");
}

}  // namespace

std::unique_ptr<ScanSource> openScanSource(const std::string& path, const InputOptions& options) {
    refusePipe(path);
    const std::string head = headOf(path);
    const Content content = contentOf(head);
    if (content == Content::Other)
        throw std::runtime_error(path + ": " + kindOf(head) + "neither a rawlog nor a Velodyne capture");
    if (content == Content::Capture) return std::make_unique<PcapReader>(path, options);
    if (options.areForCaptures())
        throw std::invalid_argument(path + ": a port, a sender or a sensor model can be chosen in captures only");
    return std::make_unique<RawlogReader>(path, 0, options.with_clouds);
}

std::map<std::string, std::size_t> lidarLabels(const std::string& path, std::size_t max_objects,
                                               const InputOptions& options) {
    std::map<std::string, std::size_t> labels;
    InputOptions without_clouds = options;
    without_clouds.with_clouds = false;
    const auto source = openScanSource(path, without_clouds);
    while (const auto item = source->next()) {
        if (item->object >= max_objects) break;
        if (item->observation && isLidarScan(*item->observation)) ++labels[item->lidar];
    }
    return labels;
}

}  // namespace lidar_obstacles
