// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/pcap_reader.h"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <stdexcept>

#include "lidar_obstacles/mrpt_bridge/ipv4_address.h"
#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"
#include "mrpt_bridge/input/capture_report.h"
#include "mrpt_bridge/input/capture_stream.h"
#include "mrpt_bridge/input/sensor_turns.h"
#include "mrpt_bridge/input/velodyne_timing.h"

namespace lidar_obstacles {
namespace {

using Packet = mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket;

/// True for what a Velodyne sends: at least one block begins as they do.
bool isDataPacket(const Packet& packet) {
    return std::any_of(std::begin(packet.blocks), std::end(packet.blocks), isUsable);
}

std::optional<std::uint8_t> modelOf(const std::string& word) {
    if (word.empty()) return std::nullopt;
    const auto model = velodyneKindOf(word);
    if (!model) throw std::invalid_argument("sensor model " + word + ": must be one of " + velodyneWords());
    return model;
}

}  // namespace

PcapReader::PcapReader(const std::string& path, const InputOptions& options)
    : path_(path),
      options_(options),
      model_(modelOf(options.sensor_model)),
      capture_(std::make_unique<CaptureStream>(path)),
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
    if (!capture_->next(header, data)) {
        const std::string& damage = capture_->damage();
        finish(!damage.empty());
        status_ = damage.empty() ? SourceStatus::End : SourceStatus::Damaged;
        if (!damage.empty()) message_ = path_ + ": packet " + std::to_string(packets_) + " cannot be read: " + damage;
        return;
    }
    ++packets_;
    const auto datagram = capture_->reader().read(data, header->caplen);
    if (!datagram) return report_->addFrame(capture_->reader().otherContent(data, header->caplen));
    if (datagram->length != kDataPacketBytes) return report_->addOther(*datagram);
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
    if (!sensors_.empty()) label += '_' + addressText(datagram.source);
    const bool new_address = std::none_of(sensors_.begin(), sensors_.end(),
                                          [&](const auto& sensor) { return sensor.first.first == datagram.source; });
    if (!new_address) label += ':' + std::to_string(datagram.destination_port);
    return &sensors_.try_emplace(key, label).first->second;
}

void PcapReader::finish(bool damaged) {
    for (auto& [key, sensor] : sensors_) report_->addUnfinished(sensor.finish(damaged, complete_));
}

std::string PcapReader::remarks() const { return report_->text(objects_, capture_->reader().incomplete()); }

double PcapReader::progress() const { return status_ == SourceStatus::End ? 1.0 : capture_->progress(); }

}  // namespace lidar_obstacles
