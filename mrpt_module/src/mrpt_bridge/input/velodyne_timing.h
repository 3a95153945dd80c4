/// @file
/// When and where each firing of a Velodyne packet happened: firing times, packet clocks, turning speed.
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <vector>

namespace lidar_obstacles {

/// Firing times inside a block (VLP-16 and HDL-32E user manuals).
struct FiringTimes {
    int lasers;        ///< fired one after the other before the first fires again
    double laser_us;   ///< from one laser to the next
    double firing_us;  ///< from one firing of all lasers to the next
    double block_us;   ///< from one block to the next

    /// Time of return k of a block after the block's first [us].
    double returnTime(int k) const { return (k / lasers) * firing_us + (k % lasers) * laser_us; }
};

/// @param lasers  16: VLP-16 timing, 32: HDL-32E timing.
FiringTimes firingTimes(int lasers);

/// True if even and odd blocks of the packet are the last and the strongest return of the same firing.
bool isDualReturn(const mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket& packet);

/// True for a block header and an azimuth as these sensors send them.
bool isUsable(const mrpt::obs::CObservationVelodyneScan::raw_block_t& block);

/// Packet times of a scan on one axis: the packets' own clock starts anew every hour, and packets may come out of
/// order.
struct PacketClock {
    std::vector<double> offset;  ///< after the earliest packet [s]; not a number where the clock must be damaged
    double first = 0.0;          ///< offset of the scan's first packet [s]; 0 where that is the earliest
};

/// A packet more than 2 s away from the scan's median counts as damaged. Empty for a scan without packets.
PacketClock packetClock(const mrpt::obs::CObservationVelodyneScan& scan);

/// Azimuth from one firing block to the next [0.01 deg]: mean of what lies near the median of all neighbours, which
/// gaps and damaged blocks do not move. 40 (a VLP-16 at 10 Hz) where no two neighbours can be compared.
double azimuthStep(const mrpt::obs::CObservationVelodyneScan& scan);

}  // namespace lidar_obstacles
