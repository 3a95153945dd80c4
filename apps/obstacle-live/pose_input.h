// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Poses of the vehicle from the network: one line of JSON each.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "lidar_obstacles/live/udp_source.h"
#include "lidar_obstacles/motion.h"

namespace lidar_obstacles::apps {

/// {"timestamp": s, "x": m, "y": m, "yaw": rad}, and "z", "pitch", "roll", which are 0 where they are missing.
/// @throws std::invalid_argument saying what is wrong with the line.
StampedPose parsePoseLine(const std::string& line);
/// The same where the line has been read. @throws as parsePoseLine().
StampedPose parsePose(const nlohmann::json& json);

/// UDP datagrams with one line or several. Nothing is waited for.
class PoseInput {
  public:
    using Sink = std::function<void(const StampedPose&)>;

    /// @throws std::runtime_error naming the endpoint if it cannot be bound.
    explicit PoseInput(const live::Endpoint& local) : udp_(local) {}

    /// Hands over the poses that have come since the last call. @throws std::runtime_error if the socket broke down.
    void fetch(const Sink& sink);

    live::Endpoint endpoint() const { return udp_.endpoint(); }
    std::size_t taken() const { return taken_; }
    /// Lines that are no pose, and what was wrong with the first one.
    std::size_t refused() const { return refused_; }
    const std::string& whyRefused() const { return why_refused_; }

  private:
    void takeLines(const live::Datagram& datagram, const Sink& sink);
    void refuse(const std::string& why);

    live::UdpSource udp_;
    std::size_t taken_ = 0;
    std::size_t refused_ = 0;
    std::string why_refused_;
};

}  // namespace lidar_obstacles::apps
