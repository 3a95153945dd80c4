// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "lidar_obstacles/features.h"
#include "objects/merge_tree.h"

namespace lidar_obstacles {

/// What stands about the chosen groups of a tree, and what it was taken for. A piece of a hedge looks much like a car,
/// but stands among pieces of a hedge.
class Surroundings {
  public:
    /// @param tree  scored, measured and cut.
    explicit Surroundings(const MergeTree& tree);

    /// The features from Feature::ToldUnknown on. Nothing stands nearer than 12 m: shares and counts are 0.
    void measure(std::size_t hypothesis, FeatureVector& f) const;

  private:
    struct Group {
        std::size_t hypothesis = 0;
        Eigen::AlignedBox2f box;  ///< seen from above [m]
        float structure = 0.0f, vehicle = 0.0f, person = 0.0f;
        float size = 0.0f;                ///< log2 of its returns
        float weight = 0.0f;              ///< root of its returns
        float top = 0.0f, bottom = 0.0f;  ///< [m]
    };
    struct Near;
    static Group groupOf(std::size_t k, const MergeTree& tree);

    const MergeTree& tree_;
    std::vector<Group> groups_;  ///< in the order of the least x of their boxes
    float widest_ = 0.0f;        ///< of all boxes, along x [m]
};

}  // namespace lidar_obstacles
