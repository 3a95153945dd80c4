#include "mrpt_bridge/input/udp_reader.h"

#include <algorithm>

namespace lidar_obstacles {
namespace {

constexpr std::size_t kPending = 64;

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

std::optional<std::string> UdpReader::join(const Ipv4Packet& fragment) {
    if (fragment.captured < fragment.length) return std::nullopt;  // cut short by the capture: it stays incomplete
    const Key key{fragment.source, fragment.destination, fragment.identification};
    if (std::find(joined_.begin(), joined_.end(), key) != joined_.end()) return std::nullopt;
    const auto [it, is_new] = pending_.try_emplace(key);
    if (is_new) {
        order_.push_back(key);
        if (order_.size() > kPending) {
            pending_.erase(order_.front());
            order_.pop_front();
            ++given_up_;
        }
    }
    auto& parts = it->second;
    parts[fragment.offset].assign(reinterpret_cast<const char*>(fragment.data), fragment.length);
    if (!fragment.more) parts[fragment.offset + fragment.length];
    std::string whole;
    for (const auto& [offset, data] : parts) {
        if (offset != whole.size()) return std::nullopt;
        whole += data;
    }
    if (!parts.rbegin()->second.empty()) return std::nullopt;  // the last one has not come
    pending_.erase(it);
    order_.erase(std::find(order_.begin(), order_.end(), key));
    joined_.push_back(key);
    if (joined_.size() > kPending) joined_.pop_front();
    return whole;
}

}  // namespace lidar_obstacles
