// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Kerbs, low things, edges and overhangs at a distance ahead, and from where they are found.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lidar_obstacles/params.h"
#include "support/synthetic_scene.h"

namespace lidar_obstacles::test {

/// The defaults, and low things looked for.
inline DetectorParams lookingLow() {
    DetectorParams params;
    params.low.enabled = true;
    return params;
}

/// Something at a distance ahead; a robot of 0.7 m width drives there.
struct LowScene {
    const char* name;
    std::function<World(double distance)> at;
    double robot_height = 1.0;  ///< what hangs higher does not count [m]
    bool bar = false;           ///< it hangs: found if a zone with max_height = robot_height is occupied
};

const std::vector<LowScene>& lowScenes();

/// Distances at which a scene was looked at [m], and whether a zone ahead that ends just behind the thing was occupied
/// (or not free) in all scans there.
struct FoundAt {
    std::vector<double> distances;
    std::vector<bool> found;
};

/// Scans of a VLP-16 at this height, noise 2 cm, at distances from 0.8 to 8 m, in steps of this.
FoundAt foundFrom(const LowScene& scene, double sensor_height, double step = 0.2);

/// The stretches in which it was found: "1.0 to 3.2 m".
std::string toText(const FoundAt& found);

}  // namespace lidar_obstacles::test
