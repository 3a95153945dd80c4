#include "lidar_obstacles/static_map.h"

#include <octomap/OcTree.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>

namespace lidar_obstacles {
namespace {

octomap::point3d toOctomap(const Eigen::Vector3d& p) {
    return {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
}

bool endsWith(const std::string& text, const std::string& end) {
    return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// The head of OctoMap's two formats, as its own tools write it (AbstractOcTree; those functions print).
std::string headOf(const octomap::OcTree& tree, bool binary) {
    std::ostringstream head;
    head.imbue(std::locale::classic());
    head << (binary ? "# Octomap OcTree binary file" : "# Octomap OcTree file")
         << "\n# (feel free to add / change comments, but leave the first line as it is!)\n#\nid OcTree\nsize "
         << tree.size() << "\nres " << tree.getResolution() << "\ndata\n";
    return head.str();
}

/// Reads that head up to the data; the resolution [m], or 0 if it is not one of an OcTree.
double readHead(std::istream& in) {
    in.imbue(std::locale::classic());
    std::string word, id;
    double resolution = 0.0;
    for (int words = 0; words < 100 && in >> word; ++words) {
        if (word == "data") {
            in.ignore(1);
            return id == "OcTree" ? resolution : 0.0;
        }
        if (word == "id") in >> id;
        if (word == "res") in >> resolution;
        if (word[0] == '#') in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    return 0.0;
}

std::unique_ptr<octomap::OcTree> load(const std::string& file) {
    if (file == "none") throw std::invalid_argument("[octomap] mode = static needs a map: [octomap] map = FILE");
    const bool binary = endsWith(file, ".bt");
    std::ifstream in(file, std::ios::binary);
    if (!in) throw std::runtime_error(file + ": cannot open the map");
    const double resolution = readHead(in);
    if (!(resolution > 0.0) || (!binary && !endsWith(file, ".ot")))
        throw std::runtime_error(file + ": no OctoMap tree (.bt or .ot)");
    auto tree = std::make_unique<octomap::OcTree>(resolution);
    binary ? tree->readBinaryData(in) : tree->readData(in);
    if (!in) throw std::runtime_error(file + ": the map is cut off");
    return tree;
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
        const bool beyond = (cloud.xyz[i] - cloud.originOf(i)).squaredNorm() > range * range;
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
    const double reach = 32768.0 * tree_->getResolution() - 2.0 * range_;  // 16 bits per axis
    if (!(T_world_vehicle.translation().cwiseAbs().maxCoeff() < reach))
        throw std::runtime_error("the vehicle is more than " + std::to_string(static_cast<int>(reach / 1000.0)) +
                                 " km from the origin of its poses: too far for a map of this resolution");
    std::size_t i = 0;
    for (const SensorRays& sensor : cloud.allSensors()) {
        octomap::Pointcloud points;
        points.reserve(cloud.size());
        for (; i < static_cast<std::size_t>(sensor.end); ++i)
            points.push_back(toOctomap(T_world_vehicle * cloud.xyz[i].cast<double>()));
        const octomap::point3d origin = toOctomap(T_world_vehicle * sensor.origin.cast<double>());
        constexpr bool kLazy = true, kDiscretize = true;
        tree_->insertPointCloud(points, origin, range_, kLazy, kDiscretize);
    }
}

void StaticMapBuilder::save(const std::string& file) {
    const bool binary = endsWith(file, ".bt");
    if (!binary && !endsWith(file, ".ot")) throw std::invalid_argument(file + ": the name must end with .bt or .ot");
    tree_->updateInnerOccupancy();
    std::ofstream out(file, std::ios::binary);
    if (binary) tree_->toMaxLikelihood();
    tree_->prune();
    out << headOf(*tree_, binary);
    using Tree = octomap::OccupancyOcTreeBase<octomap::OcTreeNode>;
    // named in full: the virtual one is the library's, which was built to tell standard error of it
    binary ? tree_->Tree::writeBinaryData(out) : tree_->writeData(out);
    out.close();
    if (!out) throw std::runtime_error(file + ": cannot write");
}

}  // namespace lidar_obstacles
