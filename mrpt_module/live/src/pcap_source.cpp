#include "lidar_obstacles/live/pcap_source.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <thread>

#include "mrpt_bridge/input/capture_stream.h"

namespace lidar_obstacles::live {

PcapSource::PcapSource(const std::string& path, Pace pace, std::uint16_t port)
    : path_(path), pace_(pace), port_(port), capture_(std::make_unique<CaptureStream>(path)) {}

PcapSource::~PcapSource() = default;

bool PcapSource::readDatagram() {
    pcap_pkthdr* header = nullptr;
    const std::uint8_t* frame = nullptr;
    while (capture_->next(header, frame)) {
        ++datagrams_;
        const auto payload = capture_->reader().read(frame, header->caplen);
        if (payload && port_ == 0 && payload->length == Datagram::kCapacity) port_ = payload->destination_port;
        if (!payload || port_ == 0 || payload->destination_port != port_) continue;
        next_.length = payload->complete ? payload->length : 0;  // cut short by the capture: of no use
        next_.sender = payload->source;
        next_.time = static_cast<double>(header->ts.tv_sec) + 1e-6 * static_cast<double>(header->ts.tv_usec);
        if (payload->complete)
            std::memcpy(next_.bytes.data(), payload->data, std::min(payload->length, Datagram::kCapacity));
        return true;
    }
    ended_ = true;
    if (!capture_->damage().empty())
        damage_ = path_ + ": packet " + std::to_string(datagrams_) + " cannot be read: " + capture_->damage();
    return false;
}

bool PcapSource::waitUntilDue(double timeout) {
    if (pace_ == Pace::Maximum) return true;
    if (start_ < 0.0) {
        start_ = wallClock();
        first_time_ = next_.time;
    }
    const double wait = next_.time - first_time_ - (wallClock() - start_);
    if (wait > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(std::min(wait, timeout)));
    return wait <= timeout;
}

void PcapSource::receive(double timeout, const Take& take) {
    constexpr int kBatch = 64;  // of what is overdue
    for (int i = 0; i < kBatch; ++i) {
        if (!has_next_ && !readDatagram()) return;
        has_next_ = true;
        if (!waitUntilDue(i == 0 ? timeout : 0.0)) return;
        next_.arrival = wallClock();
        has_next_ = false;
        take(next_);
    }
}

}  // namespace lidar_obstacles::live
