#include "line_output.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace lidar_obstacles::apps {
namespace {

constexpr std::size_t kMaxClients = 16;

[[noreturn]] void fail(const live::Endpoint& local, int reason) {
    throw std::runtime_error("TCP " + toString(local) + ": cannot listen: " + std::strerror(reason));
}

}  // namespace

LineServer::LineServer(const live::Endpoint& local) : local_(local) {
    socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket_ < 0) fail(local, errno);
    const int on = 1;
    setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(local.port);
    address.sin_addr.s_addr = htonl(local.address);
    socklen_t length = sizeof address;
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    if (bind(socket_, generic, length) != 0 || listen(socket_, 8) != 0 || getsockname(socket_, generic, &length) != 0) {
        const int reason = errno;
        ::close(socket_);
        fail(local, reason);
    }
    local_.port = ntohs(address.sin_port);
}

LineServer::~LineServer() {
    for (const int client : clients_) ::close(client);
    ::close(socket_);
}

void LineServer::accept() {
    for (;;) {
        const int client = ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
        if (client < 0) return;
        if (clients_.size() < kMaxClients)
            clients_.push_back(client);
        else
            ::close(client);
    }
}

void LineServer::send(const std::string& line) {
    accept();
    const auto gone = [&](int client) {
        const ssize_t sent = ::send(client, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (sent == static_cast<ssize_t>(line.size())) return false;
        if (sent >= 0 || errno == EAGAIN) ++cut_off_;  // half a line is of no use to anybody
        ::close(client);
        return true;
    };
    clients_.erase(std::remove_if(clients_.begin(), clients_.end(), gone), clients_.end());
}

bool writeToStdout(const std::string& line, const std::atomic<bool>& stop) {
    for (std::size_t done = 0; done < line.size();) {
        pollfd ready{STDOUT_FILENO, POLLOUT, 0};
        if (poll(&ready, 1, 100) <= 0) {  // a signal, or nobody reads
            if (stop) return false;
            continue;
        }
        // A pipe that can take anything takes PIPE_BUF bytes without waiting.
        const ssize_t n = ::write(STDOUT_FILENO, line.data() + done, std::min<std::size_t>(line.size() - done, 4096));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0)
            throw std::runtime_error(std::string("cannot write to the standard output: ") + std::strerror(errno));
        done += static_cast<std::size_t>(n);
    }
    return true;
}

}  // namespace lidar_obstacles::apps
