// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Clients of a TCP port or a Unix socket: who asks for what, who is too slow, who may give commands.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/live/packet_source.h"
#include "requests.h"

namespace lidar_obstacles::apps {

/// Whose commands are obeyed.
enum class Commanders : std::uint8_t { Local, All, None };

struct ServeOptions {
    live::Endpoint tcp;
    std::string path;  ///< of a Unix socket, in the place of TCP; empty: TCP
    Commanders commanders = Commanders::Local;
    bool zones = false;  ///< there are some to subscribe to
};

struct ClientCounts {
    std::size_t clients = 0;   ///< that came
    std::size_t cut_off = 0;   ///< as they did not read
    std::size_t refused = 0;   ///< as there were too many
    std::size_t requests = 0;  ///< lines that came
    std::size_t errors = 0;    ///< those of them that were answered with an error
};

/// Serves lines and takes requests on a thread of its own. Memory is bounded whatever clients do: they share the
/// lines, kMaxWaiting of them wait for a client at most (who is cut off then), and no more is read from a client than
/// it reads of the answers.
///
/// Whatever a request throws is answered with an error, and the server goes on.
///
/// Commands (start, stop, set) wait until obey() is called. One client at a time gives commands: the first that does,
/// until it goes.
class ClientServer {
  public:
    static constexpr std::size_t kMaxClients = 256;
    static constexpr std::size_t kMaxWaiting = 16;         ///< lines
    static constexpr std::size_t kMaxRequest = 64 * 1024;  ///< of one line [byte]
    static constexpr std::size_t kMaxPoses = 4096;         ///< that wait; the oldest go
    static constexpr std::size_t kMaxReports = 16;

    /// @throws std::runtime_error naming the endpoint or file if it cannot be bound.
    explicit ClientServer(const ServeOptions& options);
    ~ClientServer();
    ClientServer(const ClientServer&) = delete;
    ClientServer& operator=(const ClientServer&) = delete;

    /// "127.0.0.1:5000", or the path.
    std::string place() const;
    /// The parts that some client wants.
    Parts wanted() const;
    /// To all that want a part of it. Waits for nobody.
    void publish(Message message);
    /// Executes the commands that wait; what `execute` throws is the answer.
    void obey(const std::function<void(const Request&)>& execute);
    /// The poses that came since the last call.
    void takePoses(const std::function<void(const StampedPose&)>& take);
    /// No more clients; those that are there get what waits for them, within half a second.
    void finish();
    ClientCounts counts() const;
    /// What failed since the last call and is no fault of a client, one line each, the first kMaxReports.
    std::vector<std::string> takeReports();

  private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace lidar_obstacles::apps
