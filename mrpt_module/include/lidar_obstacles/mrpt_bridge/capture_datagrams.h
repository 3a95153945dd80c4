// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The UDP datagrams of a network capture, of any sensor and port.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace lidar_obstacles {

class CaptureStream;

/// A UDP datagram over IPv4 as a capture holds it; one that came in fragments is put together.
struct CapturedDatagram {
    const std::uint8_t* data = nullptr;  ///< valid until the next call of CaptureDatagrams::next()
    std::size_t length = 0;              ///< as it was sent [byte]
    bool complete = false;               ///< false: the capture was cut short and holds less than `length` bytes
    std::uint32_t sender = 0;            ///< IPv4 address, first byte highest
    std::uint16_t port = 0;              ///< that it was sent to
    double time = 0.0;                   ///< of its capture, seconds since the epoch
};

/// Reads a pcap or pcapng file, plain or gzip, datagram by datagram, in constant memory. PcapReader makes scans of it.
///
/// Not to be used by several threads at a time.
class CaptureDatagrams {
  public:
    /// @throws std::runtime_error naming the file if it cannot be opened, is no capture, or of a link type that is not
    ///         known.
    explicit CaptureDatagrams(const std::string& path);
    ~CaptureDatagrams();
    CaptureDatagrams(CaptureDatagrams&&) noexcept;
    CaptureDatagrams& operator=(CaptureDatagrams&&) noexcept;

    /// The next datagram; nullopt at the end and at damage. Other frames are passed over.
    std::optional<CapturedDatagram> next();
    /// Why the records ended before the file did, with the number of the last one; empty: they did not.
    std::string damage() const;

  private:
    std::string path_;
    std::unique_ptr<CaptureStream> stream_;
    std::size_t records_ = 0;  ///< frames read, of any kind
};

}  // namespace lidar_obstacles
