// SPDX-License-Identifier: BSD-3-Clause
// obstacle-live on a network where others send as well, ten times as much as the sensor.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "lidar_obstacles/live/packet_source.h"
#include "support/live_program.h"
#include "velodyne-send/turn_loop.h"

namespace lidar_obstacles::test {
namespace {

using apps::Packet;
using apps::TurnLoop;

/// A socket that sends from an address of this machine.
class Sender {
  public:
    Sender(const char* from, const std::string& to) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
        sockaddr_in local{};
        local.sin_family = AF_INET;
        inet_pton(AF_INET, from, &local.sin_addr);
        EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&local), sizeof local), 0);
        const live::Endpoint endpoint = live::parseEndpoint(to, {});
        to_.sin_family = AF_INET;
        to_.sin_port = htons(endpoint.port);
        to_.sin_addr.s_addr = htonl(endpoint.address);
    }
    ~Sender() { ::close(socket_); }
    Sender(const Sender&) = delete;
    Sender& operator=(const Sender&) = delete;

    void send(const void* data, std::size_t size) const {
        EXPECT_EQ(::sendto(socket_, data, size, 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_),
                  static_cast<ssize_t>(size));
    }
    void send(const Packet& packet) const { send(&packet, sizeof packet); }

  private:
    int socket_;
    sockaddr_in to_{};
};

/// The packet with another clock [us].
Packet withClock(Packet packet, std::uint32_t clock) {
    std::memcpy(reinterpret_cast<std::uint8_t*>(&packet) + 1200, &clock, sizeof clock);
    return packet;
}

TEST_F(Live, HostileTrafficAtTenTimesTheRateIsCountedAndCostsNoPacket) {
    constexpr std::size_t kGood = 3 * 1508;  // three seconds of dual return
    auto live = startListening({"--source", "127.0.0.1", "--to", "none"});
    const TurnLoop loop(kStreet, true);
    const Sender sensor("127.0.0.1", endpoint_), foreign("127.0.0.2", endpoint_);
    const std::string nothing, large(9000, 'x');
    const auto start = std::chrono::steady_clock::now();
    long resident = 0;
    for (std::size_t k = 0; k < kGood; ++k) {
        if (k == kGood / 3) resident = live->residentKb();
        std::this_thread::sleep_until(start + std::chrono::duration<double>(loop.period() * static_cast<double>(k)));
        const Packet packet = loop.at(k);
        sensor.send(packet);
        foreign.send(packet);
        foreign.send(large.data(), large.size());
        foreign.send(nothing.data(), 0);
        sensor.send(large.data(), large.size());  // from the sensor's own address
        sensor.send(nothing.data(), 0);
        sensor.send(withClock(loop.at(k), packet.gps_timestamp() + 1'000'000'000U));  // a sensor beside it
        sensor.send(withClock(loop.at(7 * k), static_cast<std::uint32_t>(2'000'000'000U + 1000U * k)));
        sensor.send(loop.at(k > 100 ? k - 100 : k));    // 0.07 s ago
        sensor.send(loop.at(k > 1000 ? k - 1000 : k));  // 0.7 s ago
        sensor.send(loop.at(k > 3000 ? k - 3000 : k));  // 2 s ago
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_LT(live->residentKb() - resident, 20 * 1024) << "kB in two seconds";
    live->interrupt();
    ASSERT_EQ(live->wait(), 0) << err();
    const Json s = statistics();
    if (s["overflows"] > 0) GTEST_SKIP() << "the kernel's buffer was too small: " << s["overflows"] << " datagrams";
    EXPECT_EQ(s["datagrams"], 11 * kGood);
    EXPECT_EQ(s["packets"], kGood) << "every good one, and no other";
    EXPECT_EQ(s["foreign"].get<std::size_t>() + s["malformed"].get<std::size_t>(), 5 * kGood);
    EXPECT_EQ(s["duplicates"].get<std::size_t>() + s["unclear"].get<std::size_t>(), 5 * kGood);
    EXPECT_GE(s["unclear"], 2 * kGood);
    for (const char* fault : {"lost", "late", "mode_changes", "restarts", "outages"}) EXPECT_EQ(s[fault], 0) << fault;
    EXPECT_EQ(s["scans"], 31) << "a turn begins and ends within";
    EXPECT_EQ(s["detected"].get<int>() + s["scans_dropped"].get<int>(), s["scans"].get<int>());
}

}  // namespace
}  // namespace lidar_obstacles::test
