// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace lidar_obstacles {

/// Bodies have no deeper notches than this, seen from above: wheel arches, mirrors, handles [m].
constexpr float kNotchDepth = 0.2f;

/// Neighbours of a ring are at most so many columns apart.
constexpr int kNeighbourColumns = 3;

/// Through windows beams reach what is inside: notches are believed below this height above the ground only [m].
constexpr float kBelowWindows = 0.8f;

/// A return of one ring seen from its sensor, from above, in a frame that looks about where it is. `u` and `v` keep
/// straight lines straight, and order returns by azimuth and by nearness.
struct ProfilePoint {
    float range;  ///< horizontal [m]
    float u;      ///< how far across per metre ahead
    float v;      ///< 1 / how far ahead [1/m]
};

/// @param p  a return, from its sensor [m].
/// @param ahead  direction that the profile looks in, unit length.
/// @return  none of what is more than 72 degrees to a side of it.
std::optional<ProfilePoint> profilePointOf(const Eigen::Vector2f& p, const Eigen::Vector2f& ahead);

/// How far behind the line between nearer returns on both sides each one lies [m]; 0 of the nearest ones
/// and of all where they bulge outwards.
/// @param profile  of one ring, in any order.
std::vector<float> depthsOf(const std::vector<ProfilePoint>& profile);

/// The depth of the notch between neighbours `k - 1` and `k` [m]: that of the farther one, if the other one is nearer
/// by more than kNotchDepth; else 0.
/// @param depth  depthsOf(profile).
float notchBetween(const std::vector<ProfilePoint>& profile, const std::vector<float>& depth, std::size_t k);

}  // namespace lidar_obstacles
