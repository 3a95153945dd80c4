// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A capture in the place of the network.
#pragma once

#include <memory>
#include <string>

#include "lidar_obstacles/live/packet_source.h"

namespace lidar_obstacles {
class CaptureDatagrams;
}

namespace lidar_obstacles::live {

enum class Pace : std::uint8_t {
    Real,    ///< as far apart as they were captured
    Maximum  ///< as fast as they are taken
};

/// Hands over the datagrams to one UDP port out of a capture (formats: see PcapReader).
/// An object is for one thread at a time.
class PcapSource : public PacketSource {
  public:
    /// @param port  0: that of the first datagram which is as long as a data packet.
    /// @throws std::runtime_error naming the file if it cannot be opened or is no capture that can be read.
    PcapSource(const std::string& path, Pace pace, std::uint16_t port = 0);
    ~PcapSource() override;

    void receive(double timeout, const Take& take) override;
    bool ended() const override { return ended_; }
    std::string damage() const override { return damage_; }

  private:
    bool readDatagram();
    bool waitUntilDue(double timeout);

    Pace pace_;
    std::uint16_t port_;
    std::unique_ptr<CaptureDatagrams> capture_;
    Datagram next_;
    bool has_next_ = false;
    bool ended_ = false;
    double start_ = -1.0;      ///< steadyClock() at the first packet
    double first_time_ = 0.0;  ///< of the first packet
    std::string damage_;
};

}  // namespace lidar_obstacles::live
