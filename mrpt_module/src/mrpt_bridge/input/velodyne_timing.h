// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// When and where each firing of a Velodyne packet happened: firing times, packet clocks, turning speed.
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <vector>

#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"

namespace lidar_obstacles {

/// Firing times of the scan's sensor: by the number of its lasers (16: VLP-16, 32: HDL-32E) and, of 32, the kind that
/// its first packet names.
FiringTimes firingTimes(const mrpt::obs::CObservationVelodyneScan& scan, std::size_t lasers);

/// True if even and odd blocks of the packet are the last and the strongest return of the same firing.
bool isDualReturn(const mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket& packet);

/// Packet times of a scan on one axis: the packets' own clock starts anew every hour, packets may come out of order,
/// and the clock may have been set within the scan (by GPS), or be damaged.
struct PacketClock {
    std::vector<double> offset;  ///< after the earliest packet [s]
    double first = 0.0;          ///< offset of the scan's first packet [s]
    int set_anew = 0;            ///< packets whose own clock does not fit the others'
};

/// A packet more than half a second away from the scan's median gets the time at which the sensor looked where the
/// packet begins, counted from its neighbour. Empty for a scan without packets.
/// @param us_per_unit  time in which the sensor turns by 0.01 deg [us].
PacketClock packetClock(const mrpt::obs::CObservationVelodyneScan& scan, double us_per_unit);

/// Azimuth from one firing block to the next [0.01 deg]: mean of what lies near the median of all neighbours, which
/// gaps and damaged blocks do not move. 40 (a VLP-16 at 10 Hz) where no two neighbours can be compared.
double azimuthStep(const mrpt::obs::CObservationVelodyneScan& scan);

}  // namespace lidar_obstacles
