// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/capture_datagrams.h"

#include "mrpt_bridge/input/capture_stream.h"

namespace lidar_obstacles {

CaptureDatagrams::CaptureDatagrams(const std::string& path)
    : path_(path), stream_(std::make_unique<CaptureStream>(path)) {}

CaptureDatagrams::~CaptureDatagrams() = default;
CaptureDatagrams::CaptureDatagrams(CaptureDatagrams&&) noexcept = default;
CaptureDatagrams& CaptureDatagrams::operator=(CaptureDatagrams&&) noexcept = default;

std::optional<CapturedDatagram> CaptureDatagrams::next() {
    pcap_pkthdr* header = nullptr;
    const std::uint8_t* frame = nullptr;
    while (stream_->next(header, frame)) {
        ++records_;
        const auto payload = stream_->reader().read(frame, header->caplen);
        if (!payload) continue;
        const double time = static_cast<double>(header->ts.tv_sec) + 1e-6 * static_cast<double>(header->ts.tv_usec);
        return CapturedDatagram{payload->data,   payload->length,           payload->complete,
                                payload->source, payload->destination_port, time};
    }
    return std::nullopt;
}

std::string CaptureDatagrams::damage() const {
    if (stream_->damage().empty()) return "";
    return path_ + ": packet " + std::to_string(records_) + " cannot be read: " + stream_->damage();
}

}  // namespace lidar_obstacles
