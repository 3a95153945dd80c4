// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Finds the UDP payload in a captured frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace lidar_obstacles {

/// A UDP datagram inside a captured frame.
struct UdpPayload {
    const std::uint8_t* data = nullptr;
    std::size_t length = 0;    ///< as the datagram's header tells [byte]
    std::size_t captured = 0;  ///< of them [byte]
    bool complete = false;     ///< false: the capture holds less than `length` bytes
    std::uint32_t source = 0;  ///< IPv4 address, first byte highest
    std::uint16_t destination_port = 0;
};

/// An IPv4 packet inside a captured frame.
struct Ipv4Packet {
    const std::uint8_t* data = nullptr;  ///< behind its header
    std::size_t captured = 0;            ///< of its data [byte]
    std::size_t length = 0;              ///< of its data, as the header tells [byte]
    std::uint32_t source = 0;
    std::uint32_t destination = 0;
    std::uint16_t identification = 0;  ///< of the datagram that it is a fragment of
    std::size_t offset = 0;            ///< in that datagram [byte]
    bool more = false;                 ///< fragments follow

    bool isFragment() const { return more || offset != 0; }
};

/// @param link_type  libpcap's DLT_ number of the capture.
/// @return nullopt if the frame is no UDP over IPv4, or its headers are cut off.
std::optional<Ipv4Packet> findUdpOverIpv4(int link_type, const std::uint8_t* frame, std::size_t captured);

/// The datagram in a packet that is no fragment. @return nullopt if its header is cut off.
std::optional<UdpPayload> findUdpPayload(const Ipv4Packet& packet);

/// What a frame holds in which findUdpOverIpv4() finds nothing, e.g. "IPv6", "PPPoE" or "ARP"; a datagram over IPv6 of
/// the length of a Velodyne's data packets is kDataOverIpv6.
std::string otherContentOf(int link_type, const std::uint8_t* frame, std::size_t captured);
inline constexpr const char* kDataOverIpv6 = "data packets over IPv6";

/// True for the link types findUdpOverIpv4 understands.
bool isKnownLinkType(int link_type);

}  // namespace lidar_obstacles
