// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A VLP-16 at 10 Hz whose packets the test sends one by one.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <vector>

#include "lidar_obstacles/live/scan_stream.h"
#include "support/velodyne_packets.h"

namespace lidar_obstacles::live {

using namespace test;

inline constexpr std::uint32_t kSensor = 0xc0a801c9U;
inline constexpr double kPeriod = 12 * 110.592e-6;  // VLP-16, single return

inline Datagram datagramOf(const VelodynePacket& packet, double time, std::uint32_t sender = kSensor) {
    Datagram d;
    std::memcpy(d.bytes.data(), &packet, sizeof packet);
    d.length = sizeof packet;
    d.sender = sender;
    d.time = d.steady_time = d.arrival = time;
    return d;
}

inline void setClock(VelodynePacket& packet, double us) {
    const auto clock = static_cast<std::uint32_t>(std::fmod(us, 3600e6));
    std::memcpy(bytes(packet) + 1200, &clock, 4);
}

/// Packet k of a sensor that turns at 10 Hz, its clock running on.
inline VelodynePacket packetNumber(int k, std::uint8_t mode = 0x37, double period = kPeriod) {
    VelodynePacket packet = emptyPacket(0, 0x22, mode);
    const int stride = mode == 0x39 ? 2 : 1;
    for (int b = 0; b < 12; ++b) setBlock(packet, b, static_cast<unsigned>(40 * (12 / stride * k + b / stride)));
    setClock(packet, 1e6 * period * k);
    return packet;
}

class Stream : public testing::Test {
  protected:
    void add(const Datagram& datagram) {
        if (auto scan = stream_.add(datagram)) scans_.push_back(*scan);
    }
    /// Packets from..to-1, one period apart.
    void addPackets(int from, int to) {
        for (int k = from; k < to; ++k) add(datagramOf(packetNumber(k), at(k)));
    }
    double at(int k) const { return 5000.0 + kPeriod * k; }
    const StreamCounts& counts() const { return stream_.counts(); }
    std::size_t packetsOf(std::size_t scan) const { return scans_.at(scan).observation->scan_packets.size(); }
    unsigned firstAzimuth(std::size_t scan) const {
        return scans_.at(scan).observation->scan_packets.front().blocks[0].rotation();
    }

    StreamOptions options_;
    ScanStream stream_{options_};
    std::vector<LiveScan> scans_;
};

}  // namespace lidar_obstacles::live
