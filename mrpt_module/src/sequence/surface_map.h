// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What scans of a moving vehicle are matched with: the ground and the upright surfaces around, summed up in cells.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace lidar_obstacles {

/// What lies in one cell. Places are told from the cell's middle [m].
struct SurfaceCell {
    std::uint64_t key = 0;
    std::uint32_t last = 0;  ///< number of the scan that added to it last
    float weight = 0.0f;     ///< returns, those of long ago count less
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Vector3f squares = Eigen::Vector3f::Zero();  ///< sums of x x, x y, y y
    Eigen::Vector3f mean = Eigen::Vector3f::Zero();
    Eigen::Matrix2f spread = Eigen::Matrix2f::Zero();    ///< covariance seen from above [m^2]
    Eigen::Vector2f across = Eigen::Vector2f::UnitX();   ///< direction of the least spread, unit length
    Eigen::Vector2f variance = Eigen::Vector2f::Zero();  ///< across and along [m^2]
};

/// A cell and where a point lies from its mean [m].
struct SurfaceHit {
    const SurfaceCell* cell = nullptr;  ///< null: nothing is known there
    Eigen::Vector3f offset = Eigen::Vector3f::Zero();
};

/// Cells of 1 m around the way driven, in a hash table. Ground: the height over one square metre. What stands: where
/// its returns lie seen from above, for each metre of height, so that rings on a wall are one line whichever ring hits
/// it. Nothing is said of the direction in which rings on flat ground lie: they move with the vehicle.
class SurfaceMap {
  public:
    static constexpr double kEdge = 1.0;  ///< of a cell [m]

    SurfaceMap();

    void clear();
    /// The next scan; forgets what was not hit for longest where there is too much.
    void begin();
    void addGround(const Eigen::Vector3d& p) { add(p, true); }
    void addStanding(const Eigen::Vector3d& p) { add(p, false); }
    /// After the last return of a scan: only then what was added is found.
    void finish();

    SurfaceHit groundAt(const Eigen::Vector3d& p) const { return find(p, true); }
    SurfaceHit standingAt(const Eigen::Vector3d& p) const { return find(p, false); }
    std::size_t size() const { return cells_.size(); }

  private:
    struct Slot {
        std::uint64_t key = kNone;
        std::uint32_t cell = 0;
    };
    static constexpr std::uint64_t kNone = ~std::uint64_t{0};

    void add(const Eigen::Vector3d& p, bool ground);
    SurfaceHit find(const Eigen::Vector3d& p, bool ground) const;
    std::size_t slotOf(std::uint64_t key) const;
    void sweep();

    std::vector<Slot> table_;  ///< open addressing, a power of two
    std::vector<SurfaceCell> cells_;
    std::vector<std::uint32_t> touched_;  ///< cells that the scan added to
    std::uint32_t scan_ = 0;
};

}  // namespace lidar_obstacles
