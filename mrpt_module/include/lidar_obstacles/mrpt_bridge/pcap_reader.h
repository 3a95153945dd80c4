/// @file
/// Network captures of Velodyne sensors, turn by turn.
#pragma once

#include <deque>
#include <map>
#include <memory>

#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace lidar_obstacles {

class TurnAssembler;

/// Streams a capture (pcap, or pcapng as far as libpcap reads it) as one CObservationVelodyneScan per turn.
///
/// Data packets are UDP to port 2368 with 1206 bytes, over Ethernet (with or without VLAN tags), Linux cooked capture
/// or raw IPv4. A turn ends where the packets' azimuth passes zero. The first and the last turn of a capture are
/// usually partial and are delivered like the others: what they show is true, there is just less of it. The stamp of
/// a scan is the capture time of its first packet; the calibration is MRPT's default for the sensor model the packets
/// name; `sensorPose` is the identity, as a capture does not tell where the sensor sits. The first sensor's label is
/// "velodyne"; further ones in the same capture add their address: "velodyne_192.168.1.202".
///
/// Left out and counted in remarks(): packets the capture cut short, packets of unknown sensor models. A file cut
/// inside a record is damage; one cut exactly between two records looks like a shorter capture.
class PcapReader : public ScanSource {
  public:
    /// @throws std::runtime_error naming the file if it cannot be opened or is no capture that can be read.
    explicit PcapReader(const std::string& path);
    ~PcapReader() override;

    std::optional<SourceItem> next() override;
    SourceStatus status() const override { return status_; }
    std::size_t objects() const override { return objects_; }
    const std::string& message() const override { return message_; }
    std::string remarks() const override;
    double progress() const override;

  private:
    class Capture;

    void readPacket();
    void finish();

    std::string path_;
    std::unique_ptr<Capture> capture_;
    std::map<std::uint32_t, TurnAssembler> sensors_;  ///< by IPv4 source address
    std::deque<mrpt::obs::CObservation::Ptr> complete_;
    SourceStatus status_ = SourceStatus::Open;
    std::size_t packets_ = 0;    ///< of the capture, of any kind
    std::size_t objects_ = 0;    ///< scans delivered
    std::size_t cut_short_ = 0;  ///< data packets of which the capture holds only the beginning
    std::size_t unknown_ = 0;    ///< data packets of models without calibration
    std::string message_;
};

}  // namespace lidar_obstacles
