// SPDX-License-Identifier: BSD-3-Clause
#include "scan/neighbour_support.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "scan/floor_to_int.h"

namespace lidar_obstacles {
namespace {

constexpr int kColumns = 2;  // azimuth steps to either side

/// How near a neighbour must be, squared [m^2].
float nearness(const PointCloud& cloud, std::int32_t i, const OctomapParams& params) {
    const float range = (cloud.xyz[i] - cloud.originOf(i)).norm();
    const float reach =
        static_cast<float>(params.neighbour_distance) + static_cast<float>(params.neighbour_per_metre) * range;
    return reach * reach;
}

/// Asks the next rings and azimuths of each candidate.
class ViewNeighbours {
  public:
    ViewNeighbours(const PointCloud& cloud, const std::vector<std::int32_t>& candidates, const OctomapParams& params)
        : cloud_(cloud), params_(params), candidate_(cloud.size(), 0) {
        for (const std::int32_t i : candidates) candidate_[i] = 1;
    }

    bool support(std::int32_t i) const {
        const float near = nearness(cloud_, i, params_);
        int found = 0;
        const int ring = cloud_.ring[i];
        const int last = std::min(cloud_.endRing(ring) - 1, ring + 1);
        for (int r = std::max(cloud_.firstRing(ring), ring - 1); r <= last; ++r) {
            found += countNear(i, r, near);
            if (found >= params_.min_neighbours) return true;
        }
        return false;
    }

  private:
    int countNear(std::int32_t i, int ring, float near) const {
        const OrganizedView& view = cloud_.view;
        const int middle = view.column_of[i];
        int found = 0;
        for (int step = -kColumns; step <= kColumns; ++step) {
            int column = middle + step;
            column += column < 0 ? view.columns : column >= view.columns ? -view.columns : 0;
            const std::int32_t j = view.at(ring, column);
            found += j >= 0 && j != i && candidate_[j] != 0 && (cloud_.xyz[j] - cloud_.xyz[i]).squaredNorm() <= near;
        }
        return found;
    }

    const PointCloud& cloud_;
    const OctomapParams& params_;
    std::vector<std::uint8_t> candidate_;
};

/// For sources without rings: candidates in cells as large as their neighbourhood, in powers of two. Each stands in the
/// cells of the next smaller and larger size too, where a neighbour across a change of size finds it.
class CellNeighbours {
  public:
    CellNeighbours(const PointCloud& cloud, const std::vector<std::int32_t>& candidates, const OctomapParams& params)
        : cloud_(cloud), params_(params) {
        for (const std::int32_t i : candidates) {
            const int level = levelOf(i);
            for (int l = level - 1; l <= level + 1; ++l) cells_[keyOf(cellOf(i, l), l)].push_back(i);
        }
    }

    bool support(std::int32_t i) const {
        const int level = levelOf(i);
        const float near = nearness(cloud_, i, params_);
        const Eigen::Vector3i middle = cellOf(i, level);
        int found = 0;
        for (int k = 0; k < 27; ++k) {
            const Eigen::Vector3i step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            const auto cell = cells_.find(keyOf(middle + step, level));
            if (cell == cells_.end()) continue;
            for (const std::int32_t j : cell->second) {
                found += j != i && (cloud_.xyz[j] - cloud_.xyz[i]).squaredNorm() <= near;
                if (found >= params_.min_neighbours) return true;
            }
        }
        return false;
    }

  private:
    int levelOf(std::int32_t i) const {
        return static_cast<int>(std::ceil(std::log2(std::max(0.01f, std::sqrt(nearness(cloud_, i, params_))))));
    }
    Eigen::Vector3i cellOf(std::int32_t i, int level) const {
        const Eigen::Vector3f p = cloud_.xyz[i] * std::ldexp(1.0f, -level);
        return {floorToInt(p.x()), floorToInt(p.y()), floorToInt(p.z())};
    }
    static std::uint64_t keyOf(const Eigen::Vector3i& cell, int level) {
        auto key = static_cast<std::uint64_t>(level) + 16;
        for (int k = 0; k < 3; ++k) key = key * 0x100000001B3ULL + static_cast<std::uint64_t>(cell[k]) + (1U << 20U);
        return key;
    }

    const PointCloud& cloud_;
    const OctomapParams& params_;
    std::unordered_map<std::uint64_t, std::vector<std::int32_t>> cells_;
};

template <class Neighbours>
std::vector<std::uint8_t> askEach(const Neighbours& neighbours, const std::vector<std::int32_t>& candidates) {
    std::vector<std::uint8_t> supported(candidates.size());
    for (std::size_t k = 0; k < candidates.size(); ++k) supported[k] = neighbours.support(candidates[k]) ? 1 : 0;
    return supported;
}

}  // namespace

std::vector<std::uint8_t> supportedInSpace(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                                           const OctomapParams& params) {
    if (cloud.view.empty()) return askEach(CellNeighbours(cloud, candidates, params), candidates);
    return askEach(ViewNeighbours(cloud, candidates, params), candidates);
}

}  // namespace lidar_obstacles
