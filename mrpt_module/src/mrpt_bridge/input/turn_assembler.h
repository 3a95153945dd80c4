/// @file
/// Puts the packets of one Velodyne together to turns.
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <string>

namespace lidar_obstacles {

/// Collects packets until the azimuth passes zero, or wherever a turn is to be cut. Packets that come late do not end
/// a turn.
class TurnAssembler {
  public:
    using Scan = mrpt::obs::CObservationVelodyneScan;

    /// @param label  sensorLabel of the scans.
    /// @param cut    azimuth at which turns begin [0.01 deg], 0 .. 35999.
    explicit TurnAssembler(std::string label, int cut = 0) : label_(std::move(label)), cut_(cut) {}

    /// True if the packet's sensor model has a calibration.
    static bool isKnownModel(const Scan::TVelodyneRawPacket& packet);

    /// Adds a packet of a known model. @param time  seconds since the epoch.
    /// @return the turn that ended before it, or null.
    Scan::Ptr add(const Scan::TVelodyneRawPacket& packet, double time);

    /// What has been collected since the last turn ended; null if nothing. The next packet begins a new turn.
    Scan::Ptr flush();

  private:
    bool endsTurn(int azimuth, double time) const;

    std::string label_;
    int cut_;
    Scan::Ptr scan_;
    int last_azimuth_ = 0;  ///< of the most advanced packet, counted from the cut [0.01 deg]
    double last_time_ = 0.0;
};

}  // namespace lidar_obstacles
