// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/surface_map.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "scan/median.h"
#include "sequence/voxel_key.h"

namespace lidar_obstacles {
namespace {

constexpr std::size_t kMaxCells = 30000;  // some 200 m of a street
constexpr std::size_t kSlots = 65536;
constexpr float kMemory = 60.0f;                // returns after which older ones fade
constexpr float kLeast = 3.0f;                  // returns that make a surface
constexpr std::int64_t kGroundLayer = 1 << 19;  // of keys: no scan is so high

/// The cell of a point and where it lies in it.
std::uint64_t locate(const Eigen::Vector3d& p, bool ground, Eigen::Vector3f& inside) {
    VoxelIndex cell = cellAt(p, SurfaceMap::kEdge);
    Eigen::Vector3d middle = (cell.cast<double>() + Eigen::Vector3d::Constant(0.5)) * SurfaceMap::kEdge;
    if (ground) {
        cell.z() = kGroundLayer;
        middle.z() = 0.0;
    }
    inside = (p - middle).cast<float>();
    return keyOf(cell);
}

void settle(SurfaceCell& c) {
    if (c.weight > kMemory) {
        const float fade = kMemory / c.weight;
        c.weight *= fade;
        c.sum *= fade;
        c.squares *= fade;
    }
    const float share = 1.0f / c.weight;
    c.mean = c.sum * share;
    const float xx = c.squares[0] * share - c.mean.x() * c.mean.x();
    const float xy = c.squares[1] * share - c.mean.x() * c.mean.y();
    const float yy = c.squares[2] * share - c.mean.y() * c.mean.y();
    c.spread << xx, xy, xy, yy;
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix2f> axes;
    axes.computeDirect(c.spread);
    c.across = axes.eigenvectors().col(0);
    c.variance = axes.eigenvalues().cwiseMax(0.0f);
}

}  // namespace

SurfaceMap::SurfaceMap() : table_(kSlots) { cells_.reserve(kMaxCells + kMaxCells / 4); }

void SurfaceMap::clear() {
    std::fill(table_.begin(), table_.end(), Slot{});
    cells_.clear();
    touched_.clear();
}

void SurfaceMap::begin() {
    ++scan_;
    touched_.clear();
    if (cells_.size() > kMaxCells) sweep();
}

/// Keeps the half that was hit last.
void SurfaceMap::sweep() {
    std::vector<std::uint32_t> ages;
    for (const SurfaceCell& c : cells_) ages.push_back(scan_ - c.last);
    const std::uint32_t oldest = medianOf(ages);
    const auto old = [&](const SurfaceCell& c) { return scan_ - c.last > oldest; };
    cells_.erase(std::remove_if(cells_.begin(), cells_.end(), old), cells_.end());
    std::fill(table_.begin(), table_.end(), Slot{});
    for (std::size_t k = 0; k < cells_.size(); ++k)
        table_[slotOf(cells_[k].key)] = {cells_[k].key, static_cast<std::uint32_t>(k)};
}

std::size_t SurfaceMap::slotOf(std::uint64_t key) const {
    std::size_t at = placeOf(key, table_.size());
    while (table_[at].key != key && table_[at].key != kNone) at = (at + 1) & (table_.size() - 1);
    return at;
}

void SurfaceMap::add(const Eigen::Vector3d& p, bool ground) {
    Eigen::Vector3f inside;
    const std::uint64_t key = locate(p, ground, inside);
    Slot& slot = table_[slotOf(key)];
    if (slot.key == kNone) {
        if (cells_.size() >= kMaxCells + kMaxCells / 4) return;  // far more than one scan adds
        slot = {key, static_cast<std::uint32_t>(cells_.size())};
        cells_.emplace_back();
        cells_.back().key = key;
    }
    SurfaceCell& c = cells_[slot.cell];
    if (c.last != scan_) touched_.push_back(slot.cell);
    c.last = scan_;
    c.weight += 1.0f;
    c.sum += inside;
    c.squares += Eigen::Vector3f(inside.x() * inside.x(), inside.x() * inside.y(), inside.y() * inside.y());
}

void SurfaceMap::finish() {
    for (const std::uint32_t k : touched_) settle(cells_[k]);
}

SurfaceHit SurfaceMap::find(const Eigen::Vector3d& p, bool ground) const {
    Eigen::Vector3f inside;
    const Slot& slot = table_[slotOf(locate(p, ground, inside))];
    if (slot.key == kNone || cells_[slot.cell].weight < kLeast) return {};
    const SurfaceCell& c = cells_[slot.cell];
    return {&c, inside - c.mean};
}

}  // namespace lidar_obstacles
