// SPDX-License-Identifier: BSD-3-Clause
// A client of obstacle-live --serve.
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "lidar_obstacles/live/packet_source.h"

namespace lidar_obstacles::test {

class LineClient {
  public:
    /// @param place  "ADDRESS:PORT" or a path. @param receive_buffer  in the kernel [byte]; 0: as usual.
    explicit LineClient(const std::string& place, int receive_buffer = 0) {
        const bool is_path = place.find('/') != std::string::npos;
        socket_ = ::socket(is_path ? AF_UNIX : AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        if (receive_buffer > 0) setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        const timeval patience{20, 0};
        setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        connected_ = is_path ? connectTo(place) : connectTo(live::parseEndpoint(place, {}));
    }
    ~LineClient() { ::close(socket_); }
    LineClient(const LineClient&) = delete;
    LineClient& operator=(const LineClient&) = delete;

    bool isConnected() const { return connected_; }
    void send(const std::string& text) const { ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL); }
    void sayNoMore() const { ::shutdown(socket_, SHUT_WR); }

    /// The next line; nullopt at the end, or after 20 s without one.
    std::optional<std::string> line() {
        for (;;) {
            const auto end = got_.find('\n');
            if (end != std::string::npos) {
                std::string line = got_.substr(0, end);
                got_.erase(0, end + 1);
                return line;
            }
            char buffer[65536];
            const ssize_t n = ::recv(socket_, buffer, sizeof buffer, 0);
            if (n <= 0) return std::nullopt;
            got_.append(buffer, static_cast<std::size_t>(n));
        }
    }
    /// The next line with this key; null at the end.
    nlohmann::json next(const std::string& key) {
        while (const auto text = line()) {
            auto json = nlohmann::json::parse(*text);
            if (json.contains(key)) return json;
        }
        return nullptr;
    }
    /// What a request is answered: the text of the error, "" for ok, "gone" without an answer.
    std::string ask(const std::string& request) {
        send(request + "\n");
        while (const auto text = line()) {
            const auto json = nlohmann::json::parse(*text);
            if (json.contains("error")) return json["error"];
            if (json.contains("ok")) return "";
        }
        return "gone";
    }

  private:
    bool connectTo(const live::Endpoint& endpoint) const {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(endpoint.port);
        to.sin_addr.s_addr = htonl(endpoint.address);
        return ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
    }
    bool connectTo(const std::string& path) const {
        sockaddr_un to{};
        to.sun_family = AF_UNIX;
        path.copy(to.sun_path, sizeof to.sun_path - 1);
        return ::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) == 0;
    }

    int socket_ = -1;
    bool connected_ = false;
    std::string got_;
};

}  // namespace lidar_obstacles::test
