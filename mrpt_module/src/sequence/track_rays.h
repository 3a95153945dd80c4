// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where beams went that should have hit a box: the proof that nothing is there, or that nothing is proven.
#pragma once

#include <array>
#include <vector>

#include "lidar_obstacles/types.h"
#include "sequence/track_view.h"

namespace lidar_obstacles {

/// Beams whose way leads through a box.
struct BeamCount {
    int passed = 0;   ///< returned from behind it
    int blocked = 0;  ///< returned from before it
    int hit = 0;      ///< returned from within
    int other = 0;    ///< of these, from what was taken for something else

    int all() const { return passed + blocked + hit; }
};

/// The beams of one scan, to be asked about boxes.
class BeamMap {
  public:
    /// Looks at another scan; the cloud must outlive the questions. Nothing is known of a scan without rings.
    /// @param other  one label per return, not 0 for what was taken for no road user, which must outlive them as well;
    ///               nullptr: nobody said.
    void look(const PointCloud* cloud, const std::uint8_t* other = nullptr);
    bool empty() const { return cloud_ == nullptr; }
    /// The beams that point at a box (vehicle frame).
    BeamCount through(const OrientedBox& box) const;

  private:
    static constexpr int kSectors = 120;
    struct Columns {
        int first = 0;
        int count = 0;
        int step = 1;
    };
    Columns columnsTowards(const OrientedBox& box, const Eigen::Vector3d& origin) const;
    void addBeams(const OrientedBox& box, const SensorRays& sensor, BeamCount& count) const;

    const PointCloud* cloud_ = nullptr;
    std::vector<SensorRays> sensors_;  ///< of the cloud
    const std::uint8_t* other_ = nullptr;
    std::array<std::int32_t, kSectors> column_of_sector_{};  ///< a column that looks into that sector of bearings
};

/// Share of a box's width, seen from the sensor, that boxes before it leave open: 0 (hidden) .. 1.
double openShare(const PlacedBox& box, const std::vector<PlacedBox>& others);

}  // namespace lidar_obstacles
