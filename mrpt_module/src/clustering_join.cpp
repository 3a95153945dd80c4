#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>

#include "footprint.h"
#include "label_sets.h"
#include "lidar_obstacles/clustering.h"

namespace lidar_obstacles {
namespace {

bool fitsVehicle(const Footprint& a, const Footprint& b, const ClusteringParams& params) {
    const double longest = std::hypot(params.join_max_length, params.join_max_width);
    if (a.box.merged(b.box).sizes().maxCoeff() > longest) return false;
    const cv::Size2f size = cv::minAreaRect(joinOutlines(a, b)).size;
    return std::max(size.width, size.height) <= params.join_max_length &&
           std::min(size.width, size.height) <= params.join_max_width;
}

/// A narrow component that reaches from near the ground to a person's height stands by itself.
bool likePerson(const Cluster& cluster, const Footprint& footprint, const GroundModel& ground) {
    if (footprint.box.sizes().maxCoeff() > 1.0f) return false;
    float bottom = 1e9f;
    float top = 0.0f;
    for (const std::int32_t i : cluster.points) {
        bottom = std::min(bottom, ground.height[i]);
        top = std::max(top, ground.height[i]);
    }
    return bottom < 0.8f && top > 1.3f;
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
    const auto count = static_cast<int>(components.size());
    for (int c = 0; c < count; ++c) {
        for (const std::int32_t i : components[c].points) {
            if (ground.height[i] > kMaxHood || cloud.ring[i] + 1 >= cloud.view.rings) continue;
            const std::int32_t j = cloud.view.at(cloud.ring[i] + 1, cloud.view.column_of[i]);
            if (j < 0 || component[j] < 0 || component[j] == c) continue;
            const float run = (cloud.xyz[j].head<2>() - cloud.xyz[i].head<2>()).norm();
            if (run <= params.join_depth) ++steps[std::minmax(c, component[j])];
        }
    }
    return steps;
}

}  // namespace

std::vector<Cluster> joinFragments(std::vector<Cluster> components, const PointCloud& cloud, const GroundModel& ground,
                                   const ClusteringParams& params) {
    constexpr int kMinSteps = 3;
    if (cloud.view.empty()) return components;
    const auto steps = countSteps(components, cloud, ground, params);
    LabelSets sets(static_cast<int>(components.size()));
    std::vector<Footprint> footprints(components.size());
    const auto footprint = [&](int c) -> Footprint& {
        if (footprints[c].outline.empty()) footprints[c] = footprintOf(components[c].points, cloud);
        return footprints[c];
    };
    for (const auto& [pair, count] : steps) {
        const int a = sets.find(pair.first);
        const int b = sets.find(pair.second);
        if (count < kMinSteps || a == b) continue;
        if (!fitsVehicle(footprint(a), footprint(b), params)) continue;
        if (likePerson(components[pair.first], footprint(pair.first), ground) ||
            likePerson(components[pair.second], footprint(pair.second), ground))
            continue;
        const Footprint both{footprint(a).box.merged(footprint(b).box), joinOutlines(footprint(a), footprint(b))};
        sets.join(a, b);
        footprints[sets.find(a)] = both;
    }
    for (int c = static_cast<int>(components.size()) - 1; c >= 0; --c) {
        const int into = sets.find(c);
        if (into == c) continue;
        Cluster& target = components[into];
        target.points.insert(target.points.end(), components[c].points.begin(), components[c].points.end());
        components[c].points.clear();
    }
    components.erase(
        std::remove_if(components.begin(), components.end(), [](const Cluster& c) { return c.points.empty(); }),
        components.end());
    return components;
}

}  // namespace lidar_obstacles
