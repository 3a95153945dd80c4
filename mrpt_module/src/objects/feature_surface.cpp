// SPDX-License-Identifier: BSD-3-Clause
// The features of surfaces: what is around each return, and how near to a box's faces they lie.
#include <algorithm>
#include <cmath>

#include "lidar_obstacles/feature_extractor.h"
#include "objects/feature_tools.h"
#include "objects/quantiles.h"

namespace lidar_obstacles {

/// They are asked for once for each group that a return is in.
const FeatureExtractor::Neighbours& FeatureExtractor::neighboursOf(std::int32_t i) {
    Neighbours& n = neighbours_[i];
    if (known_[i] != 0) return n;
    known_[i] = 1;
    const PointCloud& cloud = beams_.cloud();
    const int ring = beams_.ring(i) + 1;
    n.next = beams_.beside(i, 1);
    n.above = ring < end_ring_ ? cloud.view.at(ring, beams_.column(i)) : -1;
    n.rough = beams_.roughness(i);
    n.jumps = n.next >= 0 && std::abs(beams_.range(n.next) - beams_.range(i)) > 0.3f + 0.02f * beams_.range(i);
    n.steep = false;
    if (n.above >= 0) {
        const Eigen::Vector3f rise = cloud.xyz[n.above] - cloud.xyz[i];
        n.steep = rise.z() > rise.head<2>().norm();
    }
    return n;
}

void FeatureExtractor::measureSurface(const std::vector<std::int32_t>& points, FeatureVector& f) {
    numbers_->clear();
    int pairs = 0, jumps = 0, steps = 0, steep = 0;
    for (std::size_t n = 0; n < points.size(); n += strideFor(points.size())) {
        const Neighbours& around = neighboursOf(points[n]);
        if (around.rough >= 0.0f) numbers_->add(around.rough);
        if (around.next >= 0 && mine(around.next)) {
            ++pairs;
            jumps += static_cast<int>(around.jumps);
        }
        if (around.above >= 0 && mine(around.above)) {
            ++steps;
            steep += static_cast<int>(around.steep);
        }
    }
    const float median = (*numbers_)(0.5f);
    at(f, Feature::RoughMetres) = median;
    at(f, Feature::RoughMedian) = std::min(50.0f, median / beams_.noise());
    at(f, Feature::RoughHigh) = std::min(100.0f, (*numbers_)(0.9f) / beams_.noise());
    at(f, Feature::Jumps) = share(jumps, pairs);
    at(f, Feature::Steep) = share(steep, steps);
}

/// How near the returns lie to the two sides of the rectangle that are turned to the sensor.
void FeatureExtractor::measureEdges(const Box& box, FeatureVector& f) {
    const Eigen::Vector2f sensor(box.along.dot(origin_.head<2>()), box.across.dot(origin_.head<2>()));
    const Eigen::Vector2f middle = box.extent.center();
    const Eigen::Vector2f seen(sensor.x() < middle.x() ? box.extent.min().x() : box.extent.max().x(),
                               sensor.y() < middle.y() ? box.extent.min().y() : box.extent.max().y());
    numbers_->clear();
    float sum = 0.0f;
    for (std::size_t n = 0; n < members_.size(); n += strideFor(members_.size())) {
        const Eigen::Vector2f p(members_[n].x, members_[n].y);
        const float d = std::min(std::abs(box.along.dot(p) - seen.x()), std::abs(box.across.dot(p) - seen.y()));
        numbers_->add(d);
        sum += d;
    }
    at(f, Feature::EdgeMean) = sum / static_cast<float>(numbers_->size());
    at(f, Feature::EdgeHigh) = (*numbers_)(0.9f);
}

}  // namespace lidar_obstacles
