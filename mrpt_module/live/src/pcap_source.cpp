// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/live/pcap_source.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>

#include "lidar_obstacles/mrpt_bridge/capture_datagrams.h"

namespace lidar_obstacles::live {

PcapSource::PcapSource(const std::string& path, Pace pace, std::uint16_t port)
    : pace_(pace), port_(port), capture_(std::make_unique<CaptureDatagrams>(path)) {}

PcapSource::~PcapSource() = default;

bool PcapSource::readDatagram() {
    while (const auto datagram = capture_->next()) {
        if (port_ == 0 && datagram->length == Datagram::kCapacity) port_ = datagram->port;
        if (port_ == 0 || datagram->port != port_) continue;
        next_.length = datagram->complete ? datagram->length : 0;  // cut short by the capture: of no use
        next_.sender = datagram->sender;
        next_.time = next_.steady_time = datagram->time;
        if (datagram->complete)
            std::memcpy(next_.bytes.data(), datagram->data, std::min(datagram->length, Datagram::kCapacity));
        return true;
    }
    ended_ = true;
    damage_ = capture_->damage();
    return false;
}

bool PcapSource::waitUntilDue(double timeout) {
    if (pace_ == Pace::Maximum) return true;
    if (start_ < 0.0) {
        start_ = steadyClock();
        first_time_ = next_.time;
    }
    const double wait = next_.time - first_time_ - (steadyClock() - start_);
    if (wait > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(std::min(wait, timeout)));
    return wait <= timeout;
}

void PcapSource::receive(double timeout, const Take& take) {
    constexpr int kBatch = 64;  // of what is overdue
    for (int i = 0; i < kBatch; ++i) {
        if (!has_next_ && !readDatagram()) return;
        has_next_ = true;
        if (!waitUntilDue(i == 0 ? timeout : 0.0)) return;
        next_.arrival = steadyClock();
        has_next_ = false;
        take(next_);
    }
}

}  // namespace lidar_obstacles::live
