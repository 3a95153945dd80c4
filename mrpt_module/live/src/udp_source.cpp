// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/live/udp_source.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>
#include <limits>
#include <stdexcept>

namespace lidar_obstacles::live {
namespace {

constexpr std::size_t kBatch = 64;
constexpr int kBuffer = 8 << 20;  // [byte]: 2 s of the fastest sensor

[[noreturn]] void fail(const Endpoint& local, const std::string& what, int reason) {
    throw std::runtime_error("UDP " + toString(local) + ": " + what + ": " + std::strerror(reason));
}

/// What the kernel says about a datagram beside its content.
struct Ancillary {
    double time = -1.0;  ///< of its arrival; negative if it does not say
    std::uint32_t overflows = 0;
    bool has_overflows = false;
};

Ancillary readAncillary(msghdr& header) {
    Ancillary a;
    for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c)) {
        if (c->cmsg_level != SOL_SOCKET) continue;
        if (c->cmsg_type == SCM_TIMESTAMPNS) {
            timespec t{};
            std::memcpy(&t, CMSG_DATA(c), sizeof t);
            a.time = static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
        } else if (c->cmsg_type == SO_RXQ_OVFL) {
            std::memcpy(&a.overflows, CMSG_DATA(c), sizeof a.overflows);
            a.has_overflows = true;
        }
    }
    return a;
}

}  // namespace

BothClocks bothClocks() {
    constexpr double kNarrow = 1e-4;  // [s]
    constexpr int kMost = 5;
    BothClocks now;
    double narrowest = std::numeric_limits<double>::infinity();
    for (int k = 0; k < kMost && narrowest > kNarrow; ++k) {  // the thread may have to wait between two readings
        const double before = steadyClock(), wall = wallClock(), after = steadyClock();
        if (after - before >= narrowest) continue;
        narrowest = after - before;
        now = {wall, after};
    }
    return now;
}

double SteadyArrivals::next(double stamp, const BothClocks& now) {
    constexpr double kSet = 1e-3;  // [s] less is how exactly both are read
    const double offset = now.steady - now.wall;
    if (std::abs(offset - offset_) > kSet) offset_ = offset;
    last_ = std::clamp(stamp + offset_, std::min(last_, now.steady), now.steady);
    return last_;
}

/// Room for the datagrams of one system call.
struct UdpSource::Batch {
    std::array<Datagram, kBatch> datagrams;
    std::array<mmsghdr, kBatch> headers{};
    std::array<iovec, kBatch> buffers{};
    std::array<sockaddr_in, kBatch> senders{};
    std::array<std::array<std::uint8_t, 128>, kBatch> controls{};

    void prepare() {
        for (std::size_t i = 0; i < kBatch; ++i) {
            buffers[i] = {datagrams[i].bytes.data(), Datagram::kCapacity};
            msghdr& h = headers[i].msg_hdr;
            h = {};
            h.msg_name = &senders[i];
            h.msg_namelen = sizeof senders[i];
            h.msg_iov = &buffers[i];
            h.msg_iovlen = 1;
            h.msg_control = controls[i].data();
            h.msg_controllen = controls[i].size();
        }
    }
};

UdpSource::UdpSource(const Endpoint& local)
    : local_(local), arrivals_(steadyClock()), batch_(std::make_unique<Batch>()) {
    socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket_ < 0) fail(local, "cannot make a socket", errno);
    const int on = 1;
    // The first is for root only, the second is cut down to net.core.rmem_max.
    if (setsockopt(socket_, SOL_SOCKET, SO_RCVBUFFORCE, &kBuffer, sizeof kBuffer) != 0)
        setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &kBuffer, sizeof kBuffer);
    setsockopt(socket_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
    setsockopt(socket_, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
    socklen_t size = sizeof buffer_size_;
    getsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &buffer_size_, &size);

    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(local.port);
    address.sin_addr.s_addr = htonl(local.address);
    socklen_t length = sizeof address;
    if (bind(socket_, reinterpret_cast<sockaddr*>(&address), length) != 0 ||
        getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
        const int reason = errno;
        ::close(socket_);
        fail(local, "cannot listen", reason);
    }
    local_.port = ntohs(address.sin_port);
}

UdpSource::~UdpSource() { ::close(socket_); }

void UdpSource::receive(double timeout, const Take& take) {
    pollfd ready{socket_, POLLIN, 0};
    const int result = poll(&ready, 1, static_cast<int>(timeout * 1e3));
    if (result < 0 && errno != EINTR) fail(local_, "cannot wait for data", errno);
    if (result <= 0) return;
    batch_->prepare();
    // With MSG_TRUNC the length is that of the datagram as it was sent.
    const int count = recvmmsg(socket_, batch_->headers.data(), kBatch, MSG_DONTWAIT | MSG_TRUNC, nullptr);
    if (count < 0) {
        if (errno == EAGAIN || errno == EINTR || errno == ECONNREFUSED) return;
        fail(local_, "cannot receive", errno);
    }
    takeBatch(count, take);
}

void UdpSource::takeBatch(int count, const Take& take) {
    const BothClocks now = bothClocks();
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
        Datagram& datagram = batch_->datagrams[i];
        const Ancillary ancillary = readAncillary(batch_->headers[i].msg_hdr);
        datagram.length = batch_->headers[i].msg_len;
        datagram.sender = ntohl(batch_->senders[i].sin_addr.s_addr);
        datagram.time = ancillary.time >= 0.0 ? ancillary.time : now.wall;
        datagram.steady_time = datagram.arrival = arrivals_.next(datagram.time, now);
        if (ancillary.has_overflows) overflows_ = ancillary.overflows;
        take(datagram);
    }
}

}  // namespace lidar_obstacles::live
