#include "lidar_obstacles/voxel_filter.h"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "floor_to_int.h"
#include "neighbour_support.h"
#include "ring_elevations.h"

namespace lidar_obstacles {
namespace {

constexpr int kBits = 21;  // of a key per axis: at 0.2 m they repeat every 400 km
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
constexpr int kHalf = 1 << (kBits - 1);

std::size_t powerOfTwoAbove(std::size_t n) {
    std::size_t size = 1;
    while (size < n) size *= 2;
    return size;
}

int bits(std::uint32_t word) { return static_cast<int>(std::bitset<32>(word).count()); }

/// Up to which range the next plane of the sensor meets the same voxel, for each plane [m].
std::vector<float> nearOfRings(const PointCloud& cloud, double resolution) {
    constexpr float kLeast = 1e-3f;  // between two planes [rad]
    const RingElevations planes(cloud);
    std::vector<float> near;
    for (int ring = 0; ring < std::max(1, cloud.view.rings); ++ring) {
        const float step = std::min(planes.stepUp(ring), planes.stepDown(ring));
        near.push_back(static_cast<float>(resolution) / std::max(step, kLeast));
    }
    return near;
}

Eigen::Vector3i cellOf(std::uint64_t key) {
    const auto axis = [key](int k) { return static_cast<int>((key >> (k * kBits)) & kMask) - kHalf; };
    return {axis(0), axis(1), axis(2)};
}

}  // namespace

VoxelFilter::VoxelFilter(const OctomapParams& params)
    : params_(params), table_(powerOfTwoAbove(2 * static_cast<std::size_t>(params.max_voxels))) {}

void VoxelFilter::clear() {
    std::fill(table_.begin(), table_.end(), Voxel{});
    count_ = 0;
    origin_.reset();
}

std::uint64_t VoxelFilter::keyOf(const Eigen::Vector3f& p_vehicle) const {
    const Eigen::Vector3f p = T_map_vehicle_ * p_vehicle * static_cast<float>(1.0 / params_.resolution);
    std::uint64_t key = 0;
    for (int k = 2; k >= 0; --k) key = (key << kBits) | (static_cast<std::uint64_t>(floorToInt(p[k]) + kHalf) & kMask);
    return key;
}

VoxelFilter::Voxel& VoxelFilter::slotOf(std::uint64_t key) {
    const std::size_t mask = table_.size() - 1;
    std::size_t at = (key * 0x9E3779B97F4A7C15ULL) >> 20U;
    while (table_[at & mask].key != key && table_[at & mask].key != kNone) ++at;
    return table_[at & mask];
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
    if (!origin_) origin_ = T_world_vehicle.translation();
    Eigen::Isometry3d T_map_vehicle = T_world_vehicle;
    T_map_vehicle.translation() -= *origin_;
    T_map_vehicle_ = T_map_vehicle.cast<float>();
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
        const float range = (cloud.xyz[i] - cloud.sensor_origin).norm();
        const bool beyond = range > reach;
        const bool often = !beyond && T_world_vehicle && hit(keyOf(cloud.xyz[i])) >= params_.min_hits;
        const bool in_time = often && range > near[cloud.view.empty() ? 0 : cloud.ring[i]];
        const bool stays = beyond ? params_.beyond == BeyondRange::Keep : supported[k] != 0 || in_time;
        if (stays) kept.push_back(i);
    }
    return kept;
}

std::vector<Eigen::Vector3f> VoxelFilter::supportingVoxels() const {
    std::vector<Eigen::Vector3f> centres;
    const Eigen::Isometry3f T_vehicle_map = T_map_vehicle_.inverse();
    const auto edge = static_cast<float>(params_.resolution);
    for (const Voxel& voxel : table_) {
        if (voxel.key == kNone || bits(historyAt(voxel)) < params_.min_hits) continue;
        centres.emplace_back(
            T_vehicle_map *
            Eigen::Vector3f((cellOf(voxel.key).cast<float>() + Eigen::Vector3f::Constant(0.5f)) * edge));
    }
    return centres;
}

}  // namespace lidar_obstacles
