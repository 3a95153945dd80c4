// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// One client of the server. All of it runs on the server's thread.
#pragma once

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/streambuf.hpp>
#include <deque>
#include <memory>
#include <string>

#include "client_server.h"

namespace lidar_obstacles::apps {

class Client;

/// Begins an answer that is no refusal.
inline constexpr const char* kFailed = "the request failed: ";

/// What clients need of their server.
class ClientHost {
  public:
    virtual void subscribed() = 0;  ///< somebody wants something else
    virtual void gone(Client& client, bool cut_off) = 0;
    /// A command or a pose. @return false if it is to be executed later: resume() then.
    /// @throws std::invalid_argument if it may not.
    virtual bool give(Client& client, const Request& request) = 0;
    /// It gives no more commands.
    virtual void ended(Client& client) = 0;
    virtual void countRequest(bool error) = 0;
    /// A request, or what was to be done for a client, failed, which is no fault of the client.
    virtual void failed(const std::string& why) = 0;
    virtual bool hasZones() const = 0;

  protected:
    ~ClientHost() = default;
};

class Client : public std::enable_shared_from_this<Client> {
  public:
    using Socket = boost::asio::generic::stream_protocol::socket;

    Client(Socket socket, ClientHost& host, bool is_local)
        : socket_(std::move(socket)), host_(host), is_local_(is_local) {}

    bool isLocal() const { return is_local_; }
    const Parts& parts() const { return parts_; }

    void start() { read(); }
    /// The parts of it that it wants.
    void send(const std::shared_ptr<const Message>& message);
    /// Answers the command that waited, with an error unless that is empty, and goes on reading.
    void resume(const std::string& error);
    /// Goes once all that waits is sent.
    void finish();

  private:
    /// A line that waits: parts of a message, or a text of its own.
    struct Waiting {
        std::shared_ptr<const Message> message;
        Parts parts;
        std::string text;
    };

    void read();
    void takeLine(const std::string& line);
    void handle(const std::string& line);
    void answer(const std::string& error, const std::string& request);
    void readOn();
    void push(Waiting waiting);
    void write();
    void written();
    void close(bool cut_off);

    Socket socket_;
    ClientHost& host_;
    const bool is_local_;
    Parts parts_ = usualParts();
    boost::asio::streambuf in_{ClientServer::kMaxRequest};
    std::deque<Waiting> out_;
    std::string request_;   ///< that is executed
    bool writing_ = false;  ///< the first of `out_`
    bool paused_ = false;   ///< reading, until answers are sent
    bool ended_ = false;    ///< nothing more comes from it
    bool leaving_ = false;  ///< once all is sent
    bool closed_ = false;
};

}  // namespace lidar_obstacles::apps
