// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/own_body_learner.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace lidar_obstacles {
namespace {

constexpr std::size_t kEnough = 20;     // scans; fewer are no evidence
constexpr double kInPlace = 0.8;        // share of the scans in which what is in place is hit
constexpr double kNow = 0.1;            // and in which a voxel of it is hit itself
constexpr double kStandingShare = 0.5;  // a world that is in place to this share stands still around the vehicle
constexpr double kBodyReach = 10.0;     // of a vehicle ahead and behind [m]
constexpr double kAside = 3.0;          // and to either side: farther out walls along the road would pass for it [m]
constexpr double kVoxel = 0.1;          // [m]
constexpr double kLowest = -2.0;        // of the voxels [m]
constexpr int kLong = 200, kWide = 60, kHigh = 70;
constexpr double kCell = 0.5;     // of the world around [m]
constexpr double kAround = 30.0;  // [m]
constexpr int kCells = 120;

/// Column, row and layer of a voxel.
struct Voxel {
    int x = 0, y = 0, z = 0;

    std::size_t number() const { return (static_cast<std::size_t>(z) * kWide + y) * kLong + x; }
    /// Inside, with a voxel on every side.
    bool isInner() const { return x > 0 && x < kLong - 1 && y > 0 && y < kWide - 1 && z > 0 && z < kHigh - 1; }
};

Voxel voxelAt(const Eigen::Vector3f& p) {
    const auto index = [](float value, double low) {
        return static_cast<int>(std::floor((static_cast<double>(value) - low) / kVoxel));
    };
    return {index(p.x(), -kBodyReach), index(p.y(), -kAside), index(p.z(), kLowest)};
}

/// Calls `visit` for a voxel and the 26 around it.
template <class Visit>
void forEachAround(const Voxel& v, Visit visit) {
    for (int k = 0; k < 27; ++k) visit(Voxel{v.x + k % 3 - 1, v.y + k / 3 % 3 - 1, v.z + k / 9 - 1});
}

constexpr std::size_t kVoxels = static_cast<std::size_t>(kLong) * kWide * kHigh;

/// Voxels from lowest to highest.
struct Block {
    Voxel low, high;
    std::size_t size = 0;

    void add(const Voxel& v) {
        if (size++ == 0) low = high = v;
        low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
        high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    }
};

/// Takes the voxels that hang together with `start` out of `in_place`.
Block takeBlock(const Voxel& start, std::vector<char>& in_place) {
    Block block;
    std::vector<Voxel> open{start};
    in_place[start.number()] = 0;
    while (!open.empty()) {
        const Voxel v = open.back();
        open.pop_back();
        block.add(v);
        forEachAround(v, [&](const Voxel& next) {
            if (in_place[next.number()] == 0) return;
            in_place[next.number()] = 0;
            open.push_back(next);
        });
    }
    return block;
}

/// As metres, rounded outwards to whole voxels.
OwnPart partOf(const Block& block) {
    const auto metres = [](int index, double low) { return std::round((low + index * kVoxel) * 10.0) / 10.0; };
    const double x0 = metres(block.low.x - 1, -kBodyReach), x1 = metres(block.high.x + 2, -kBodyReach);
    const double y0 = metres(block.low.y - 1, -kAside), y1 = metres(block.high.y + 2, -kAside);
    OwnPart part;
    part.is_box = true;
    part.outline = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
    part.z_min = metres(block.low.z - 1, kLowest);
    part.z_max = metres(block.high.z + 2, kLowest);
    return part;
}

}  // namespace

void OwnBodyLearner::Counts::hit(std::size_t cell, std::uint32_t scan) {
    if (std::exchange(last[cell], scan) == scan) return;
    if (scans[cell] < std::numeric_limits<std::uint16_t>::max()) ++scans[cell];
}

OwnBodyLearner::OwnBodyLearner() {
    for (Counts* counts : {&voxels_, &hits_}) {
        counts->last.assign(kVoxels, 0);
        counts->scans.assign(kVoxels, 0);
    }
    cells_.last.assign(static_cast<std::size_t>(kCells) * kCells, 0);
    cells_.scans.assign(cells_.last.size(), 0);
}

void OwnBodyLearner::add(const PointCloud& cloud, const std::vector<std::int32_t>& returns) {
    if (scans_ == std::numeric_limits<std::uint16_t>::max()) return;  // more would tell nothing new
    const auto scan = static_cast<std::uint32_t>(++scans_);
    for (const std::int32_t i : returns) {
        const Eigen::Vector3f& p = cloud.xyz[static_cast<std::size_t>(i)];
        const Eigen::Vector2d cell = (p.head<2>().cast<double>().array() + kAround) / kCell;
        if ((cell.array() >= 0.0).all() && (cell.array() < kCells).all())
            cells_.hit(static_cast<std::size_t>(cell.y()) * kCells + static_cast<std::size_t>(cell.x()), scan);
        const Voxel voxel = voxelAt(p);
        if (!voxel.isInner() || hits_.last[voxel.number()] == scan) continue;
        hits_.hit(voxel.number(), scan);
        forEachAround(voxel, [&](const Voxel& v) { voxels_.hit(v.number(), scan); });
    }
}

bool OwnBodyLearner::moved() const {
    if (scans_ < kEnough) return false;
    double hits = 0.0, in_place = 0.0;
    for (const std::uint16_t n : cells_.scans) {
        hits += n;
        in_place += static_cast<double>(n) * n / static_cast<double>(scans_);
    }
    return hits > 0.0 && in_place < kStandingShare * hits;
}

OwnBody OwnBodyLearner::learnt() const {
    if (!moved()) return {};
    std::vector<char> in_place(kVoxels, 0);
    const double enough = kInPlace * static_cast<double>(scans_), some = kNow * static_cast<double>(scans_);
    for (std::size_t k = 0; k < in_place.size(); ++k)
        in_place[k] = hits_.scans[k] >= some && voxels_.scans[k] >= enough ? 1 : 0;
    std::vector<Block> blocks;
    for (int z = 1; z < kHigh - 1; ++z)
        for (int k = 0; k < kLong * kWide; ++k) {
            const Voxel v{k % kLong, k / kLong, z};
            if (in_place[v.number()] != 0) blocks.push_back(takeBlock(v, in_place));
        }
    std::stable_sort(blocks.begin(), blocks.end(), [](const Block& a, const Block& b) { return a.size > b.size; });
    std::vector<OwnPart> parts;
    std::transform(blocks.begin(), blocks.end(), std::back_inserter(parts), partOf);
    return OwnBody(std::move(parts));
}

}  // namespace lidar_obstacles
