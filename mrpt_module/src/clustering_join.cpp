#include <algorithm>
#include <map>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "label_sets.h"
#include "lidar_obstacles/clustering.h"

namespace lidar_obstacles {
namespace {

using Hull = std::vector<cv::Point2f>;

Hull hullOf(const Cluster& cluster, const PointCloud& cloud) {
    Hull points;
    Hull hull;
    points.reserve(cluster.points.size());
    for (const std::int32_t i : cluster.points) points.emplace_back(cloud.xyz[i].x(), cloud.xyz[i].y());
    if (points.size() < 3) return points;
    cv::convexHull(points, hull);
    return hull;
}

bool fitsVehicle(const Hull& hull, const ClusteringParams& params) {
    const cv::Size2f size = cv::minAreaRect(hull).size;
    return std::max(size.width, size.height) <= params.join_max_length &&
           std::min(size.width, size.height) <= params.join_max_width;
}

/// A narrow component that reaches from near the ground to a person's height stands by itself.
bool likePerson(const Cluster& cluster, const Hull& hull, const GroundModel& ground) {
    float bottom = 1e9f;
    float top = 0.0f;
    for (const std::int32_t i : cluster.points) {
        bottom = std::min(bottom, ground.height[i]);
        top = std::max(top, ground.height[i]);
    }
    const cv::Size2f size = cv::minAreaRect(hull).size;
    return std::max(size.width, size.height) < 1.0f && bottom < 0.8f && top > 1.3f;
}

/// For each return the component it belongs to, or -1.
std::vector<int> componentOfReturn(const std::vector<Cluster>& components, std::size_t returns) {
    std::vector<int> component(returns, -1);
    for (std::size_t c = 0; c < components.size(); ++c)
        for (const std::int32_t i : components[c].points) component[i] = static_cast<int>(c);
    return component;
}

constexpr float kMaxHood = 1.2f;  // a beam that passes over something higher did not pass over a hood [m]

/// How many azimuth columns show one component right above and behind another: the next plane up passes over a hood
/// and hits the windscreen.
std::map<std::pair<int, int>, int> countSteps(const std::vector<Cluster>& components, const PointCloud& cloud,
                                              const GroundModel& ground, const ClusteringParams& params) {
    const std::vector<int> component = componentOfReturn(components, cloud.size());
    std::map<std::pair<int, int>, int> steps;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (component[i] < 0 || cloud.ring[i] + 1 >= cloud.view.rings) continue;
        if (ground.height[i] > kMaxHood) continue;
        const std::int32_t j = cloud.view.at(cloud.ring[i] + 1, cloud.view.column_of[i]);
        if (j < 0 || component[j] < 0 || component[j] == component[i]) continue;
        const float run = (cloud.xyz[j].head<2>() - cloud.xyz[i].head<2>()).norm();
        if (run <= params.join_depth) ++steps[std::minmax(component[i], component[j])];
    }
    return steps;
}

}  // namespace

std::vector<Cluster> joinFragments(std::vector<Cluster> components, const PointCloud& cloud,
                                   const GroundModel& ground, const ClusteringParams& params) {
    constexpr int kMinSteps = 3;
    if (cloud.view.empty()) return components;
    const auto steps = countSteps(components, cloud, ground, params);
    LabelSets sets(static_cast<int>(components.size()));
    std::vector<Hull> hulls(components.size());
    const auto hull = [&](int c) -> Hull& {
        if (hulls[c].empty()) hulls[c] = hullOf(components[c], cloud);
        return hulls[c];
    };
    for (const auto& [pair, count] : steps) {
        const int a = sets.find(pair.first);
        const int b = sets.find(pair.second);
        if (count < kMinSteps || a == b) continue;
        if (likePerson(components[pair.first], hull(pair.first), ground) ||
            likePerson(components[pair.second], hull(pair.second), ground))
            continue;
        Hull both = hull(a);
        both.insert(both.end(), hull(b).begin(), hull(b).end());
        if (!fitsVehicle(both, params)) continue;
        sets.join(a, b);
        hulls[sets.find(a)] = both;
    }
    for (int c = static_cast<int>(components.size()) - 1; c >= 0; --c) {
        const int into = sets.find(c);
        if (into == c) continue;
        Cluster& target = components[into];
        target.points.insert(target.points.end(), components[c].points.begin(), components[c].points.end());
        target.cells.insert(target.cells.end(), components[c].cells.begin(), components[c].cells.end());
        components[c].points.clear();
    }
    components.erase(std::remove_if(components.begin(), components.end(), [](const Cluster& c) { return c.points.empty(); }),
                     components.end());
    return components;
}

}  // namespace lidar_obstacles
