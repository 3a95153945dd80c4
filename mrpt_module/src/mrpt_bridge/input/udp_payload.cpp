// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/udp_payload.h"

#include <pcap/dlt.h>

#include <algorithm>
#include <cstdio>

#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"

namespace lidar_obstacles {
namespace {

constexpr std::uint16_t kIpv4 = 0x0800, kIpv6 = 0x86dd;
constexpr std::uint16_t kVlan = 0x8100, kServiceVlan = 0x88a8, kOldServiceVlan = 0x9100;

/// Bytes not looked at yet.
struct Rest {
    const std::uint8_t* data;
    std::size_t size;

    std::uint16_t big16(std::size_t at) const { return static_cast<std::uint16_t>(data[at] << 8U | data[at + 1]); }
    /// False, and nothing skipped, if there are fewer bytes.
    bool skip(std::size_t n) {
        if (n > size) return false;
        data += n;
        size -= n;
        return true;
    }
};

/// Skips a link header of `length` bytes with the protocol number at `type_at`, and any VLAN tags after it.
/// @return the number of the protocol behind it; nullopt if the header is cut off.
std::optional<std::uint16_t> skipTaggedHeader(Rest& rest, std::size_t length, std::size_t type_at) {
    if (rest.size < length) return std::nullopt;
    std::uint16_t type = rest.big16(type_at);
    rest.skip(length);
    while (type == kVlan || type == kServiceVlan || type == kOldServiceVlan) {
        if (rest.size < 4) return std::nullopt;
        type = rest.big16(2);
        rest.skip(4);
    }
    return type;
}

/// For a packet without the number of its protocol before it.
std::optional<std::uint16_t> byVersion(const Rest& rest) {
    if (rest.size < 1) return std::nullopt;
    return rest.data[0] >> 4U == 6 ? kIpv6 : kIpv4;
}

std::optional<std::uint16_t> skipLinkHeader(int link_type, Rest& rest) {
    switch (link_type) {
        case DLT_EN10MB:
            return skipTaggedHeader(rest, 14, 12);
        case DLT_LINUX_SLL:
            return skipTaggedHeader(rest, 16, 14);
        case DLT_LINUX_SLL2:
            return skipTaggedHeader(rest, 20, 0);
        case DLT_NULL:
        case DLT_LOOP:
            return rest.skip(4) ? byVersion(rest) : std::nullopt;
        case DLT_RAW:
        case DLT_IPV4:
            return byVersion(rest);
        default:
            return std::nullopt;
    }
}

std::string hexText(std::uint16_t type) {
    char text[8];
    std::snprintf(text, sizeof text, "0x%04x", static_cast<unsigned>(type));
    return text;
}

std::string contentOfIpv6(const Rest& rest) {
    constexpr std::size_t kHeader = 40, kUdpHeader = 8;
    constexpr std::uint8_t kUdp = 17;
    if (rest.size < kHeader + kUdpHeader || rest.data[6] != kUdp) return "IPv6";
    return rest.big16(kHeader + 4) == kUdpHeader + kDataPacketBytes ? kDataOverIpv6 : "IPv6";
}

}  // namespace

bool isKnownLinkType(int link_type) {
    switch (link_type) {
        case DLT_EN10MB:
        case DLT_LINUX_SLL:
        case DLT_LINUX_SLL2:
        case DLT_NULL:
        case DLT_LOOP:
        case DLT_RAW:
        case DLT_IPV4:
            return true;
        default:
            return false;
    }
}

std::optional<Ipv4Packet> findUdpOverIpv4(int link_type, const std::uint8_t* frame, std::size_t captured) {
    constexpr std::uint8_t kUdp = 17;
    Rest rest{frame, captured};
    if (skipLinkHeader(link_type, rest) != kIpv4 || rest.size < 20 || rest.data[0] >> 4U != 4 || rest.data[9] != kUdp)
        return std::nullopt;
    const std::size_t header = 4U * (rest.data[0] & 0x0fU);
    Ipv4Packet packet;
    const std::size_t total = rest.big16(2);
    packet.identification = rest.big16(4);
    packet.more = (rest.big16(6) & 0x2000U) != 0;
    packet.offset = 8U * (rest.big16(6) & 0x1fffU);
    packet.source = static_cast<std::uint32_t>(rest.big16(12)) << 16U | rest.big16(14);
    packet.destination = static_cast<std::uint32_t>(rest.big16(16)) << 16U | rest.big16(18);
    if (header < 20 || !rest.skip(header)) return std::nullopt;
    // The network card of the recording machine may fill the length in later: then it is 0 in the capture.
    packet.length = total >= header ? total - header : rest.size;
    packet.data = rest.data;
    packet.captured = std::min(rest.size, packet.length);  // short frames are filled up
    return packet;
}

std::string otherContentOf(int link_type, const std::uint8_t* frame, std::size_t captured) {
    constexpr std::uint16_t kArp = 0x0806, kPppoe = 0x8864, kMpls = 0x8847;
    Rest rest{frame, captured};
    const auto type = skipLinkHeader(link_type, rest);
    if (!type) return "frames without a whole header";
    switch (*type) {
        case kIpv4:
            return "IPv4 without UDP";
        case kIpv6:
            return contentOfIpv6(rest);
        case kArp:
            return "ARP";
        case kPppoe:
            return "PPPoE";
        case kMpls:
            return "MPLS";
        default:
            return "protocol " + hexText(*type);
    }
}

std::optional<UdpPayload> findUdpPayload(const Ipv4Packet& packet) {
    constexpr std::size_t kUdpHeader = 8;
    Rest rest{packet.data, packet.captured};
    if (rest.size < kUdpHeader || rest.big16(4) < kUdpHeader) return std::nullopt;
    UdpPayload payload;
    payload.source = packet.source;
    payload.destination_port = rest.big16(2);
    payload.length = rest.big16(4) - kUdpHeader;
    rest.skip(kUdpHeader);
    payload.data = rest.data;
    payload.captured = std::min(rest.size, payload.length);
    payload.complete = rest.size >= payload.length;
    return payload;
}

}  // namespace lidar_obstacles
