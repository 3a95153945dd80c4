// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Puts the packets of one Velodyne together to turns.
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cstdint>
#include <string>
#include <utility>

namespace lidar_obstacles {

/// Collects packets until the azimuth passes zero, or wherever a turn is to be cut. Packets that come late do not end
/// a turn, nor do packets that come in bursts: what passed between two packets is told by the sensor's own clock, as
/// long as that fits the turn of its head. Where it does not (it was set, the sensor restarted) the times of capture
/// count.
/// An object is for one thread at a time.
class TurnAssembler {
  public:
    using Scan = mrpt::obs::CObservationVelodyneScan;
    using Packet = Scan::TVelodyneRawPacket;
    enum class Cut : std::uint8_t {
        BetweenPackets,  ///< a packet that passes the cut belongs to the turn that it ends
        WithinPackets    ///< it stands in both turns, in each without the returns of the other: no gap, nothing twice
    };

    /// @param label  sensorLabel of the scans.
    /// @param cut    azimuth at which turns begin [0.01 deg], 0 .. 35999.
    explicit TurnAssembler(std::string label, int cut = 0, Cut where = Cut::BetweenPackets)
        : label_(std::move(label)), cut_(cut), where_(where) {}

    /// True if the packet's sensor model has a calibration.
    static bool isKnownModel(const Packet& packet);

    /// Adds a packet of a known model. @param time  of its capture, seconds since the epoch.
    /// @return the turn that ended before it, or null.
    Scan::Ptr add(const Packet& packet, double time);

    /// Turns begin at another azimuth [0.01 deg], 0 .. 35999, from the next one that begins.
    void setCut(int cut);

    /// What has been collected since the last turn ended; null if nothing. The next packet begins a new turn.
    Scan::Ptr flush();

  private:
    /// Where the sensor was at the beginning of a packet.
    struct Instant {
        int azimuth = 0;          ///< counted from the cut [0.01 deg]
        std::uint32_t clock = 0;  ///< of the sensor [us]
        double time = 0.0;        ///< of the capture [s]
    };

    Instant instantOf(const Packet& packet, double time) const;
    bool fitsTurn(const Instant& now, double passed) const;
    double elapsed(const Instant& now) const;
    bool isLate(const Instant& now) const;
    bool endsTurn(const Instant& now) const;
    void begin(const Packet& packet, double time);
    void divide(Scan& ended, const Instant& before);
    bool isPastCut(const Packet& packet, std::size_t block) const;

    std::string label_;
    int cut_;
    Cut where_;
    Scan::Ptr scan_;
    Instant newest_;     ///< of the most advanced packet
    double rate_ = 0.0;  ///< at which the sensor turns [0.01 deg / s]; 0: not known
};

}  // namespace lidar_obstacles
