/// @file
/// Where the lines go: the standard output, and the clients of a TCP port.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/live/packet_source.h"

namespace lidar_obstacles::apps {

/// Serves lines to any number (16 at most) of TCP clients, who need not say anything. Nobody is waited for: a client
/// that does not read until the system's buffer is full is cut off.
class LineServer {
  public:
    /// @throws std::runtime_error naming the endpoint if it cannot be bound.
    explicit LineServer(const live::Endpoint& local);
    ~LineServer();
    LineServer(const LineServer&) = delete;
    LineServer& operator=(const LineServer&) = delete;

    /// Takes in new clients and sends all of them the line.
    void send(const std::string& line);

    live::Endpoint endpoint() const { return local_; }
    std::size_t clients() const { return clients_.size(); }
    /// Clients that were cut off as they were too slow.
    std::size_t cutOff() const { return cut_off_; }

  private:
    void accept();

    live::Endpoint local_;
    int socket_ = -1;
    std::vector<int> clients_;
    std::size_t cut_off_ = 0;
};

/// Writes all of it to the standard output, at once; waits for a slow reader.
/// @return false if `stop` was set while it waited.
/// @throws std::runtime_error if it cannot be written, e.g. as nobody reads any more.
bool writeToStdout(const std::string& line, const std::atomic<bool>& stop);

}  // namespace lidar_obstacles::apps
