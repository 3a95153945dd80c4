// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A map of what stands still, built beforehand by ray casting (OctoMap): what is in it is no obstacle any more.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace octomap {
class OcTree;
}

namespace lidar_obstacles {

/// A map for reading. World frame: that of the poses it was built with.
/// Its const members may be called by several threads at a time.
class StaticMap {
  public:
    /// Loads `params.map`, a .bt or .ot file as OctoMap and octovis write them.
    /// @throws std::runtime_error naming the file if it cannot be read or is no such map.
    explicit StaticMap(const OctomapParams& params);
    ~StaticMap();
    StaticMap(StaticMap&&) noexcept;
    StaticMap& operator=(StaticMap&&) noexcept;

    /// The candidates that are not in the map: not in a voxel at least `min_probability` likely occupied, nor within
    /// `margin` of one. Those farther from the sensor than `range` are kept or dropped, as `beyond` says.
    std::vector<std::int32_t> filter(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                                     const Eigen::Isometry3d& T_world_vehicle) const;

    /// The share of some returns that lie in or right beside a known voxel (the six around it); 0 for none.
    double shareBeside(const PointCloud& cloud, const std::vector<std::int32_t>& returns,
                       const Eigen::Isometry3d& T_world_vehicle) const;

    /// Centres of the known voxels within `range` of the vehicle, vehicle frame [m]; for pictures.
    std::vector<Eigen::Vector3f> voxelsAround(const Eigen::Isometry3d& T_world_vehicle) const;
    double resolution() const;  ///< of the map [m]
    std::size_t size() const;   ///< nodes of the tree

  private:
    /// Is the voxel of a place occupied, or one beside it, along an axis of the map, that begins within the margin?
    bool isKnown(const Eigen::Vector3d& p_world, double margin) const;

    OctomapParams params_;
    std::unique_ptr<octomap::OcTree> tree_;
};

/// Builds a map: every return is a hit, every ray up to it clears what it crosses, so that what moved away is gone. But
/// what is hit again and again although beams go through it (leaves, fences) stays in the map, with a probability of
/// 0.6 upwards that grows with the share of scans that hit it. Some tenths of a second per scan: offline work.
/// An object is for one thread at a time.
class StaticMapBuilder {
  public:
    /// @param resolution  edge of a voxel [m]; @param range  longer rays clear up to there only [m].
    StaticMapBuilder(double resolution, double range);
    ~StaticMapBuilder();

    /// @param cloud  vehicle frame, de-skewed [m].
    void insert(const PointCloud& cloud, const Eigen::Isometry3d& T_world_vehicle);
    /// Writes a .bt (occupied or free) or .ot (with probabilities) file, by the name's ending.
    /// @throws std::runtime_error naming the file if it cannot be written; std::invalid_argument for other endings.
    void save(const std::string& file);
    std::size_t size() const;  ///< nodes of the tree

  private:
    struct Counts;
    void markPorous();

    double range_;
    std::unique_ptr<octomap::OcTree> tree_;
    std::unique_ptr<Counts> counts_;  ///< of the voxels that were hit
};

}  // namespace lidar_obstacles
