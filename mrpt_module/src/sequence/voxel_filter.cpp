// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/voxel_filter.h"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "scan/neighbour_support.h"
#include "scan/ring_elevations.h"
#include "sequence/voxel_key.h"

namespace lidar_obstacles {
namespace {

constexpr std::uint64_t kHalf = std::uint64_t{1} << (kVoxelBits - 1);

std::size_t powerOfTwoAbove(std::size_t n) {
    std::size_t size = 1;
    while (size < n) size *= 2;
    return size;
}

int bits(std::uint32_t word) { return static_cast<int>(std::bitset<32>(word).count()); }

/// The cell nearest to `around` among those of that key.
VoxelIndex cellOf(std::uint64_t key, const VoxelIndex& around) {
    VoxelIndex cell;
    for (int k = 0; k < 3; ++k) {
        const std::uint64_t steps =
            ((key >> (k * kVoxelBits)) - static_cast<std::uint64_t>(around[k]) + kHalf) & kVoxelMask;
        cell[k] = around[k] + static_cast<std::int64_t>(steps) - static_cast<std::int64_t>(kHalf);
    }
    return cell;
}

/// Up to which range the next ring meets the same voxel, for each ring [m].
std::vector<float> nearOfRings(const PointCloud& cloud, double resolution) {
    constexpr float kLeast = 1e-3f;  // between two rings [rad]
    const RingElevations rings(cloud);
    std::vector<float> near;
    for (int ring = 0; ring < std::max(1, cloud.view.rings); ++ring) {
        const float step = std::min(rings.stepUp(ring), rings.stepDown(ring));
        near.push_back(static_cast<float>(resolution) / std::max(step, kLeast));
    }
    return near;
}

}  // namespace

VoxelFilter::VoxelFilter(const OctomapParams& params)
    : params_(params), table_(powerOfTwoAbove(2 * static_cast<std::size_t>(params.max_voxels))) {}

void VoxelFilter::clear() {
    std::fill(table_.begin(), table_.end(), Voxel{});
    count_ = 0;
}

VoxelFilter::Voxel& VoxelFilter::slotOf(std::uint64_t key) {
    std::size_t at = placeOf(key, table_.size());
    while (table_[at].key != key && table_[at].key != kNone) at = (at + 1) & (table_.size() - 1);
    return table_[at];
}

std::uint32_t VoxelFilter::historyAt(const Voxel& voxel) const {
    const std::uint32_t age = scan_ - voxel.last;
    if (age >= static_cast<std::uint32_t>(params_.history)) return 0;
    const std::uint32_t window = params_.history == 32 ? ~0U : (1U << static_cast<unsigned>(params_.history)) - 1U;
    return (voxel.hits << age) & window;
}

/// Marks a voxel as hit in this scan; returns in how many of the last ones it was.
int VoxelFilter::hit(std::uint64_t key) {
    Voxel& voxel = slotOf(key);
    if (voxel.key == kNone) {
        if (count_ >= static_cast<std::size_t>(params_.max_voxels)) return 0;
        voxel.key = key;
        voxel.last = scan_;
        voxel.hits = 0;
        ++count_;
    }
    voxel.hits = historyAt(voxel) | 1U;
    voxel.last = scan_;
    return bits(voxel.hits);
}

/// The same of the voxel at a place, vehicle frame of this scan [m].
int VoxelFilter::hitAt(const Eigen::Vector3f& p_vehicle) {
    return hit(keyOf(cellAt(T_world_vehicle_ * p_vehicle.cast<double>(), params_.resolution)));
}

/// Takes out what nobody remembers any more; if that leaves more than half, also what was hit longest ago.
void VoxelFilter::sweep() {
    std::vector<Voxel> old(table_.size());
    std::swap(old, table_);
    std::vector<std::size_t> of_age(static_cast<std::size_t>(params_.history) + 1, 0);
    for (const Voxel& voxel : old)
        if (voxel.key != kNone) ++of_age[std::min<std::size_t>(scan_ - voxel.last, of_age.size() - 1)];
    std::size_t kept = 0;
    std::uint32_t oldest = 0;  // ages below this one stay
    while (oldest + 1 < of_age.size() && kept + of_age[oldest] <= static_cast<std::size_t>(params_.max_voxels) / 2)
        kept += of_age[oldest++];
    count_ = 0;
    for (const Voxel& voxel : old) {
        if (voxel.key == kNone || scan_ - voxel.last >= oldest) continue;
        slotOf(voxel.key) = voxel;
        ++count_;
    }
}

/// The next scan, from that pose.
void VoxelFilter::begin(const Eigen::Isometry3d& T_world_vehicle) {
    ++scan_;
    T_world_vehicle_ = T_world_vehicle;
    const bool full = 4 * count_ > 3 * static_cast<std::size_t>(params_.max_voxels);
    if (full || scan_ % static_cast<std::uint32_t>(2 * params_.history) == 0) sweep();
}

std::vector<std::int32_t> VoxelFilter::filter(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                                              const std::optional<Eigen::Isometry3d>& T_world_vehicle) {
    const float reach = static_cast<float>(params_.range);
    const std::vector<std::uint8_t> supported = supportedInSpace(cloud, candidates, params_);
    const std::vector<float> near = nearOfRings(cloud, params_.resolution);
    if (T_world_vehicle) begin(*T_world_vehicle);
    std::vector<std::int32_t> kept;
    kept.reserve(candidates.size());
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const std::int32_t i = candidates[k];
        const float range = (cloud.xyz[i] - cloud.originOf(i)).norm();
        const bool beyond = range > reach;
        const bool often = !beyond && T_world_vehicle && hitAt(cloud.xyz[i]) >= params_.min_hits;
        const bool in_time = often && range > near[cloud.view.empty() ? 0 : cloud.ring[i]];
        const bool stays = beyond ? params_.beyond == BeyondRange::Keep : supported[k] != 0 || in_time;
        if (stays) kept.push_back(i);
    }
    return kept;
}

std::vector<Eigen::Vector3f> VoxelFilter::supportingVoxels() const {
    std::vector<Eigen::Vector3f> centres;
    const Eigen::Isometry3d T_vehicle_world = T_world_vehicle_.inverse();
    const VoxelIndex here = cellAt(T_world_vehicle_.translation(), params_.resolution);
    for (const Voxel& voxel : table_) {
        if (voxel.key == kNone || bits(historyAt(voxel)) < params_.min_hits) continue;
        const Eigen::Vector3d middle = cellOf(voxel.key, here).cast<double>() + Eigen::Vector3d::Constant(0.5);
        centres.emplace_back((T_vehicle_world * (middle * params_.resolution)).cast<float>());
    }
    return centres;
}

}  // namespace lidar_obstacles
