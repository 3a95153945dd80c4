// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A network capture, plain or compressed, record by record.
#pragma once

#include <pcap/pcap.h>
#include <zlib.h>

#include <cstdint>
#include <optional>
#include <string>

#include "mrpt_bridge/input/udp_reader.h"

namespace lidar_obstacles {

/// A pcap or pcapng file, also one that gzip packed: it is unpacked as it is read, in constant memory.
class CaptureStream {
  public:
    /// @throws std::runtime_error naming the file if it cannot be opened, is no capture, or of a link type that is not
    ///         known.
    explicit CaptureStream(const std::string& path);
    ~CaptureStream();
    CaptureStream(const CaptureStream&) = delete;
    CaptureStream& operator=(const CaptureStream&) = delete;

    /// The next record; false at the end and at damage. What it points to holds until the next call.
    bool next(pcap_pkthdr*& header, const std::uint8_t*& frame);
    /// Why the records ended before the file did; empty: they did not.
    const std::string& damage() const { return damage_; }
    /// Share of the file that was read, 0 .. 1.
    double progress() const;

    UdpReader& reader() { return *reader_; }
    const UdpReader& reader() const { return *reader_; }

  private:
    gzFile file_ = nullptr;  ///< of `handle_`, which closes it
    pcap_t* handle_ = nullptr;
    std::optional<UdpReader> reader_;
    double size_ = 0.0;  ///< of the file as it lies on disk [byte]
    std::string damage_;
};

}  // namespace lidar_obstacles
