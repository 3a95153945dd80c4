// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The UDP datagrams of a capture, also those that came in fragments.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <tuple>
#include <utility>

#include "mrpt_bridge/input/udp_payload.h"

namespace lidar_obstacles {

/// Puts datagrams together that were sent in fragments (links that carry less than 1248 bytes at a time). Memory is
/// bounded: of datagrams that are not whole the newest 64 are held.
class UdpReader {
  public:
    /// @param link_type  libpcap's DLT_ number of the capture.
    explicit UdpReader(int link_type) : link_type_(link_type) {}

    /// The datagram in a frame, or the one that this fragment makes whole; its data are valid until the next call.
    /// @return nullopt for anything else.
    std::optional<UdpPayload> read(const std::uint8_t* frame, std::size_t captured);

    /// What a frame holds that is no UDP over IPv4 (otherContentOf()); "" for one that is.
    std::string otherContent(const std::uint8_t* frame, std::size_t captured) const;

    /// Datagrams of which some fragments are missing, so far.
    std::size_t incomplete() const { return given_up_ + pending_.size(); }

  private:
    using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint16_t>;  ///< source, destination, identification

    using Parts = std::map<std::size_t, std::string>;  ///< data by offset; behind the last: an empty one

    bool isJoined(const Key& key, const Ipv4Packet& fragment) const;
    Parts& partsOf(const Key& key, const Ipv4Packet& fragment);
    std::optional<std::string> join(const Ipv4Packet& fragment);

    int link_type_;
    std::map<Key, Parts> pending_;
    std::deque<Key> order_;                           ///< of pending_, the oldest first
    std::deque<std::pair<Key, std::string>> joined_;  ///< the last ones: what comes twice is not missed
    std::size_t given_up_ = 0;
    std::string whole_;  ///< the datagram that was put together last
};

}  // namespace lidar_obstacles
