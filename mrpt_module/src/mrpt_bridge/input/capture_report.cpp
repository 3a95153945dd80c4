// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/capture_report.h"

#include <algorithm>
#include <cstdio>

#include "lidar_obstacles/mrpt_bridge/ipv4_address.h"
#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"

namespace lidar_obstacles {
namespace {

using Packet = mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket;

constexpr std::size_t kMostKinds = 64;  // of ports, senders or lengths that are told apart

/// Counts one, unless there are too many keys already.
template <class Map, class Key>
void count(Map& map, const Key& key) {
    if (map.size() < kMostKinds || map.count(key) != 0) ++map[key];
}

void append(std::string& text, const std::string& more) { text += (text.empty() ? "" : "; ") + more; }

/// "3 packets" + what follows.
std::string packets(std::size_t n, const std::string& what) { return std::to_string(n) + " packets " + what; }

/// What the packet says of its sensor.
std::string kindText(const Packet& packet) {
    if (hasLowerLasers(packet)) return "of a sensor with more than 32 lasers (HDL-64E, VLS-128), which is not decoded,";
    char id[8];
    std::snprintf(id, sizeof id, "0x%02x", static_cast<unsigned>(packet.velodyne_model_ID));
    const VelodyneKind* kind = velodyneKind(packet.velodyne_model_ID);
    if (kind) return std::string("of model ") + id + " (" + kind->name + "), which is not decoded,";
    return std::string("of unknown model ") + id + " (--sensor-model says what it is: " + velodyneWords() + ")";
}

template <class Map, class ToText>
std::string listText(const Map& map, const ToText& toText) {
    std::string list;
    for (const auto& [key, n] : map) list += (list.empty() ? "" : ", ") + toText(key) + ": " + std::to_string(n);
    return list;
}

}  // namespace

void CaptureReport::addCutShort(std::size_t frame) {
    ++cut_short_;
    longest_frame_ = std::max(longest_frame_, frame);
}

void CaptureReport::addUndecoded(const Packet& packet) { ++undecoded_[kindText(packet)]; }

void CaptureReport::addUnwanted(const UdpPayload& datagram, bool wrong_port) {
    if (wrong_port)
        count(ports_, datagram.destination_port);
    else
        count(senders_, datagram.source);
}

void CaptureReport::addOther(const UdpPayload& datagram) {
    count(others_, std::pair(datagram.destination_port, datagram.length));
}

void CaptureReport::addFrame(const std::string& content) {
    constexpr std::size_t kMostKinds = 16;
    if (!content.empty() && (frames_.size() < kMostKinds || frames_.count(content) != 0)) ++frames_[content];
}

std::string CaptureReport::othersText() const {
    const auto most = std::max_element(others_.begin(), others_.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    if (most == others_.end())
        return "no UDP datagrams over IPv4 in it" +
               (frames_.empty() ? "" : " (but " + listText(frames_, [](const std::string& content) {
                                           return content;
                                       }) + ")");
    return "no data packets of a Velodyne in it; most datagrams are " + std::to_string(most->first.second) +
           " bytes to port " + std::to_string(most->first.first) + " (" + std::to_string(most->second) + " of them)";
}

std::string CaptureReport::text(std::size_t scans, std::size_t incomplete) const {
    std::string text;
    if (cut_short_ != 0)
        append(text,
               packets(cut_short_, "cut short by the capture left out (it holds " + std::to_string(longest_frame_) +
                                       " bytes of each at most: capture with tcpdump -s 0)"));
    for (const auto& [kind, n] : undecoded_) append(text, packets(n, kind + " left out"));
    const auto over_ipv6 = frames_.find(kDataOverIpv6);
    if (over_ipv6 != frames_.end()) append(text, packets(over_ipv6->second, "over IPv6 left out: only IPv4 is read"));
    if (!ports_.empty())
        append(text,
               "packets to other ports left out (" + listText(ports_, [](auto p) { return std::to_string(p); }) + ")");
    if (!senders_.empty()) append(text, "packets of other senders left out (" + listText(senders_, addressText) + ")");
    if (duplicates_ != 0) append(text, packets(duplicates_, "that came twice left out"));
    if (incomplete != 0)
        append(text, std::to_string(incomplete) + " datagrams that lack some of their fragments left out");
    if (crowd_ != 0) append(text, packets(crowd_, "of the 65th sensor and more left out"));
    if (unfinished_ != 0)
        append(text, packets(unfinished_, "of the turn that the end of the capture cuts off left out"));
    if (scans == 0 && text.empty()) return othersText();
    return text;
}

}  // namespace lidar_obstacles
