// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The sensor: when and where a VLP-16 fires, and what comes back (VLP-16 user manual, Velodyne 63-9243).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lidar_obstacles/simulation/world.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::simulation {

constexpr int kLasers = 16;
constexpr int kFiringsPerPacket = 24;        ///< 12 blocks of two
constexpr double kFiringPeriod = 55.296e-6;  ///< from one firing of all lasers to the next [s]
constexpr double kLaserPeriod = 2.304e-6;    ///< from one laser to the next [s]
constexpr double kPacketPeriod = kFiringsPerPacket * kFiringPeriod;

/// Ring of a laser of a VLP-16, counted from the lowest, 0.
int ringOf(int laser);
/// Azimuth at time t, clockwise from the sensor's x axis seen from above, in whole turns since t = 0.
double turnsAt(double t, double rate);

/// The packets of a turn: those that begin in it.
struct Turn {
    std::size_t index = 0;
    std::size_t first_packet = 0;
    int packets = 0;

    double start() const { return static_cast<double>(first_packet) * kPacketPeriod; }  ///< [s]
    double end() const { return start() + packets * kPacketPeriod; }
    double middle() const { return start() + 0.5 * packets * kPacketPeriod; }
};
Turn turnNumber(std::size_t index, double rate);

/// Values of LidarReturn::object.
constexpr std::int32_t kOnStructure = -1;  ///< the ground or clutter
constexpr std::int32_t kOnNothing = -2;    ///< a drop or dust

struct LidarReturn {
    Eigen::Vector3f point;    ///< measured, in the vehicle frame of the instant of the shot [m]
    float time = 0.0f;        ///< after the turn's first firing [s]
    std::int32_t firing = 0;  ///< of the turn
    std::uint8_t laser = 0;
    std::uint8_t intensity = 0;
    std::uint16_t raw = 0;                     ///< distance [2 mm]
    std::int32_t object = kOnNothing;          ///< index in World::objects, kOnStructure or kOnNothing
    Eigen::Vector3f normal{0.0f, 0.0f, 0.0f};  ///< of the surface, in the object's frame, towards the sensor
    /// What was hit: 1, 2 ... WorldObject::id; -1, -2 ... clutter, see SurfaceLabel; 0 the terrain or nothing.
    std::int32_t id = 0;
    ObjectKind kind = ObjectKind::Noise;
};

/// Rays on an object, whether or not something came back.
struct Sight {
    int first = 0;  ///< it is the first thing they meet
    int alone = 0;  ///< it would be, if there was nothing else
};

struct LidarScan {
    Turn turn;
    std::vector<LidarReturn> returns;  ///< in the order of the shots
    std::vector<Sight> sights;         ///< one per object of the world
};

/// Where everything is during a turn, and shortly before and after.
struct TurnPoses {
    PoseTrack ego;
    std::vector<std::optional<PoseTrack>> objects;  ///< none for those out of the sensor's reach
};
TurnPoses posesDuring(const World& world, const Turn& turn);

/// Casts every shot of a turn from the poses of its own instant. The same seed gives the same scan.
/// @throws std::invalid_argument if the lasers of the sensor cannot be right, see lasersOf().
LidarScan castScan(const World& world, const Turn& turn, const TurnPoses& poses, std::uint64_t seed);

/// The scan as the detector takes it, or what a sensor of fewer rings would have of it.
struct ScanCloud {
    PointCloud cloud;                  ///< vehicle frame, by the recorded pose of the sensor: it knows no mount_error
    std::vector<std::int32_t> source;  ///< of each of its points the index in LidarScan::returns
};
/// @param rings  kept as decimated() chooses them and renumbered; 0: all. One column of the view per firing.
/// @throws std::invalid_argument unless `rings` divides the number of lasers.
ScanCloud toCloud(const LidarScan& scan, const SensorSpec& sensor, int rings = 0);

}  // namespace lidar_obstacles::simulation
