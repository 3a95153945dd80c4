// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"
#include "lidar_obstacles/simulation/recording.h"

namespace lidar_obstacles::simulation {
namespace {

using mrpt::obs::CObservationVelodyneScan;

// A data packet of a VLP-16, byte by byte (user manual 63-9243, chapter 9).
constexpr std::size_t kPacketBytes = 1206, kBlockBytes = 100, kReturnBytes = 3;
constexpr int kBlocks = kFiringsPerPacket / 2;
constexpr std::uint8_t kStrongest = 0x37, kVlp16 = 0x22;
using Packet = std::array<std::uint8_t, kPacketBytes>;

void putLittleEndian(std::uint8_t* at, std::uint32_t value, int bytes) {
    for (int k = 0; k < bytes; ++k) at[k] = static_cast<std::uint8_t>(value >> (8U * static_cast<unsigned>(k)));
}

/// A packet without returns that begins at `time` [s].
Packet emptyPacket(double time, double rate) {
    Packet packet{};
    for (int b = 0; b < kBlocks; ++b) {
        const double turns = turnsAt(time + 2 * b * kFiringPeriod, rate);
        const auto azimuth = static_cast<std::uint32_t>(std::lround((turns - std::floor(turns)) * 36000.0)) % 36000U;
        std::uint8_t* block = packet.data() + static_cast<std::size_t>(b) * kBlockBytes;
        block[0] = 0xff;
        block[1] = 0xee;
        putLittleEndian(block + 2, azimuth, 2);
    }
    const double since_hour = std::fmod(time, 3600.0);
    putLittleEndian(packet.data() + 1200, static_cast<std::uint32_t>(std::llround(since_hour * 1e6) % 3'600'000'000LL),
                    4);
    packet[1204] = kStrongest;
    packet[1205] = kVlp16;
    return packet;
}

void putReturn(Packet& packet, const LidarReturn& r) {
    const int firing = r.firing % kFiringsPerPacket;
    const std::size_t block = static_cast<std::size_t>(firing) / 2;
    const std::size_t slot = static_cast<std::size_t>(firing % 2) * kLasers + r.laser;
    std::uint8_t* at = packet.data() + block * kBlockBytes + 4 + slot * kReturnBytes;
    putLittleEndian(at, r.raw, 2);
    at[2] = r.intensity;
}

mrpt::poses::CPose3D toMrpt(const Pose6& pose) {
    const Eigen::Vector3d& p = pose.position;
    return {p.x(), p.y(), p.z(), pose.yaw, pose.pitch, pose.roll};
}

/// A VLP-16's, with the elevations of this sensor's lasers.
mrpt::obs::VelodyneCalibration calibrationFor(const SensorSpec& sensor) {
    mrpt::obs::VelodyneCalibration calibration = *calibrationOf(kVlp16);
    if (sensor.elevations.empty()) return calibration;
    auto& lasers = calibration.laser_corrections;
    if (lasers.size() != sensor.elevations.size())
        throw std::invalid_argument("packets are written of 16 lasers only, this sensor has " +
                                    std::to_string(sensor.elevations.size()));
    for (std::size_t k = 0; k < lasers.size(); ++k) setElevation(lasers[k], sensor.elevations[k] * 180.0 / M_PI);
    return calibration;
}

}  // namespace

CObservationVelodyneScan::Ptr toObservation(const LidarScan& scan, const SensorSpec& sensor) {
    const mrpt::obs::VelodyneCalibration calibration = calibrationFor(sensor);  // refuses what packets do not hold
    std::vector<Packet> packets;
    packets.reserve(static_cast<std::size_t>(scan.turn.packets));
    for (int p = 0; p < scan.turn.packets; ++p)
        packets.push_back(emptyPacket(scan.turn.start() + p * kPacketPeriod, sensor.rate));
    for (const LidarReturn& r : scan.returns)
        putReturn(packets[static_cast<std::size_t>(r.firing) / kFiringsPerPacket], r);

    auto observation = CObservationVelodyneScan::Create();
    observation->sensorLabel = sensor.label;
    observation->timestamp = mrpt::Clock::fromDouble(kEpoch + scan.turn.start());
    observation->originalReceivedTimestamp = observation->timestamp;
    observation->has_satellite_timestamp = true;
    observation->sensorPose = toMrpt(sensor.pose);
    observation->minRange = sensor.min_range;
    observation->maxRange = sensor.max_range;
    observation->calibration = calibration;
    for (const Packet& bytes : packets) {
        CObservationVelodyneScan::TVelodyneRawPacket packet;
        static_assert(sizeof packet == kPacketBytes);
        std::memcpy(&packet, bytes.data(), kPacketBytes);
        observation->scan_packets.push_back(packet);
    }
    return observation;
}

}  // namespace lidar_obstacles::simulation
