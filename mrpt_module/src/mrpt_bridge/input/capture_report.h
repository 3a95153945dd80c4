// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What of a capture did not become scans.
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "mrpt_bridge/input/udp_payload.h"

namespace lidar_obstacles {

/// Counts what is left out, and says so in one line.
class CaptureReport {
  public:
    /// A data packet of which the capture holds the first bytes only. @param frame  bytes of its frame that it holds.
    void addCutShort(std::size_t frame);
    /// A data packet of a sensor that is not decoded.
    void addUndecoded(const mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket& packet);
    void addDuplicate() { ++duplicates_; }
    /// A data packet to a port, or of a sender, that was not asked for.
    void addUnwanted(const UdpPayload& datagram, bool wrong_port);
    /// A datagram that is no data packet.
    void addOther(const UdpPayload& datagram);
    /// A frame without UDP over IPv4. @param content  of it (UdpReader::otherContent); "" for one that has.
    void addFrame(const std::string& content);
    /// A data packet of one sensor too many.
    void addCrowd() { ++crowd_; }
    /// Packets of a turn that the end of the capture cuts off.
    void addUnfinished(std::size_t packets) { unfinished_ += packets; }

    /// @param scans       delivered: if there were none, it also says what the capture holds instead.
    /// @param incomplete  datagrams that lack some of their fragments.
    std::string text(std::size_t scans, std::size_t incomplete) const;

  private:
    std::string othersText() const;

    std::size_t cut_short_ = 0;
    std::size_t longest_frame_ = 0;  ///< of those that were cut short [byte]
    std::size_t duplicates_ = 0;
    std::size_t crowd_ = 0;
    std::size_t unfinished_ = 0;
    std::map<std::string, std::size_t> undecoded_;  ///< by the sensor's kind
    std::map<std::string, std::size_t> frames_;     ///< without UDP over IPv4, by their content
    std::map<std::uint16_t, std::size_t> ports_;
    std::map<std::uint32_t, std::size_t> senders_;
    std::map<std::pair<std::uint16_t, std::size_t>, std::size_t> others_;  ///< by port and length
};

}  // namespace lidar_obstacles
