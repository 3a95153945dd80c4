#include "lidar_obstacles/mrpt_bridge/pcap_reader.h"

#include <pcap/pcap.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <stdexcept>

#include "mrpt_bridge/input/capture_report.h"
#include "mrpt_bridge/input/sensor_turns.h"
#include "mrpt_bridge/input/udp_reader.h"
#include "mrpt_bridge/input/velodyne_kinds.h"
#include "mrpt_bridge/input/velodyne_timing.h"

namespace lidar_obstacles {
namespace {

using Packet = mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket;

/// True for what a Velodyne sends: at least one block begins as they do.
bool isDataPacket(const Packet& packet) {
    return std::any_of(std::begin(packet.blocks), std::end(packet.blocks), isUsable);
}

bool hasLowerLasers(const Packet& packet) {
    return std::any_of(std::begin(packet.blocks), std::end(packet.blocks), [](const auto& block) {
        return block.header() == mrpt::obs::CObservationVelodyneScan::LOWER_BANK;
    });
}

std::optional<std::uint8_t> modelOf(const std::string& word) {
    if (word.empty()) return std::nullopt;
    const auto model = velodyneKindOf(word);
    if (!model) throw std::invalid_argument("sensor model " + word + ": must be one of " + velodyneWords());
    return model;
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
        reader_.emplace(linkType());
    }
    ~Capture() { pcap_close(handle_); }
    Capture(const Capture&) = delete;
    Capture& operator=(const Capture&) = delete;

    UdpReader& reader() { return *reader_; }
    const UdpReader& reader() const { return *reader_; }
    /// 1: a packet, PCAP_ERROR_BREAK: the end, PCAP_ERROR: damage.
    int next(pcap_pkthdr*& header, const std::uint8_t*& data) { return pcap_next_ex(handle_, &header, &data); }
    std::string error() const { return pcap_geterr(handle_); }
    double progress() const {
        const long at = std::ftell(pcap_file(handle_));
        return size_ > 0.0 && at >= 0 ? std::min(static_cast<double>(at) / size_, 1.0) : 1.0;
    }

  private:
    int linkType() const { return pcap_datalink(handle_); }

    pcap_t* handle_ = nullptr;
    std::optional<UdpReader> reader_;
    double size_ = 0.0;  ///< of the file [byte]
};

PcapReader::PcapReader(const std::string& path, const InputOptions& options)
    : path_(path),
      options_(options),
      model_(modelOf(options.sensor_model)),
      capture_(std::make_unique<Capture>(path)),
      report_(std::make_unique<CaptureReport>()) {}

PcapReader::~PcapReader() = default;

std::optional<SourceItem> PcapReader::next() {
    while (complete_.empty() && status_ == SourceStatus::Open) readPacket();
    if (complete_.empty()) return std::nullopt;
    SourceItem item;
    item.observation = complete_.front();
    item.object = objects_++;
    item.lidar = item.observation->sensorLabel;
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
    const auto datagram = capture_->reader().read(data, header->caplen);
    if (!datagram) return;
    if (datagram->length != sizeof(Packet)) return report_->addOther(*datagram);
    if (!isWanted(*datagram)) return;
    if (!datagram->complete) return report_->addCutShort(header->caplen);
    take(*datagram, static_cast<double>(header->ts.tv_sec) + 1e-6 * static_cast<double>(header->ts.tv_usec));
}

/// False for what another port or sender than asked for got or sent, which is counted.
bool PcapReader::isWanted(const UdpPayload& datagram) {
    const bool wrong_port = options_.port && datagram.destination_port != *options_.port;
    const bool wrong_sender = options_.sender && datagram.source != *options_.sender;
    if (wrong_port || wrong_sender) report_->addUnwanted(datagram, wrong_port);
    return !wrong_port && !wrong_sender;
}

/// Takes a whole datagram of the right length.
void PcapReader::take(const UdpPayload& datagram, double time) {
    Packet packet;
    std::memcpy(&packet, datagram.data, sizeof(Packet));
    const bool is_known_sensor = sensors_.count({datagram.source, datagram.destination_port}) != 0;
    if (!is_known_sensor && !isDataPacket(packet)) return report_->addOther(datagram);
    if (model_) packet.velodyne_model_ID = *model_;
    if (hasLowerLasers(packet) || !TurnAssembler::isKnownModel(packet)) return report_->addUndecoded(packet);
    SensorTurns* sensor = sensorOf(datagram);
    if (!sensor) return report_->addCrowd();
    if (sensor->isDuplicate(packet)) return report_->addDuplicate();
    sensor->add(packet, time, complete_);
}

/// @return null if there are too many sensors already.
SensorTurns* PcapReader::sensorOf(const UdpPayload& datagram) {
    constexpr std::size_t kMostSensors = 64;
    const Sensor key{datagram.source, datagram.destination_port};
    const auto known = sensors_.find(key);
    if (known != sensors_.end()) return &known->second;
    if (sensors_.size() >= kMostSensors) return nullptr;
    std::string label = "velodyne";
    if (!sensors_.empty()) label += '_' + dottedAddress(datagram.source);
    const bool new_address = std::none_of(sensors_.begin(), sensors_.end(),
                                          [&](const auto& sensor) { return sensor.first.first == datagram.source; });
    if (!new_address) label += ':' + std::to_string(datagram.destination_port);
    return &sensors_.try_emplace(key, label).first->second;
}

void PcapReader::finish() {
    for (auto& [key, sensor] : sensors_) sensor.finish(complete_);
}

std::string PcapReader::remarks() const { return report_->text(objects_, capture_->reader().incomplete()); }

double PcapReader::progress() const { return status_ == SourceStatus::End ? 1.0 : capture_->progress(); }

}  // namespace lidar_obstacles
