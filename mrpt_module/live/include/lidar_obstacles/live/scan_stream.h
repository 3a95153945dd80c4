// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// From datagrams to scans, and everything that can be wrong with a stream.
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/live/field_of_view.h"
#include "lidar_obstacles/live/packet_sequence.h"
#include "lidar_obstacles/live/packet_source.h"

namespace lidar_obstacles::live {

struct StreamOptions {
    std::optional<std::uint32_t> sender;  ///< accept only this address; none: the first that sends a good packet
    /// A scan begins here, clockwise from the sensor's x axis. None: behind, at 180; where the field of view is limited
    /// and the sensor looks there, in the middle of what it does not look at.
    std::optional<double> cut_azimuth_deg;
    double no_data_after = 2.0;  ///< silence that is reported [s]
    std::string sensor_label = "velodyne";
    mrpt::poses::CPose3D sensor_pose;  ///< on the vehicle
};

/// What came in and what was wrong with it.
struct StreamCounts {
    std::size_t datagrams = 0;   ///< all that came in
    std::size_t packets = 0;     ///< good ones that became part of a scan
    std::size_t scans = 0;       ///< ended
    std::size_t malformed = 0;   ///< no data packet of a known model
    std::size_t foreign = 0;     ///< from another address or of another model than the sensor
    std::size_t lost = 0;        ///< missing, by the packets' clock; not those outside a limited field of view
    std::size_t late = 0;        ///< came after a later one; used
    std::size_t duplicates = 0;  ///< left out
    std::size_t unclear = 0;     ///< left out: their clock fits nothing
    std::size_t outages = 0;     ///< times without data
    std::size_t mode_changes = 0;
    std::size_t restarts = 0;    ///< of the sensor, or of its clock
    std::size_t unfinished = 0;  ///< left out: of a turn that the end cut off, see ScanStream::end()
};

/// A turn of the sensor.
struct LiveScan {
    mrpt::obs::CObservationVelodyneScan::ConstPtr observation;
    std::size_t index = 0;      ///< 0, 1, 2 ... as they ended, those that the queue dropped among them
    double last_arrival = 0.0;  ///< of its last packet, by steadyClock() [s]
};

}  // namespace lidar_obstacles::live

namespace lidar_obstacles {
class TurnAssembler;
}

namespace lidar_obstacles::live {

/// Puts the packets of one sensor together to scans. No threads, no input or output; memory is bounded whatever comes
/// in.
/// An object is for one thread at a time.
class ScanStream {
  public:
    explicit ScanStream(StreamOptions options);
    ~ScanStream();
    ScanStream(ScanStream&&) noexcept;
    ScanStream& operator=(ScanStream&&) noexcept;

    /// Takes a datagram. @return the scan that ended before it.
    std::optional<LiveScan> add(const Datagram& datagram);
    /// To be called when nothing came, with steadyClock(): ends the scan of a sensor that fell silent, notices an
    /// outage.
    std::optional<LiveScan> idle(double now);
    /// What has been collected of the last scan.
    std::optional<LiveScan> flush();
    /// As flush(), at the end of the stream: where the field of view is limited, a turn with less than two thirds of
    /// the packets of the one before is left out: what stands ahead would be cut in two.
    std::optional<LiveScan> end();

    const StreamCounts& counts() const { return counts_; }
    /// What there is to report since the last call, one line each. Of every kind the first is told and at most one a
    /// second, 32 lines are kept: a flood is counted, not told.
    std::vector<std::string> takeReports();

  private:
    enum class Kind : std::uint8_t { Data, Malformed, Foreign, Lost, Late, Duplicate, Unclear, Mode, Restart, Count };
    using Packet = mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket;

    bool accepts(const Datagram& datagram, const Packet& packet);
    bool isAnother(const Datagram& datagram, const Packet& packet) const;
    bool admit(const Datagram& datagram, const Packet& packet);
    void countLost(double now);
    void moveCut();
    void countVerdict(PacketSequence::Verdict verdict, double now);
    void noticeMode(const Datagram& datagram, const Packet& packet);
    std::optional<LiveScan> finish(mrpt::obs::CObservationVelodyneScan::Ptr scan);
    void report(Kind kind, double now, const std::string& text);

    StreamOptions options_;
    StreamCounts counts_;
    PacketSequence sequence_;
    FieldOfView view_;
    std::unique_ptr<TurnAssembler> assembler_;
    bool has_sensor_ = false;  ///< the next two are known
    std::uint32_t sender_ = 0;
    std::uint8_t model_ = 0;
    std::uint8_t mode_ = 0;
    int cut_;                           ///< [0.01 deg]
    std::size_t packets_in_scan_ = 0;   ///< that is being collected
    std::size_t packets_of_whole_ = 0;  ///< of the last one that a next one ended
    bool silent_ = false;               ///< an outage was reported
    double last_good_ = -1.0;           ///< arrival of the last good packet
    double last_in_scan_ = 0.0;         ///< of the last packet that went into a scan
    std::array<double, static_cast<std::size_t>(Kind::Count)> reported_{};
    std::vector<std::string> reports_;
};

}  // namespace lidar_obstacles::live
