// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Velodyne packets made by hand, byte by byte as the user manuals describe them.
#pragma once

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>

namespace lidar_obstacles::test {

using VelodyneScan = mrpt::obs::CObservationVelodyneScan;
using VelodynePacket = VelodyneScan::TVelodyneRawPacket;

inline std::uint8_t* bytes(VelodynePacket& packet) { return reinterpret_cast<std::uint8_t*>(&packet); }

inline void put16(std::uint8_t* at, unsigned value) {
    at[0] = static_cast<std::uint8_t>(value);
    at[1] = static_cast<std::uint8_t>(value >> 8U);
}

/// Header and azimuth [0.01 deg] of block b.
inline void setBlock(VelodynePacket& packet, int b, unsigned azimuth, unsigned header = 0xeeff) {
    put16(bytes(packet) + 100 * b, header);
    put16(bytes(packet) + 100 * b + 2, azimuth % 36000U);
}

/// Distance [2 mm] and reflectivity of return k of block b.
inline void setReturn(VelodynePacket& packet, int b, int k, unsigned distance, unsigned intensity = 51) {
    std::uint8_t* at = bytes(packet) + 100 * b + 4 + 3 * k;
    put16(at, distance);
    at[2] = static_cast<std::uint8_t>(intensity);
}

/// The packet's clock, microseconds after the full hour.
inline void setClock(VelodynePacket& packet, std::uint32_t clock) { std::memcpy(bytes(packet) + 1200, &clock, 4); }

/// A packet with 12 good blocks without returns. @param clock  microseconds after the full hour.
inline VelodynePacket emptyPacket(std::uint32_t clock, std::uint8_t model = 0x22, std::uint8_t mode = 0x37) {
    VelodynePacket packet;
    std::memset(bytes(packet), 0, sizeof(packet));
    for (int b = 0; b < 12; ++b) setBlock(packet, b, 0);
    std::memcpy(bytes(packet) + 1200, &clock, 4);
    packet.laser_return_mode = mode;
    packet.velodyne_model_ID = model;
    return packet;
}

/// One turn of a sensor that stands in a scene. `range(azimuth, elevation)` is the distance [m] of what a ray hits,
/// azimuth clockwise from x, both in radians; 0: nothing.
using Scene = std::function<double(double azimuth, double elevation)>;

struct Turn {
    std::uint8_t model = 0x22;  ///< 0x22 VLP-16, 0x21 HDL-32E
    int step = 40;              ///< azimuth per block [0.01 deg]
    int packets = 75;
    unsigned start = 0;               ///< azimuth of the first block [0.01 deg]
    std::uint32_t clock = 1'000'000;  ///< of the first packet [us]
};

/// When return k of a block fires, after the block's first [us], and how long a block lasts, from the manuals.
inline double firingTime(std::uint8_t model, int k) {
    return model == 0x21 ? 1.152 * k : 55.296 * (k / 16) + 2.304 * (k % 16);
}
inline double blockTime(std::uint8_t model) { return model == 0x21 ? 46.08 : 110.592; }

inline VelodyneScan makeScan(const Turn& turn, const Scene& range) {
    VelodyneScan scan;
    scan.minRange = 0.0;
    scan.maxRange = 130.0;
    scan.timestamp = mrpt::Clock::fromDouble(1'000'000.0);
    scan.calibration = mrpt::obs::VelodyneCalibration::LoadDefaultCalibration(turn.model == 0x21 ? "HDL32" : "VLP16");
    const auto& lasers = scan.calibration.laser_corrections;
    for (int p = 0; p < turn.packets; ++p) {
        const double since_start = p * 12 * blockTime(turn.model);
        VelodynePacket packet =
            emptyPacket(turn.clock + static_cast<std::uint32_t>(std::lround(since_start)), turn.model);
        for (int b = 0; b < 12; ++b) {
            const unsigned azimuth = turn.start + static_cast<unsigned>(turn.step * (12 * p + b));
            setBlock(packet, b, azimuth);
            for (int k = 0; k < 32; ++k) {
                const double turned = turn.step * firingTime(turn.model, k) / blockTime(turn.model);
                const double elevation = lasers[static_cast<std::size_t>(k) % lasers.size()].verticalCorrection;
                const double d = range((azimuth + turned) * M_PI / 18000.0, elevation * M_PI / 180.0);
                setReturn(packet, b, k, static_cast<unsigned>(std::lround(d / 0.002)), static_cast<unsigned>(8 * k));
            }
        }
        scan.scan_packets.push_back(packet);
    }
    return scan;
}

/// A wall across the way, x = `distance` in front of the sensor, seen within 60 deg to either side.
inline Scene wallAt(double distance) {
    return [distance](double azimuth, double elevation) {
        const double forward = std::cos(azimuth) * std::cos(elevation);
        return forward > 0.5 ? distance / forward : 0.0;
    };
}

/// The same distance in every direction.
inline Scene sphere(double radius) {
    return [radius](double, double) { return radius; };
}

}  // namespace lidar_obstacles::test
