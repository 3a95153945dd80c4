#include "lidar_obstacles/mrpt_bridge/pcap_reader.h"

#include <pcap/pcap.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "mrpt_bridge/input/turn_assembler.h"
#include "mrpt_bridge/input/udp_payload.h"

namespace lidar_obstacles {
namespace {

using Packet = mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket;
constexpr std::uint16_t kDataPort = 2368;

std::string dotted(std::uint32_t address) {
    std::string text;
    for (int shift = 24; shift >= 0; shift -= 8)
        text += std::to_string(address >> static_cast<unsigned>(shift) & 0xffU) + (shift > 0 ? "." : "");
    return text;
}

}  // namespace

/// libpcap's handle, closed with the object.
class PcapReader::Capture {
  public:
    explicit Capture(const std::string& path) {
        std::array<char, PCAP_ERRBUF_SIZE> error{};
        handle_ = pcap_open_offline(path.c_str(), error.data());
        if (!handle_) throw std::runtime_error("cannot open " + path + ": " + error.data());
        if (!isKnownLinkType(linkType())) {
            const std::string type = std::to_string(linkType());
            pcap_close(handle_);
            throw std::runtime_error("cannot read " + path + ": captures of link type " + type + " are not supported");
        }
        std::error_code ec;
        const auto size = std::filesystem::file_size(path, ec);
        size_ = ec ? 0.0 : static_cast<double>(size);
    }
    ~Capture() { pcap_close(handle_); }
    Capture(const Capture&) = delete;
    Capture& operator=(const Capture&) = delete;

    int linkType() const { return pcap_datalink(handle_); }
    /// 1: a packet, PCAP_ERROR_BREAK: the end, PCAP_ERROR: damage.
    int next(pcap_pkthdr*& header, const std::uint8_t*& data) { return pcap_next_ex(handle_, &header, &data); }
    std::string error() const { return pcap_geterr(handle_); }
    double progress() const {
        const long at = std::ftell(pcap_file(handle_));
        return size_ > 0.0 && at >= 0 ? std::min(static_cast<double>(at) / size_, 1.0) : 1.0;
    }

  private:
    pcap_t* handle_ = nullptr;
    double size_ = 0.0;  ///< of the file [byte]
};

PcapReader::PcapReader(const std::string& path) : path_(path), capture_(std::make_unique<Capture>(path)) {}

PcapReader::~PcapReader() = default;

std::optional<SourceItem> PcapReader::next() {
    while (complete_.empty() && status_ == SourceStatus::Open) readPacket();
    if (complete_.empty()) return std::nullopt;
    SourceItem item{complete_.front(), nullptr, objects_++};
    complete_.pop_front();
    return item;
}

void PcapReader::readPacket() {
    pcap_pkthdr* header = nullptr;
    const std::uint8_t* data = nullptr;
    const int result = capture_->next(header, data);
    if (result != 1) {
        finish();
        status_ = result == PCAP_ERROR_BREAK ? SourceStatus::End : SourceStatus::Damaged;
        if (status_ == SourceStatus::Damaged)
            message_ = path_ + ": packet " + std::to_string(packets_) + " cannot be read: " + capture_->error();
        return;
    }
    ++packets_;
    const auto payload = findUdpPayload(capture_->linkType(), data, header->caplen);
    if (!payload || payload->destination_port != kDataPort || payload->length != sizeof(Packet)) return;
    if (!payload->complete) {
        ++cut_short_;
        return;
    }
    Packet packet;
    std::memcpy(&packet, payload->data, sizeof(Packet));
    if (!TurnAssembler::isKnownModel(packet)) {
        ++unknown_;
        return;
    }
    const std::string label = sensors_.empty() ? "velodyne" : "velodyne_" + dotted(payload->source);
    TurnAssembler& sensor = sensors_.try_emplace(payload->source, label).first->second;
    const double time = static_cast<double>(header->ts.tv_sec) + 1e-6 * static_cast<double>(header->ts.tv_usec);
    if (auto scan = sensor.add(packet, time)) complete_.push_back(scan);
}

void PcapReader::finish() {
    for (auto& [source, sensor] : sensors_)
        if (auto scan = sensor.flush()) complete_.push_back(scan);
}

std::string PcapReader::remarks() const {
    std::string text;
    if (cut_short_ != 0) text += std::to_string(cut_short_) + " packets cut short by the capture left out";
    if (unknown_ != 0)
        text += (text.empty() ? "" : "; ") + std::to_string(unknown_) + " packets of unknown sensor models left out";
    return text;
}

double PcapReader::progress() const { return status_ == SourceStatus::End ? 1.0 : capture_->progress(); }

}  // namespace lidar_obstacles
