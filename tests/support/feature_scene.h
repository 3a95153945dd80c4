// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Features of groups in built scenes.
#pragma once

#include <vector>

#include "lidar_obstacles/feature_extractor.h"
#include "objects/footprint.h"
#include "support/box_geometry.h"

namespace lidar_obstacles::test {

/// Flat ground and the boxes on it, seen by a sensor without noise.
inline Scan scanOf(const std::vector<OrientedBox>& boxes, const Sensor& sensor = {}) {
    World world = flatWorld();
    world.boxes = boxes;
    return castRays(world, sensor);
}

inline Hypothesis hypothesisOf(std::vector<std::int32_t> points) {
    Hypothesis h;
    h.points = std::move(points);
    return h;
}

inline FeatureVector featuresOf(const Scan& scan, const Hypothesis& h) {
    const GroundModel ground = knownGround(scan);
    const Beams beams(scan.cloud);
    return FeatureExtractor(beams, ground)(h, footprintOf(h.points, scan.cloud));
}

inline FeatureVector featuresOf(const Scan& scan, const std::vector<std::int32_t>& points) {
    return featuresOf(scan, hypothesisOf(points));
}

/// Of all returns on the first box.
inline FeatureVector featuresOf(const std::vector<OrientedBox>& boxes, const Sensor& sensor = {}) {
    const Scan scan = scanOf(boxes, sensor);
    return featuresOf(scan, scan.returnsOn(0));
}

inline float of(const FeatureVector& f, Feature k) { return f[static_cast<std::size_t>(k)]; }

/// A wall 5 cm thick whose near face lies at x, from y = `right` to `left`, from `bottom` to `top` [m].
inline OrientedBox wallAt(double x, double right, double left, double bottom, double top) {
    return {{x + 0.025, 0.5 * (left + right), 0.5 * (bottom + top)}, {0.05, left - right, top - bottom}, 0.0};
}

/// The returns on any of several boxes.
inline std::vector<std::int32_t> returnsOnAll(const Scan& scan, const std::vector<int>& boxes) {
    std::vector<std::int32_t> all;
    for (const int b : boxes)
        for (const std::int32_t i : scan.returnsOn(b)) all.push_back(i);
    return all;
}

/// Those returns of a box of which a condition on the place holds.
template <class Condition>
std::vector<std::int32_t> returnsWhere(const Scan& scan, int box, const Condition& holds) {
    std::vector<std::int32_t> some;
    for (const std::int32_t i : scan.returnsOn(box))
        if (holds(scan.cloud.xyz[i])) some.push_back(i);
    return some;
}

}  // namespace lidar_obstacles::test
