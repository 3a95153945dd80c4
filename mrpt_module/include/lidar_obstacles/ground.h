// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Ground segmentation (Mentasti et al., Sec. III.A), after Zermas et al. 2017 (ground plane fitting), changed for
/// sensors of few rings: seeds per ring and azimuth instead of a height band, a consensus over the
/// whole scan, and one continuous surface that bends away from it.
#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Marks the returns that belong to the ground.
///
/// @param cloud  N returns, vehicle frame [m], all finite; may be empty.
/// @return one label and one height per return, and one surface. Where no plane can be supported
///         `evidence` is None, nothing is labelled ground, and heights are told above z = 0.
/// @throws std::invalid_argument if a parameter is out of range or a return is not finite.
/// @note sensorPose.z is not used: the ground is found where it is.
GroundModel segmentGround(const PointCloud& cloud, const GroundParams& params);

/// A low return that may lie on the ground.
struct GroundSeed {
    Eigen::Vector3d p;       ///< vehicle frame [m]
    double range = 0.0;      ///< horizontal, from `sensor_origin` [m]
    int bin = 0;             ///< azimuth bin, counter-clockwise from -pi
    int row = 0;             ///< ring, or range bin where the source has no rings
    std::size_t sensor = 0;  ///< that saw it
    bool followed = false;   ///< reached from the plane of the scan without a step: the ground bends
};

/// Number of azimuth bins that seeds are taken from.
inline constexpr int kSeedBins = 72;

/// Azimuth bin (0 .. kSeedBins - 1, counter-clockwise from -pi around `sensor_origin`) of each return. Where the cloud
/// has a view of one sensor, returns of one column share the bin of its first return.
std::vector<std::uint8_t> azimuthBins(const PointCloud& cloud);

/// The low end of the returns of each ring in each azimuth bin, without those on steep surfaces. Where the source
/// has no rings, range bins take their place. Ordered by bin, then row.
///
/// @param bins  azimuthBins(cloud).
std::vector<GroundSeed> groundSeeds(const PointCloud& cloud, const std::vector<std::uint8_t>& bins);

/// The lowest plane that many seeds agree on (RANSAC, then least squares), or one with `support == 0` where none
/// is supported: too few seeds, or only planes that are too steep or not below the sensor.
GroundPlane fitScanPlane(const std::vector<GroundSeed>& seeds, const Eigen::Vector3f& sensor_origin,
                         const GroundParams& params);

/// Follows the ground outwards in each azimuth bin, seed by seed, and marks those that are reached without a step
/// although they may lie off the plane of the scan: ramps, dips, crowned roads. What only a few neighbouring bins show
/// is an obstacle and is not marked.
void followGround(const GroundPlane& scan_plane, std::vector<GroundSeed>& seeds);

/// Angle of (x, y) in [-pi, pi], within 0.3 deg: for choosing a sector, not for geometry.
float fastAtan2(float y, float x);

}  // namespace lidar_obstacles
