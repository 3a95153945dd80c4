// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/static_map.h"

#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

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

/// In which scans a voxel was hit, from the first hit on.
struct Sightings {
    int hits = 0;         ///< scans
    int passes = 0;       ///< scans that only looked through it
    int times = 0;        ///< that it was hit anew after it had been looked through
    int run = 0;          ///< passes since the last hit
    int longest_run = 0;  ///< of passes

    void hit() {
        times += hits == 0 || run > 0;
        ++hits;
        run = 0;
    }
    void pass() {
        ++passes;
        longest_run = std::max(longest_run, ++run);
    }
    double share() const { return static_cast<double>(hits) / static_cast<double>(hits + passes); }
};

/// True for leaves, fences, twigs: hit by chance again and again, as beams go through them. What came and went was hit
/// in a row and then no more: a gap so long, or hits so close together, would be a strange chance.
bool isPorous(const Sightings& s) {
    constexpr int kTimes = 3;
    constexpr double kLeastShare = 0.05;  // less is what passes by now and then
    constexpr double kChance = 0.05;
    if (s.times < kTimes || s.share() < kLeastShare) return false;
    const double gaps_so_long = s.hits * std::pow(1.0 - s.share(), s.longest_run);
    return gaps_so_long > kChance && s.times > 0.5 * s.hits * (1.0 - s.share());
}

}  // namespace

StaticMap::StaticMap(const OctomapParams& params) : params_(params), tree_(load(params.map)) {}
StaticMap::~StaticMap() = default;
StaticMap::StaticMap(StaticMap&&) noexcept = default;
StaticMap& StaticMap::operator=(StaticMap&&) noexcept = default;

double StaticMap::resolution() const { return tree_->getResolution(); }
std::size_t StaticMap::size() const { return tree_->size(); }

bool StaticMap::isKnown(const Eigen::Vector3d& p_world, double margin) const {
    octomap::OcTreeKey own;
    if (!tree_->coordToKeyChecked(toOctomap(p_world), own)) return false;  // farther away than any map reaches
    const auto isOccupied = [this](const octomap::OcTreeKey& key) {
        const octomap::OcTreeNode* node = tree_->search(key);
        return node && node->getOccupancy() >= params_.min_probability;
    };
    if (isOccupied(own)) return true;
    for (int axis = 0; axis < 3; ++axis) {
        octomap::OcTreeKey key = own;
        const int last = tree_->coordToKey(p_world[axis] + margin);
        for (int k = tree_->coordToKey(p_world[axis] - margin); k <= last; ++k) {
            key[axis] = static_cast<octomap::key_type>(k);
            if (k != own[axis] && isOccupied(key)) return true;
        }
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
        const bool stays = beyond ? params_.beyond == BeyondRange::Keep
                                  : !isKnown(T_world_vehicle * cloud.xyz[i].cast<double>(), params_.margin);
        if (stays) kept.push_back(i);
    }
    return kept;
}

double StaticMap::shareBeside(const PointCloud& cloud, const std::vector<std::int32_t>& returns,
                              const Eigen::Isometry3d& T_world_vehicle) const {
    constexpr std::size_t kAsked = 32;  // of many returns so many tell enough
    const std::size_t every = returns.size() / kAsked + 1;
    std::size_t asked = 0, beside = 0;
    for (std::size_t k = 0; k < returns.size(); k += every, ++asked) {
        const Eigen::Vector3d p = T_world_vehicle * cloud.xyz[returns[k]].cast<double>();
        beside += isKnown(p, resolution());
    }
    return asked == 0 ? 0.0 : static_cast<double>(beside) / static_cast<double>(asked);
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

struct StaticMapBuilder::Counts {
    std::unordered_map<octomap::OcTreeKey, Sightings, octomap::OcTreeKey::KeyHash> of;
};

StaticMapBuilder::StaticMapBuilder(double resolution, double range)
    : range_(range), tree_(std::make_unique<octomap::OcTree>(resolution)), counts_(std::make_unique<Counts>()) {}
StaticMapBuilder::~StaticMapBuilder() = default;

std::size_t StaticMapBuilder::size() const { return tree_->size(); }

void StaticMapBuilder::insert(const PointCloud& cloud, const Eigen::Isometry3d& T_world_vehicle) {
    const double reach = 32768.0 * tree_->getResolution() - 2.0 * range_;  // 16 bits per axis
    if (!(T_world_vehicle.translation().cwiseAbs().maxCoeff() < reach))
        throw std::runtime_error("the vehicle is more than " + std::to_string(static_cast<int>(reach / 1000.0)) +
                                 " km from the origin of its poses: too far for a map of this resolution");
    octomap::KeySet passed, hit;
    std::size_t i = 0;
    for (const SensorRays& sensor : cloud.allSensors()) {
        octomap::Pointcloud points;
        points.reserve(cloud.size());
        for (; i < static_cast<std::size_t>(sensor.end); ++i)
            points.push_back(toOctomap(T_world_vehicle * cloud.xyz[i].cast<double>()));
        const octomap::point3d origin = toOctomap(T_world_vehicle * sensor.origin.cast<double>());
        octomap::KeySet passed_by_one, hit_by_one;
        tree_->computeDiscreteUpdate(points, origin, passed_by_one, hit_by_one, range_);
        passed.insert(passed_by_one.begin(), passed_by_one.end());
        hit.insert(hit_by_one.begin(), hit_by_one.end());
    }
    for (const octomap::OcTreeKey& key : hit) passed.erase(key);  // one sensor's hit outweighs another's way through
    constexpr bool kLazy = true;
    for (const octomap::OcTreeKey& key : passed) {
        tree_->updateNode(key, false, kLazy);
        const auto known = counts_->of.find(key);
        if (known != counts_->of.end()) known->second.pass();
    }
    for (const octomap::OcTreeKey& key : hit) {
        tree_->updateNode(key, true, kLazy);
        counts_->of[key].hit();
    }
}

/// What is porous is there, however often beams went through it: the more often it was hit, the surer.
void StaticMapBuilder::markPorous() {
    constexpr double kLeast = 0.6, kMost = 0.97;
    for (const auto& [key, seen] : counts_->of) {
        octomap::OcTreeNode* node = tree_->search(key);
        if (!node || !isPorous(seen)) continue;
        const auto sure = static_cast<float>(octomap::logodds(kLeast + (kMost - kLeast) * seen.share()));
        if (node->getLogOdds() < sure) tree_->setNodeValue(key, sure, true);
    }
}

void StaticMapBuilder::save(const std::string& file) {
    const bool binary = endsWith(file, ".bt");
    if (!binary && !endsWith(file, ".ot")) throw std::invalid_argument(file + ": the name must end with .bt or .ot");
    markPorous();
    tree_->updateInnerOccupancy();
    const std::string part = file + ".part";  // a map of that name stays until this one is whole
    std::ofstream out(part, std::ios::binary);
    if (binary) tree_->toMaxLikelihood();
    tree_->prune();
    out << headOf(*tree_, binary);
    using Tree = octomap::OccupancyOcTreeBase<octomap::OcTreeNode>;
    // named in full: the virtual one is the library's, which was built to tell standard error of it
    binary ? tree_->Tree::writeBinaryData(out) : tree_->writeData(out);
    out.close();
    std::error_code problem;
    if (out) std::filesystem::rename(part, file, problem);
    if (out && !problem) return;
    std::filesystem::remove(part, problem);
    throw std::runtime_error(file + ": cannot write");
}

}  // namespace lidar_obstacles
