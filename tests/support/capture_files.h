// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Captures written for a test, byte by byte as the pcap format and the IP and UDP headers are described.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "support/velodyne_packets.h"

namespace lidar_obstacles::test {

inline std::string little(std::uint64_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> static_cast<unsigned>(8 * i) & 0xffU);
    return text;
}

inline std::string big(std::uint32_t value, int bytes) {
    const std::string reversed = little(value, bytes);
    return {reversed.rbegin(), reversed.rend()};
}

/// An IPv4 packet with a UDP datagram.
inline std::string ipv4(const std::string& payload, unsigned port = 2368, std::uint32_t source = 0xc0a801c9U) {
    const auto length = static_cast<std::uint32_t>(payload.size());
    const std::string udp = big(2368, 2) + big(port, 2) + big(length + 8, 2) + big(0, 2) + payload;
    return big(0x4500, 2) + big(length + 28, 2) + big(0, 4) + big(0x4011, 2) + big(0, 2) + big(source, 4) +
           big(0xffffffffU, 4) + udp;
}

/// The same in fragments of at most `size` bytes of data, a multiple of 8.
inline std::vector<std::string> ipv4Fragments(const std::string& payload, std::size_t size, unsigned identification) {
    constexpr std::size_t kHeader = 20;
    const std::string whole = ipv4(payload);
    const std::string data = whole.substr(kHeader);
    std::vector<std::string> fragments;
    for (std::size_t at = 0; at < data.size(); at += size) {
        const std::string part = data.substr(at, size);
        const std::uint32_t more = at + size < data.size() ? 0x2000U : 0U;
        std::string header = whole.substr(0, kHeader);
        header.replace(2, 2, big(static_cast<std::uint32_t>(kHeader + part.size()), 2));
        header.replace(4, 2, big(identification, 2));
        header.replace(6, 2, big(more | static_cast<std::uint32_t>(at / 8), 2));
        fragments.push_back(header + part);
    }
    return fragments;
}

inline std::string ethernet(const std::string& ip, bool vlan = false) {
    return std::string(12, '\x11') + (vlan ? big(0x8100, 2) + big(7, 2) : "") + big(0x0800, 2) + ip;
}

inline std::string cooked(const std::string& ip) { return std::string(14, '\0') + big(0x0800, 2) + ip; }

inline std::string payloadOf(const VelodynePacket& packet) {
    return {reinterpret_cast<const char*>(&packet), sizeof(packet)};
}

/// The bytes of a pcap file, frame after frame.
class CaptureFile {
  public:
    static constexpr std::uint32_t kEthernet = 1, kRawIp = 101, kCooked = 113;

    explicit CaptureFile(std::uint32_t link_type = kEthernet, std::uint32_t snaplen = 65535)
        : content_(little(0xa1b2c3d4U, 4) + little(2, 2) + little(4, 2) + little(0, 8) + little(snaplen, 4) +
                   little(link_type, 4)),
          snaplen_(snaplen) {}

    void add(const std::string& frame, double time) {
        const auto seconds = static_cast<std::uint32_t>(time);
        const auto microseconds = static_cast<std::uint32_t>(std::lround((time - seconds) * 1e6));
        const std::string captured = frame.substr(0, snaplen_);
        content_ += little(seconds, 4) + little(microseconds, 4) +
                    little(static_cast<std::uint32_t>(captured.size()), 4) +
                    little(static_cast<std::uint32_t>(frame.size()), 4) + captured;
    }

    /// All packets of a scan over Ethernet, from `time` on.
    void add(const VelodyneScan& scan, double time, std::uint32_t source = 0xc0a801c9U, unsigned port = 2368) {
        const std::uint32_t first = scan.scan_packets.front().gps_timestamp();
        for (const auto& packet : scan.scan_packets)
            add(ethernet(ipv4(payloadOf(packet), port, source)), time + 1e-6 * (packet.gps_timestamp() - first));
    }

    const std::string& content() const { return content_; }

  private:
    std::string content_;
    std::uint32_t snaplen_;
};

}  // namespace lidar_obstacles::test
