// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The vehicle's motion where nobody tells it: from the ground and the surfaces of scan after scan.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lidar_obstacles/motion.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What became of a scan.
enum class MatchState : std::uint8_t {
    First,    ///< nothing before it to be matched with
    Matched,  ///< its pose was measured
    Bridged,  ///< only a part was measured: along one direction the vehicle is taken to go on as before
    Lost      ///< no place fits it, or nothing told one direction for longer than `ego.max_gap`
};
inline constexpr int kMatchStateCount = 4;

/// "first", "matched", "bridged" or "lost".
const char* toString(MatchState state);

/// How a scan was matched.
struct ScanMatch {
    MatchState state = MatchState::First;
    std::vector<StampedPose> poses;  ///< that are known now and were not before, stamps rise
    bool restarted = false;          ///< poses before have another frame
    double residual = 0.0;           ///< median distance of returns from the surface they were laid on [m]
    double overlap = 0.0;            ///< share of the returns that were laid on one
    /// Standard deviation of the place along the direction that is known least [m].
    double weakest = 0.0;
};

/// True if `[ego] source` asks for it.
inline bool matchesScans(const EgoParams& ego) { return ego.source == "matching"; }

/// Lays each scan onto what the scans before it saw (a map of small cells around the vehicle), so that errors do not
/// add up from scan to scan.
///
/// Ground returns give height, pitch and roll; what stands gives place and yaw, seen from above. The returns of a scan
/// are straightened by the motion so far to the middle of its time, to which the pose belongs. A return that fits
/// nothing counts little, so what moves does not pull as long as most stands. World frame: the vehicle frame at the
/// first scan. Deterministic.
///
/// Where all surfaces run along one direction (a tunnel, a road between walls), the scan does not tell how far the
/// vehicle went along it: it is taken to go on as before, for `ego.max_gap` at most, and each such scan says so.
/// An object is for one thread at a time.
class ScanMatcher {
  public:
    /// @param own_body  its returns are left out (own_body.h).
    ScanMatcher(const EgoParams& ego, const std::string& own_body);
    ~ScanMatcher();
    ScanMatcher(ScanMatcher&&) noexcept;
    ScanMatcher& operator=(ScanMatcher&&) noexcept;

    /// Where the vehicle was in the middle of this scan. The first pose comes with the second scan. A gap longer than
    /// `ego.max_gap` or time that does not rise begins anew.
    /// @param cloud  vehicle frame [m], not straightened; an empty one is Lost.
    ScanMatch match(const PointCloud& cloud);

    /// Adds the scan matched last to what the next ones are laid on. To be called after each match().
    /// @param ground  that of the same scan (segmentGround).
    /// @param left_out  returns of it that are not to be used, as they are on something that moves.
    void learn(const GroundModel& ground, const std::vector<std::int32_t>& left_out);

    void restart();

  private:
    class Memory;
    std::unique_ptr<Memory> memory_;
};

}  // namespace lidar_obstacles
