// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What was counted of boxes as they were told: their class, whether a box stays the same box, how fast it is said to
/// go. Results of several sets add up; objects and tracks of two sets are never the same.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/evaluation/truth.h"

namespace lidar_obstacles::evaluation {

/// Whom classes and tracks are judged for. Person: pedestrians and cyclists together, either class accepted.
enum class JudgedGroup : std::uint8_t { Vehicle, Pedestrian, Cyclist, Person };
constexpr std::array<JudgedGroup, 4> kJudgedGroups = {JudgedGroup::Vehicle, JudgedGroup::Pedestrian,
                                                      JudgedGroup::Cyclist, JudgedGroup::Person};

/// "vehicle", "pedestrian", "cyclist" or "person".
const char* toString(JudgedGroup group);
bool belongsTo(Group group, JudgedGroup judged);

/// A box of a class, which stands on an object of that class or not.
struct Claim {
    double probability = 0.0;  ///< as told; NaN: not told
    bool right = false;
};

/// Boxes with their class, in order of their probability within each scan, each object taken once (as nuScenes and
/// KITTI do).
struct ClassCounts {
    std::size_t asked = 0;  ///< objects in scans
    std::vector<Claim> claims;
    /// Wrong claims by what they stand on: "again" (an object that has its box), "other class" or "nothing".
    std::map<std::string, std::size_t> wrong;

    std::size_t right() const;
    double precision() const;  ///< 0 without claims
    double recall() const;     ///< 0 if nothing was asked for
    double f1() const;
    /// Area under precision over recall; nullopt if a claim has no probability, or there is none.
    std::optional<double> averagePrecision() const;
    /// Expected calibration error over ten bins of probability; nullopt as above.
    std::optional<double> calibrationError() const;
};

/// Luiten et al., "HOTA", 2021. Similarity: overlap seen from above for vehicles; 1 - distance of the centres / 1 m for
/// people.
struct HotaCounts {
    static constexpr std::size_t kThresholds = 19;  ///< similarity .05, .10 .. .95
    std::array<double, kThresholds> found{};
    std::array<double, kThresholds> missed{};
    std::array<double, kThresholds> invented{};
    std::array<double, kThresholds> association{};  ///< over the found: share of both tracks that is common

    double hota() const;  ///< the three: means over the thresholds
    double detection() const;
    double associationAccuracy() const;
};

/// Bernardin and Stiefelhagen, "CLEAR MOT", 2008, gated by the distance of the centres.
struct ClearCounts {
    std::size_t found = 0;
    std::size_t missed = 0;
    std::size_t invented = 0;
    std::size_t id_switches = 0;
    std::size_t fragmentations = 0;
    std::size_t objects = 0;
    std::size_t mostly_tracked = 0;  ///< objects found in 80 % of their scans or more

    double mota() const;
};

/// Of matched boxes whose track is 1 s old, or whose age is not told. Moving: faster than 1 m/s; standing: slower than
/// .1 m/s.
struct VelocityCounts {
    std::size_t asked = 0;
    std::size_t told = 0;                 ///< with a velocity
    std::vector<double> moving;           ///< length of the error of what moves [m/s]
    std::vector<double> standing;         ///< speed told of what stands [m/s]
    std::vector<bool> moving_called;      ///< of what moves: told to move
    std::vector<bool> standing_called;    ///< of what stands: told to move
    std::size_t headings_asked = 0;       ///< of what moves
    std::vector<double> heading_360_deg;  ///< of these, where the direction is known: error, 0 .. 180

    std::optional<double> ghosts() const;    ///< share of the standing that is told faster than .5 m/s
    std::optional<double> reversed() const;  ///< share of the headings that point backwards
};

/// How much the boxes of what stands change from one scan to the next.
struct JitterCounts {
    std::vector<double> yaw_deg;  ///< modulo 180
    std::vector<double> length;   ///< [m]
};

/// Everything about one group. Of tracks nothing is counted where ids repeat within a scan.
struct GroupTracking {
    ClassCounts classes;
    HotaCounts hota;
    ClearCounts clear;
    VelocityCounts velocity;
    JitterCounts jitter;
};

/// The longest time without a box of one object that was near.
struct BlindRun {
    std::string set;
    std::string object_id;
    std::size_t scans = 0;
};

/// The order of runs: longest first.
bool isLonger(const BlindRun& a, const BlindRun& b);

/// Near objects (EvaluationOptions::near) that no box of any class stood on.
struct BlindCounts {
    std::size_t asked = 0;  ///< near objects in scans
    std::size_t blind = 0;
    std::vector<BlindRun> runs;  ///< one per object that was without a box once, longest first

    double share() const;  ///< blind / asked; 0 if there were none
    std::size_t longestRun() const { return runs.empty() ? 0 : runs.front().scans; }
    std::size_t objectsBlindFor(std::size_t scans) const;  ///< so many scans or more in a row
};

/// Everything that was counted of one set, or of several together.
struct TrackingResult {
    std::size_t scans = 0;
    std::map<std::string, std::size_t> boxes;  ///< by class, those within the range
    BlindCounts blind;
    std::map<JudgedGroup, GroupTracking> groups;  ///< those with an object that was asked for
    std::string repeated_id;                      ///< which id is in one scan twice, and where; "": ids are unique

    void add(const TrackingResult& other);
};

/// Share of `true`; nullopt where there is none.
std::optional<double> shareOf(const std::vector<bool>& answers);

}  // namespace lidar_obstacles::evaluation
