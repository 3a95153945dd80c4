// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Takes out what is not there: rain, dust, mixed pixels. A rolling voxel map around the vehicle remembers in which of
/// the last scans each voxel was hit.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// A return stays if it is supported in space **or** in time:
/// * space: at least `min_neighbours` candidates of the same scan lie within neighbour_distance + neighbour_per_metre *
///   range of it. With rings and columns only the next ring and the next two azimuths to either side are asked.
/// * time: its voxel was hit in at least `min_hits` of the last `history` scans, this one included, ego motion undone.
///   Only where the rings of the sensor are farther apart than a voxel is large (VLP-16, 0.2 m: beyond 5.7 m): nearer,
///   so many beams cross a voxel that rain alone hits it in every scan, and what stands there supports itself in space.
///
/// So a new or fast obstacle, which is dense, is there from its first scan on, and a lone thin thing from its
/// `min_hits`-th on, nearer than that never. Hits only: nothing is ray-cast, a voxel that is not hit any more is
/// forgotten after `history` scans. Memory is bounded by `max_voxels`, whatever is driven through: where that is not
/// enough, the oldest hits go. Voxels lie on a raster of the world frame: as long as it is enough, what stays of a scan
/// depends on nothing but the `history` scans up to it.
/// An object is for one thread at a time.
class VoxelFilter {
  public:
    explicit VoxelFilter(const OctomapParams& params);

    /// The candidates that stay; then all of them are remembered.
    ///
    /// @param candidates  indices into the cloud, rising; none give none.
    /// @param T_world_vehicle  the scan's pose; nullopt where it is not known: support in space only, and the scan is
    ///     not remembered.
    std::vector<std::int32_t> filter(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                                     const std::optional<Eigen::Isometry3d>& T_world_vehicle);

    /// Forgets everything, e.g. after a jump of the poses.
    void clear();

    /// Voxels that are held, live ones and those not yet swept out.
    std::size_t size() const { return count_; }
    /// Centres of the voxels that are hit often enough, in the vehicle frame of the scan last remembered [m]; for
    /// pictures. Those next to the sensor support nothing nevertheless.
    std::vector<Eigen::Vector3f> supportingVoxels() const;
    double resolution() const { return params_.resolution; }

  private:
    struct Voxel {
        std::uint64_t key = kNone;
        std::uint32_t last = 0;  ///< number of the scan that hit it last
        std::uint32_t hits = 0;  ///< bit k: hit k scans before `last`
    };
    static constexpr std::uint64_t kNone = ~std::uint64_t{0};

    void begin(const Eigen::Isometry3d& T_world_vehicle);
    int hitAt(const Eigen::Vector3f& p_vehicle);
    int hit(std::uint64_t key);
    Voxel& slotOf(std::uint64_t key);
    std::uint32_t historyAt(const Voxel& voxel) const;
    void sweep();

    OctomapParams params_;
    std::vector<Voxel> table_;  ///< open addressing, a power of two, at most half full
    std::size_t count_ = 0;
    std::uint32_t scan_ = 0;
    Eigen::Isometry3d T_world_vehicle_ = Eigen::Isometry3d::Identity();  ///< of the scan last remembered
};

}  // namespace lidar_obstacles
