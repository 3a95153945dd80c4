// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Scans of worlds built from planes and boxes: an analytic ray caster, so that tests know what each return lies on.
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "lidar_obstacles/types.h"

namespace lidar_obstacles::test {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline double radians(double deg) { return deg * M_PI / 180.0; }

/// z = offset + slope . (x, y) for x_min <= x < x_max.
struct GroundStrip {
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    double offset = 0.0;
    double x_min = -kInfinity;
    double x_max = kInfinity;

    double heightAt(double x, double y) const { return offset + slope.x() * x + slope.y() * y; }
};

struct World {
    std::vector<GroundStrip> ground;
    std::vector<OrientedBox> boxes;
};

/// A rotating sensor as the VLP-16 is: `planes` from `lowest_deg` in steps, `columns` firings per turn.
struct Sensor {
    int planes = 16;
    double lowest_deg = -15.0;
    double step_deg = 2.0;
    int columns = 1800;
    Eigen::Vector3d position{0.0, 0.0, 1.8};
    Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< of the sensor, on the vehicle: tilted, turned
    double max_range = 100.0;
    double noise = 0.0;  ///< standard deviation of the range [m]
    bool rings = true;   ///< false: neither ring numbers nor view, as from a source that does not tell
};

/// A sensor with few planes: every other one of a VLP-16 (8), those just below the horizon (4), or one at -5 deg, which
/// passes 0.93 m above the ground at 10 m.
Sensor fewPlanes(int planes);

/// What a return lies on: the index of a box of the world, or the ground.
constexpr int kOnGround = -1;

struct Scan {
    PointCloud cloud;
    std::vector<int> hit;  ///< for each return: kOnGround, or the index of the box

    std::vector<std::int32_t> returnsOn(int object) const;
    /// How many of these returns lie on an object.
    std::ptrdiff_t countOn(const std::vector<std::int32_t>& points, int object) const;
};

Scan castRays(const World& world, const Sensor& sensor);

/// The scan without the returns that a condition on their number names: black paint, glass, an outage.
template <class Condition>
Scan without(const Scan& scan, const Condition& lost) {
    Scan rest;
    rest.cloud.sensor_origin = scan.cloud.sensor_origin;
    rest.cloud.sensor_up = scan.cloud.sensor_up;
    rest.cloud.view = scan.cloud.view;
    rest.cloud.view.column_of.clear();
    std::vector<std::int32_t> number(scan.cloud.size(), -1);
    for (std::size_t i = 0; i < scan.cloud.size(); ++i) {
        if (lost(static_cast<std::int32_t>(i))) continue;
        number[i] = static_cast<std::int32_t>(rest.cloud.size());
        rest.cloud.xyz.push_back(scan.cloud.xyz[i]);
        rest.hit.push_back(scan.hit[i]);
        if (scan.cloud.ring.empty()) continue;
        rest.cloud.ring.push_back(scan.cloud.ring[i]);
        rest.cloud.view.column_of.push_back(scan.cloud.view.column_of[i]);
    }
    for (std::int32_t& i : rest.cloud.view.index) i = i < 0 ? -1 : number[i];
    return rest;
}

World flatWorld();
/// A plane that rises by `pitch_deg` per x and `bank_deg` per y, z = 0 under the origin.
World tiltedWorld(double pitch_deg, double bank_deg);

/// Upright box on the plane z = 0.
OrientedBox boxAt(double x, double y, double yaw_deg, const Eigen::Vector3d& size);
OrientedBox carAt(double x, double y, double yaw_deg);  ///< 4.5 x 1.8 x 1.5 m
OrientedBox personAt(double x, double y);               ///< 0.5 x 0.5 x 1.75 m
/// The box stood upright on the first strip of a world's ground, its bottom below the lowest corner of its footprint.
OrientedBox standOn(const World& world, OrientedBox box);

/// Cars ahead, behind and alongside, two people, a wall on either side at 12 m: the usual street.
World street();

/// The scan told in another frame: p' = rotation p + shift. Returns stay on what they lie on.
Scan moved(Scan scan, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& shift);

/// What the same sensor would tell if it hung upside down, turned about its x axis: rings and columns run backwards.
PointCloud upsideDown(PointCloud cloud);

/// A cloud of the given points without rings, seen from the origin at 1.8 m.
PointCloud cloudOf(const std::vector<Eigen::Vector3f>& points);

}  // namespace lidar_obstacles::test
