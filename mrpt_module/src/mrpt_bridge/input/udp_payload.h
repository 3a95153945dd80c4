/// @file
/// Finds the UDP payload in a captured frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

namespace lidar_obstacles {

/// A UDP datagram inside a captured frame.
struct UdpPayload {
    const std::uint8_t* data = nullptr;
    std::size_t length = 0;    ///< as the datagram's header tells [byte]
    bool complete = false;     ///< false: the capture holds less than `length` bytes
    std::uint32_t source = 0;  ///< IPv4 address, first byte highest
    std::uint16_t destination_port = 0;
};

/// @param link_type  libpcap's DLT_ number of the capture.
/// @return nullopt if the frame is no whole UDP datagram over IPv4 (fragments included) or its headers are cut off.
std::optional<UdpPayload> findUdpPayload(int link_type, const std::uint8_t* frame, std::size_t captured);

/// True for the link types findUdpPayload understands.
bool isKnownLinkType(int link_type);

}  // namespace lidar_obstacles
