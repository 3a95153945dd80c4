// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What the grouping works on: pieces, what may be made of them, and what it found.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lidar_obstacles/obstacle.h"

namespace lidar_obstacles {

/// A connected component of occupied cells: the returns that fell into them.
struct Cluster {
    std::vector<std::int32_t> points;            ///< indices into the cloud
    float bottom = 0.0f;                         ///< height of the lowest return above the ground [m]
    float top = 0.0f;                            ///< of the highest, followed upwards beyond the region's limit [m]
    float max_top = 0.0f;                        ///< where the next ring passed above it [m]; infinite if none did
    ObstacleClass cls = ObstacleClass::Unknown;  ///< the most probable one
    ClassProbabilities probability{};            ///< all zero where nobody asked
    bool hangs = false;                          ///< it is high, and beams passed below it or most of it
    std::vector<Eigen::Vector2f> cells;  ///< centres of its cells [m]; set where a hull is to be fitted (addCells)
};

/// Why a cluster did not become a candidate for a road user.
enum class RejectReason : std::uint8_t { TooFewPoints, TooSmall, TooLow, TooLarge, Floating };

struct RejectedCluster {
    Cluster cluster;
    RejectReason reason = RejectReason::TooFewPoints;
    double measured = 0.0;  ///< what was measured against `limit`
    double limit = 0.0;
};

/// What the recognizer tells apart: the five classes as whole objects, and what is no whole object.
enum class Category : std::uint8_t {
    Unknown,
    Vehicle,
    Pedestrian,
    Cyclist,
    Structure,
    VehiclePart,  ///< of a vehicle of which more was seen
    PersonPart,   ///< of a person or rider
    Mixture,      ///< more than one thing
    Count
};
constexpr std::size_t kCategories = static_cast<std::size_t>(Category::Count);
using CategoryProbabilities = std::array<float, kCategories>;

/// How a group fits what earlier scans let expect there: both cover the same returns or do not.
struct ExpectedMatch {
    int object = -1;               ///< which of the objects expected; -1: none
    int inside = 0;                ///< the group's returns in its box
    int in_box = 0;                ///< all returns in its box
    ClassProbabilities classes{};  ///< of that object
};

/// What may be one object: a piece, or two hypotheses joined (merge_tree.h).
struct Hypothesis {
    std::vector<std::int32_t> points;  ///< indices into the cloud
    std::array<int, 2> part{-1, -1};   ///< hypotheses that it is made of; -1: it is a piece
    int parent = -1;                   ///< hypothesis that it is part of; -1: none
    int pieces = 1;                    ///< that it is made of
    int hanging = 0;                   ///< of these that are high, with beams below them
    float gap = 0.0f;                  ///< between its parts, as the scan could resolve it [m]
    float next_gap = 10.0f;            ///< to the nearest other one [m]; 10 where none is within reach
    ExpectedMatch expected;            ///< from earlier scans
    CategoryProbabilities category{};  ///< what it is
    ClassProbabilities probability{};  ///< of its class: parts count for theirs, mixtures are unknown
    float whole = 0.0f;                ///< probability that it is one object, all of it and nothing else
    float cut = 0.0f;                  ///< returns in whole objects, if it and its parts are cut in the best way
    bool chosen = false;               ///< in the best cut: it became a group
};

/// What the grouping found: groups that get a box each; what small boxes follow: structure, and what is likely several
/// things; and what was sorted out: ground, what can be passed under, noise, each with its reason.
struct Clusters {
    std::vector<Cluster> accepted;
    std::vector<Cluster> structure;
    std::vector<RejectedCluster> rejected;
};

/// What earlier scans let expect in this one: a track, where it should be by now.
struct ExpectedObject {
    OrientedBox box;   ///< vehicle frame [m]
    double std = 0.0;  ///< of its place [m]
    ClassProbabilities classes{};
};

/// "too_few_points", "too_small", "too_low", "too_large" or "floating".
const char* toString(RejectReason r);

}  // namespace lidar_obstacles
