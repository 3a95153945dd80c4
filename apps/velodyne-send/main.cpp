// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// velodyne-send: a recording in the place of a sensor on the network.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "common/interrupt.h"
#include "common/run_app.h"
#include "options.h"
#include "turn_loop.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;

sockaddr_in toAddress(std::uint32_t address, std::uint16_t port) {
    sockaddr_in a{};
    a.sin_family = AF_INET;
    a.sin_port = htons(port);
    a.sin_addr.s_addr = htonl(address);
    return a;
}

class Sender {
  public:
    explicit Sender(const Options& options)
        : options_(options), to_(toAddress(options.to.address, options.to.port)), random_(options.seed) {
        socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
        const int on = 1;
        setsockopt(socket_, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
        if (!options.from) return;
        const sockaddr_in from = toAddress(*options.from, 0);
        if (bind(socket_, reinterpret_cast<const sockaddr*>(&from), sizeof from) != 0)
            throw std::runtime_error("cannot send from " + live::addressText(*options.from) + ": " +
                                     std::strerror(errno));
    }
    ~Sender() { ::close(socket_); }
    Sender(const Sender&) = delete;
    Sender& operator=(const Sender&) = delete;

    void run(const TurnLoop& loop) {
        constexpr std::size_t kClean = 10;  // packets at either end
        const auto packets = static_cast<std::size_t>(std::lround(options_.duration / loop.period()));
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t k = 0; k < packets && !isInterrupted(); ++k) {
            const std::chrono::duration<double> due(loop.period() * static_cast<double>(k));
            std::this_thread::sleep_until(start + due);
            const bool clean = k < kClean || k + kClean >= packets || !options_.faults.any();
            clean ? sendInOrder(loop.at(k)) : sendFaulty(loop.at(k));
        }
        seconds_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    }

    void print() const {
        std::printf(
            "{\"packets\":%zu,\"dropped\":%zu,\"duplicated\":%zu,\"reordered\":%zu,\"garbage\":%zu,\"seconds\":%.3f}\n",
            packets_, dropped_, duplicated_, reordered_, garbage_, seconds_);
    }

  private:
    struct Held {
        Packet packet;
        int sends;  ///< of other packets before its turn comes
    };

    void send(const void* data, std::size_t size) {
        // On loopback nobody listening is an error of the next call: no reason to end.
        const auto* to = reinterpret_cast<const sockaddr*>(&to_);
        if (::sendto(socket_, data, size, 0, to, sizeof to_) < 0 && errno != ECONNREFUSED)
            throw std::runtime_error("cannot send to " + toString(options_.to) + ": " + std::strerror(errno));
    }

    void sendInOrder(const Packet& packet) {
        send(&packet, sizeof packet);
        ++packets_;
        for (Held& held : held_) --held.sends;
        while (!held_.empty() && held_.front().sends <= 0) {
            send(&held_.front().packet, sizeof(Packet));
            held_.erase(held_.begin());
        }
    }

    void sendFaulty(const Packet& packet) {
        const Faults& f = options_.faults;
        std::uniform_real_distribution<double> share(0.0, 1.0);
        if (share(random_) < f.garbage) sendGarbage(packet);
        const double u = share(random_);
        if (u < f.drop) {
            ++dropped_;
        } else if (u < f.drop + f.duplicate) {
            sendInOrder(packet);
            send(&packet, sizeof packet);
            ++duplicated_;
        } else if (u < f.drop + f.duplicate + f.reorder) {
            // Never before one that waits already: that one would be in order again.
            const int least = held_.empty() ? 1 : held_.back().sends;
            held_.push_back({packet, std::max(least, std::uniform_int_distribution<int>(1, 4)(random_))});
            ++packets_;
            ++reordered_;
        } else {
            sendInOrder(packet);
        }
    }

    /// Random bytes of any length, random bytes of a packet's length, or a packet with a broken block.
    void sendGarbage(const Packet& packet) {
        std::vector<std::uint8_t> bytes(1472);
        for (std::uint8_t& b : bytes) b = static_cast<std::uint8_t>(random_());
        std::size_t size = sizeof(Packet);
        if (random_() % 3 == 0) {
            size = random_() % sizeof(Packet);
        } else if (random_() % 2 == 0) {
            std::memcpy(bytes.data(), &packet, sizeof packet);
            bytes[100 * (random_() % 12)] ^= 0x10U;
        }
        send(bytes.data(), size);
        ++garbage_;
    }

    const Options& options_;
    sockaddr_in to_;
    std::mt19937_64 random_;
    int socket_ = -1;
    std::vector<Held> held_;
    std::size_t packets_ = 0, dropped_ = 0, duplicated_ = 0, reordered_ = 0, garbage_ = 0;
    double seconds_ = 0.0;
};

}  // namespace

int main(int argc, char** argv) {
    return runApp("velodyne-send", [&] {
        const auto options = parseOptions(argc, argv);
        if (!options) return 0;
        const TurnLoop loop(options->input, options->dual);
        Sender sender(*options);
        catchInterrupts();
        sender.run(loop);
        sender.print();
        if (!loop.remarks().empty()) std::fprintf(stderr, "velodyne-send: %s\n", loop.remarks().c_str());
        if (!loop.damage().empty() && !isInterrupted()) throw std::runtime_error(loop.damage());
        return isInterrupted() ? kInterruptedCode : 0;
    });
}
