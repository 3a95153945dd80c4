// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The Velodyne sensors: names, calibrations, firing times and packets (user manuals of VLP-16, Puck Hi-Res, VLP-32C,
/// HDL-32E).
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace lidar_obstacles {

/// When the lasers of a packet's block fire, and how it tells distances.
struct FiringTimes {
    int lasers;         ///< fired before the first fires again
    int together;       ///< of them at the same time
    double laser_us;    ///< from one laser, or such a group, to the next
    double firing_us;   ///< from one firing of all lasers to the next
    double block_us;    ///< from one block to the next
    double distance_m;  ///< unit of the raw distances

    /// Time of return k of a block after the block's first [us].
    double returnTime(int k) const { return (k / lasers) * firing_us + (k % lasers / together) * laser_us; }
};

/// A kind of sensor, as the last byte of its packets names it.
struct VelodyneKind {
    std::uint8_t id;
    const char* name;
    const char* word;   ///< for options; null: its packets are not decoded
    FiringTimes times;  ///< of those that are decoded
};

/// @return null for a byte that means no sensor that is known here.
const VelodyneKind* velodyneKind(std::uint8_t id);

/// The default calibration of a kind; null if its packets are not decoded.
const mrpt::obs::VelodyneCalibration* calibrationOf(std::uint8_t id);

/// Gives a laser an elevation [deg], with its sine and cosine.
void setElevation(mrpt::obs::VelodyneCalibration::PerLaserCalib& laser, double elevation);

/// The kind with this word ("vlp-16"); nothing if there is none.
std::optional<std::uint8_t> velodyneKindOf(const std::string& word);

/// The words of all kinds that are decoded, with commas.
std::string velodyneWords();

/// Length of their data packets [byte].
inline constexpr std::size_t kDataPacketBytes = sizeof(mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket);
static_assert(kDataPacketBytes == 1206);

/// True for a block header and an azimuth as these sensors send them.
bool isUsable(const mrpt::obs::CObservationVelodyneScan::raw_block_t& block);

/// True for a packet of a sensor with more than 32 lasers, which sends blocks of the upper and of the lower ones.
bool hasLowerLasers(const mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket& packet);

/// The clock of a packet starts anew every hour: so much of it, more or less by whole hours, into [-half an hour, half
/// an hour) [us].
double withinHalfHour(double us);

/// From one packet's clock to another's, [-half an hour, half an hour) [us].
double clockStep(std::uint32_t from, std::uint32_t to);

}  // namespace lidar_obstacles
