// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A sensor's packets from the network.
#pragma once

#include <memory>

#include "lidar_obstacles/live/packet_source.h"

namespace lidar_obstacles::live {

/// One moment by both clocks [s].
struct BothClocks {
    double wall = 0.0;
    double steady = 0.0;
};
/// Now, to a tenth of a millisecond unless the machine is busier than that.
BothClocks bothClocks();

/// When datagrams arrived by steadyClock(): the kernel stamps them by wallClock(), which may be set while they wait.
class SteadyArrivals {
  public:
    /// @param opened  by steadyClock(), before the first of them.
    explicit SteadyArrivals(double opened) : last_(opened) {}

    /// @param stamp  of the next datagram, by wallClock(). @return its arrival, no later than `now` and no earlier than
    ///     that of the one before, whatever became of the clock.
    double next(double stamp, const BothClocks& now);

  private:
    double last_;
    double offset_ = 0.0;  ///< from wallClock() to steadyClock()
};

/// Receives UDP over IPv4, many datagrams per system call, stamped by the kernel.
///
/// Memory is constant: what is not fetched in time is thrown away by the kernel and counted. Bound to an address,
/// only what was sent to that address arrives: a sensor that broadcasts, as Velodynes do out of the box, is heard at
/// 0.0.0.0 (all interfaces) or 255.255.255.255 only.
/// An object is for one thread at a time.
class UdpSource : public PacketSource {
  public:
    /// @param local  port 0: any free one, see endpoint().
    /// @throws std::runtime_error naming the endpoint if it cannot be bound.
    explicit UdpSource(const Endpoint& local);
    ~UdpSource() override;

    void receive(double timeout, const Take& take) override;
    bool ended() const override { return false; }
    std::size_t overflows() const override { return overflows_; }

    /// Where it listens.
    Endpoint endpoint() const { return local_; }
    /// What the system granted for datagrams that wait [byte].
    int bufferSize() const { return buffer_size_; }

  private:
    struct Batch;

    void takeBatch(int count, const Take& take);

    Endpoint local_;
    int socket_ = -1;
    int buffer_size_ = 0;
    std::size_t overflows_ = 0;
    SteadyArrivals arrivals_;
    std::unique_ptr<Batch> batch_;
};

}  // namespace lidar_obstacles::live
