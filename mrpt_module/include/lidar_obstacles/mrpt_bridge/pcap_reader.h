// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Network captures of Velodyne sensors, turn by turn.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <utility>

#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace lidar_obstacles {

class CaptureStream;
class CaptureReport;
class SensorTurns;
struct UdpPayload;

/// Streams a capture (pcap, or pcapng as far as libpcap reads it; also compressed by gzip) as one
/// CObservationVelodyneScan per turn.
///
/// Data packets are UDP datagrams of 1206 bytes with Velodyne's block headers, to whatever port, over Ethernet (with or
/// without VLAN tags), Linux cooked capture or raw IPv4; fragments are put together. A turn ends where the packets'
/// azimuth passes zero or, where the sensor's field of view is limited, in the middle of what it does not look at; to
/// see that, the first two turns are read before the first is delivered. What passed between two packets is told by
/// the sensor's clock as long as that fits the turn of its head, so bursts and a clock that is set cut no turn in two.
/// The first and the last turn of a capture are usually partial and are delivered like the others: what they show is
/// true, there is just less of it. Only of a limited field of view a last turn with less than two thirds of the
/// packets of a whole one is left out and counted, unless damage cut it off. The stamp of a scan is the capture time of
/// its first packet; the calibration is the default one for the sensor model the packets name; `sensorPose` is the
/// identity, as a capture does not tell where the sensor sits. Sensors are told apart by their address and the port
/// they send to. The first sensor's label is "velodyne"; further ones add their address: "velodyne_192.168.1.202", and
/// the port where the address is not new: "velodyne_192.168.1.201:2369".
///
/// Left out and counted in remarks(): packets the capture cut short, of sensor models that are not decoded, that came
/// twice, to other ports or of other senders than asked for, datagrams that lack fragments. If there was no scan at
/// all, remarks() also says what else the capture holds. A file cut inside a record is damage; one cut exactly between
/// two records looks like a shorter capture.
/// An object is for one thread at a time.
class PcapReader : public ScanSource {
  public:
    /// @throws std::runtime_error naming the file if it cannot be opened or is no capture that can be read,
    ///         std::invalid_argument if the options name a sensor model that is not known.
    explicit PcapReader(const std::string& path, const InputOptions& options = {});
    ~PcapReader() override;

    std::optional<SourceItem> next() override;
    SourceStatus status() const override { return status_; }
    std::size_t objects() const override { return objects_; }
    const std::string& message() const override { return message_; }
    std::string remarks() const override;
    double progress() const override;

  private:
    using Sensor = std::pair<std::uint32_t, std::uint16_t>;  ///< IPv4 address and port

    void readPacket();
    void take(const UdpPayload& datagram, double time);
    bool isWanted(const UdpPayload& datagram);
    SensorTurns* sensorOf(const UdpPayload& datagram);
    void finish(bool damaged);

    std::string path_;
    InputOptions options_;
    std::optional<std::uint8_t> model_;  ///< that all packets are taken to be of
    std::unique_ptr<CaptureStream> capture_;
    std::map<Sensor, SensorTurns> sensors_;
    std::deque<mrpt::obs::CObservation::Ptr> complete_;
    SourceStatus status_ = SourceStatus::Open;
    std::size_t packets_ = 0;  ///< of the capture, of any kind
    std::size_t objects_ = 0;  ///< scans delivered
    std::unique_ptr<CaptureReport> report_;
    std::string message_;
};

}  // namespace lidar_obstacles
