// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where a sensor's packets come from: the network, or a capture in its place.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "lidar_obstacles/mrpt_bridge/ipv4_address.h"
#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"

namespace lidar_obstacles::live {

/// Seconds since the epoch, as datagrams are stamped with. NTP, GPS or a person may set this clock at any time.
double wallClock();
/// Seconds since some moment, by a clock that is never set: for time that passes.
double steadyClock();

/// A UDP datagram as it came in.
struct Datagram {
    static constexpr std::size_t kCapacity = kDataPacketBytes;

    std::array<std::uint8_t, kCapacity> bytes{};
    std::size_t length = 0;    ///< as it was sent; `bytes` holds the first kCapacity of a longer one
    std::uint32_t sender = 0;  ///< IPv4 address, first byte highest
    double time = 0.0;         ///< of the packet, seconds since the epoch: its arrival, or what the capture says
    double steady_time = 0.0;  ///< the same by a clock that is never set: `arrival`, or what the capture says [s]
    double arrival = 0.0;      ///< when it reached this machine (from a capture: was read), by steadyClock() [s]
};

/// Datagrams in the order they came.
/// An object is for one thread at a time.
class PacketSource {
  public:
    using Take = std::function<void(const Datagram&)>;

    virtual ~PacketSource() = default;

    /// Waits for datagrams up to `timeout` [s] and hands over those that are there, a few at most.
    /// @throws std::runtime_error if the source broke down.
    virtual void receive(double timeout, const Take& take) = 0;
    /// True once nothing will come any more.
    virtual bool ended() const = 0;
    /// Why it ended before its time; empty if it did not.
    virtual std::string damage() const { return ""; }
    /// Datagrams that the system threw away because they were not fetched in time.
    virtual std::size_t overflows() const { return 0; }
};

/// An IPv4 address and a port.
struct Endpoint {
    std::uint32_t address = 0x7f000001U;  ///< first byte highest
    std::uint16_t port = 2368;
};

/// "192.168.1.77:2368", "192.168.1.77" or ":2368"; what is missing is taken from `usual`.
/// @throws std::invalid_argument if it is none of these.
Endpoint parseEndpoint(const std::string& text, const Endpoint& usual);
using lidar_obstacles::addressText;
using lidar_obstacles::parseAddress;
std::string toString(const Endpoint& endpoint);

}  // namespace lidar_obstacles::live
