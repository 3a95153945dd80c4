// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/udp_reader.h"

#include <algorithm>

namespace lidar_obstacles {
namespace {

constexpr std::size_t kPending = 64;

std::string bytesOf(const Ipv4Packet& fragment) {
    return {reinterpret_cast<const char*>(fragment.data), fragment.length};
}

}  // namespace

std::optional<UdpPayload> UdpReader::read(const std::uint8_t* frame, std::size_t captured) {
    const auto packet = findUdpOverIpv4(link_type_, frame, captured);
    if (!packet) return std::nullopt;
    if (!packet->isFragment()) return findUdpPayload(*packet);
    auto whole = join(*packet);
    if (!whole) return std::nullopt;
    whole_ = std::move(*whole);
    Ipv4Packet joined = *packet;
    joined.data = reinterpret_cast<const std::uint8_t*>(whole_.data());
    joined.captured = joined.length = whole_.size();
    return findUdpPayload(joined);
}

std::string UdpReader::otherContent(const std::uint8_t* frame, std::size_t captured) const {
    return findUdpOverIpv4(link_type_, frame, captured) ? "" : otherContentOf(link_type_, frame, captured);
}

/// True if these bytes are part of the datagram that was put together under that key last: then it came twice.
bool UdpReader::isJoined(const Key& key, const Ipv4Packet& fragment) const {
    return std::any_of(joined_.begin(), joined_.end(), [&](const auto& joined) {
        return joined.first == key && fragment.offset <= joined.second.size() &&
               joined.second.compare(fragment.offset, fragment.length, bytesOf(fragment)) == 0;
    });
}

/// The fragments of a datagram so far. One of other bytes in a place that is taken is of the next datagram: some
/// senders give all of them the same number.
UdpReader::Parts& UdpReader::partsOf(const Key& key, const Ipv4Packet& fragment) {
    const auto [it, is_new] = pending_.try_emplace(key);
    if (is_new) order_.push_back(key);
    const auto place = it->second.find(fragment.offset);
    if (place != it->second.end() && !place->second.empty() && place->second != bytesOf(fragment)) {
        it->second.clear();
        ++given_up_;
    }
    if (order_.size() > kPending) {
        pending_.erase(order_.front());
        order_.pop_front();
        ++given_up_;
    }
    return it->second;
}

std::optional<std::string> UdpReader::join(const Ipv4Packet& fragment) {
    if (fragment.captured < fragment.length) return std::nullopt;  // cut short by the capture: it stays incomplete
    const Key key{fragment.source, fragment.destination, fragment.identification};
    if (isJoined(key, fragment)) return std::nullopt;
    Parts& parts = partsOf(key, fragment);
    parts[fragment.offset] = bytesOf(fragment);
    if (!fragment.more) parts[fragment.offset + fragment.length];
    std::string whole;
    for (const auto& [offset, data] : parts) {
        if (offset != whole.size()) return std::nullopt;
        whole += data;
    }
    if (!parts.rbegin()->second.empty()) return std::nullopt;  // the last one has not come
    pending_.erase(key);
    order_.erase(std::find(order_.begin(), order_.end(), key));
    joined_.emplace_back(key, whole);
    if (joined_.size() > kPending) joined_.pop_front();
    return whole;
}

}  // namespace lidar_obstacles
