#include "lidar_obstacles/static_map.h"

#include <octomap/OcTree.h>

#include <array>
#include <filesystem>
#include <stdexcept>

namespace lidar_obstacles {
namespace {

octomap::point3d toOctomap(const Eigen::Vector3d& p) {
    return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

bool endsWith(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

std::unique_ptr<octomap::OcTree> load(const std::string& file) {
    if (file == "none") throw std::invalid_argument("[octomap] mode = static needs a map: [octomap] map = FILE");
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) throw std::runtime_error(file + ": no such file");
    auto tree = std::make_unique<octomap::OcTree>(0.1);
    if (endsWith(file, ".bt") && tree->readBinary(file)) return tree;
    if (endsWith(file, ".ot")) {
        std::unique_ptr<octomap::AbstractOcTree> any(octomap::AbstractOcTree::read(file));
        if (auto* read = dynamic_cast<octomap::OcTree*>(any.get())) {
            any.release();
            return std::unique_ptr<octomap::OcTree>(read);
        }
    }
    throw std::runtime_error(file + ": no OctoMap tree (.bt or .ot)");
}

}  // namespace

StaticMap::StaticMap(const OctomapParams& params) : params_(params), tree_(load(params.map)) {}
StaticMap::~StaticMap() = default;
StaticMap::StaticMap(StaticMap&&) noexcept = default;
StaticMap& StaticMap::operator=(StaticMap&&) noexcept = default;

double StaticMap::resolution() const { return tree_->getResolution(); }
std::size_t StaticMap::size() const { return tree_->size(); }

bool StaticMap::isOccupiedAt(const Eigen::Vector3d& p_world) const {
    const octomap::OcTreeNode* node = tree_->search(toOctomap(p_world));
    return node && node->getOccupancy() >= params_.min_probability;
}

bool StaticMap::isKnown(const Eigen::Vector3d& p_world) const {
    if (isOccupiedAt(p_world)) return true;
    // the voxels beside it that are nearer than the margin, one axis at a time
    const double resolution = tree_->getResolution();
    for (int axis = 0; axis < 3; ++axis) {
        const double inside = p_world[axis] / resolution - std::floor(p_world[axis] / resolution);
        Eigen::Vector3d beside = p_world;
        if (inside * resolution < params_.margin) {
            beside[axis] -= params_.margin;
        } else if ((1.0 - inside) * resolution < params_.margin) {
            beside[axis] += params_.margin;
        } else {
            continue;
        }
        if (isOccupiedAt(beside)) return true;
    }
    return false;
}

std::vector<std::int32_t> StaticMap::filter(const PointCloud& cloud, const std::vector<std::int32_t>& candidates,
                                            const Eigen::Isometry3d& T_world_vehicle) const {
    const auto range = static_cast<float>(params_.range);
    std::vector<std::int32_t> kept;
    kept.reserve(candidates.size());
    for (const std::int32_t i : candidates) {
        const bool beyond = (cloud.xyz[i] - cloud.sensor_origin).squaredNorm() > range * range;
        const bool stays =
            beyond ? params_.beyond == BeyondRange::Keep : !isKnown(T_world_vehicle * cloud.xyz[i].cast<double>());
        if (stays) kept.push_back(i);
    }
    return kept;
}

std::vector<Eigen::Vector3f> StaticMap::voxelsAround(const Eigen::Isometry3d& T_world_vehicle) const {
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(params_.range);
    const Eigen::Isometry3d T_vehicle_world = T_world_vehicle.inverse();
    const octomap::point3d low = toOctomap(T_world_vehicle.translation() - reach);
    const octomap::point3d high = toOctomap(T_world_vehicle.translation() + reach);
    std::vector<Eigen::Vector3f> centres;
    for (auto it = tree_->begin_leafs_bbx(low, high), end = tree_->end_leafs_bbx(); it != end; ++it) {
        if (it->getOccupancy() < params_.min_probability) continue;
        const octomap::point3d c = it.getCoordinate();
        centres.emplace_back((T_vehicle_world * Eigen::Vector3d(c.x(), c.y(), c.z())).cast<float>());
    }
    return centres;
}

StaticMapBuilder::StaticMapBuilder(double resolution, double range)
    : range_(range), tree_(std::make_unique<octomap::OcTree>(resolution)) {}
StaticMapBuilder::~StaticMapBuilder() = default;

std::size_t StaticMapBuilder::size() const { return tree_->size(); }

void StaticMapBuilder::insert(const PointCloud& cloud, const Eigen::Isometry3d& T_world_vehicle) {
    octomap::Pointcloud points;
    points.reserve(cloud.size());
    for (const Eigen::Vector3f& p : cloud.xyz) points.push_back(toOctomap(T_world_vehicle * p.cast<double>()));
    const octomap::point3d origin = toOctomap(T_world_vehicle * cloud.sensor_origin.cast<double>());
    constexpr bool kLazy = true, kDiscretize = true;
    tree_->insertPointCloud(points, origin, range_, kLazy, kDiscretize);
}

void StaticMapBuilder::save(const std::string& file) {
    const bool binary = endsWith(file, ".bt");
    if (!binary && !endsWith(file, ".ot")) throw std::invalid_argument(file + ": the name must end with .bt or .ot");
    tree_->updateInnerOccupancy();
    const bool written = binary ? tree_->writeBinary(file) : tree_->write(file);
    if (!written) throw std::runtime_error(file + ": cannot write");
}

}  // namespace lidar_obstacles
