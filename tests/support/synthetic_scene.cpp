// SPDX-License-Identifier: BSD-3-Clause
#include "support/synthetic_scene.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace lidar_obstacles::test {
namespace {

struct Hit {
    double distance = kInfinity;
    int object = kOnGround;
};

double distanceToGround(const GroundStrip& g, const Eigen::Vector3d& o, const Eigen::Vector3d& d) {
    const double above = o.z() - g.heightAt(o.x(), o.y());
    const double sinking = g.slope.dot(d.head<2>()) - d.z();
    if (sinking <= 0.0 || above <= 0.0) return kInfinity;
    const double distance = above / sinking;
    const double x = o.x() + distance * d.x();
    return x >= g.x_min && x < g.x_max ? distance : kInfinity;
}

/// A box as the rays from one place meet it.
struct TargetBox {
    TargetBox(const OrientedBox& box, const Eigen::Vector3d& o)
        : to_box(Eigen::AngleAxisd(-box.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix()),
          origin(to_box * (o - box.center)),
          half(0.5 * box.size),
          center(box.center - o),
          beyond(center.squaredNorm() - 1.001 * half.squaredNorm()) {}

    Eigen::Matrix3d to_box;
    Eigen::Vector3d origin;  ///< of the rays, in the box's own frame
    Eigen::Vector3d half;    ///< sizes
    Eigen::Vector3d center;  ///< from the origin of the rays
    double beyond;           ///< a ray that goes less far towards the centre (squared) passes the ball around the box
};

/// Slab test in the box's own frame; infinite for a ray that misses or starts inside.
double distanceToBox(const TargetBox& box, const Eigen::Vector3d& d) {
    const double towards = box.center.dot(d);
    if (towards * towards < box.beyond) return kInfinity;
    const Eigen::Vector3d direction = box.to_box * d;
    double enter = 0.0;
    double leave = kInfinity;
    for (int axis = 0; axis < 3; ++axis) {
        const double half = box.half[axis];
        if (std::abs(direction[axis]) < 1e-12) {
            if (std::abs(box.origin[axis]) > half) return kInfinity;
            continue;
        }
        const double a = (-half - box.origin[axis]) / direction[axis];
        const double b = (half - box.origin[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    return enter > 0.0 && enter <= leave ? enter : kInfinity;
}

/// The ground and boxes of a world, for rays from one place.
class Targets {
  public:
    Targets(const World& world, const Eigen::Vector3d& o) : ground_(world.ground), o_(o) {
        boxes_.reserve(world.boxes.size());
        for (const OrientedBox& box : world.boxes) boxes_.emplace_back(box, o);
    }

    Hit firstHit(const Eigen::Vector3d& d) const {
        Hit hit;
        for (const GroundStrip& g : ground_) hit.distance = std::min(hit.distance, distanceToGround(g, o_, d));
        for (std::size_t b = 0; b < boxes_.size(); ++b) {
            const double distance = distanceToBox(boxes_[b], d);
            if (distance < hit.distance) hit = {distance, static_cast<int>(b)};
        }
        return hit;
    }

  private:
    const std::vector<GroundStrip>& ground_;
    Eigen::Vector3d o_;
    std::vector<TargetBox> boxes_;
};

/// Standard normal numbers (Box-Muller), the same with every library.
class Noise {
  public:
    double next() {
        const double u = (random_() + 1.0) / 4294967297.0;
        const double v = random_() / 4294967296.0;
        return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * M_PI * v);
    }

  private:
    std::mt19937 random_{7};
};

/// Clockwise from straight behind, as a Velodyne turns; half a step off so that no ray runs along an axis.
Eigen::Vector3d rayDirection(const Sensor& sensor, int ring, int column) {
    const double azimuth = M_PI - 2.0 * M_PI * (column + 0.5) / sensor.columns;
    const double elevation = radians(sensor.lowest_deg + ring * sensor.step_deg);
    return sensor.axes * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
}

}  // namespace

std::vector<std::int32_t> Scan::returnsOn(int object) const {
    std::vector<std::int32_t> found;
    for (std::size_t i = 0; i < hit.size(); ++i)
        if (hit[i] == object) found.push_back(static_cast<std::int32_t>(i));
    return found;
}

std::ptrdiff_t Scan::countOn(const std::vector<std::int32_t>& points, int object) const {
    return std::count_if(points.begin(), points.end(),
                         [&](std::int32_t i) { return hit[static_cast<std::size_t>(i)] == object; });
}

Scan castRays(const World& world, const Sensor& sensor) {
    Scan scan;
    PointCloud& cloud = scan.cloud;
    cloud.sensor_origin = sensor.position.cast<float>();
    cloud.sensor_up = sensor.axes.col(2).cast<float>();
    if (sensor.rings) {
        cloud.view.rings = sensor.planes;
        cloud.view.columns = sensor.columns;
        cloud.view.index.assign(static_cast<std::size_t>(sensor.planes) * sensor.columns, -1);
    }
    Noise noise;
    const Targets targets(world, sensor.position);
    for (int column = 0; column < sensor.columns; ++column) {
        for (int ring = 0; ring < sensor.planes; ++ring) {
            const Eigen::Vector3d d = rayDirection(sensor, ring, column);
            const Hit hit = targets.firstHit(d);
            if (hit.distance > sensor.max_range) continue;
            const double range = hit.distance + (sensor.noise > 0.0 ? sensor.noise * noise.next() : 0.0);
            if (sensor.rings) {
                cloud.view.at(ring, column) = static_cast<std::int32_t>(cloud.size());
                cloud.view.column_of.push_back(column);
                cloud.ring.push_back(static_cast<std::uint16_t>(ring));
            }
            cloud.xyz.push_back((sensor.position + range * d).cast<float>());
            scan.hit.push_back(hit.object);
        }
    }
    return scan;
}

Sensor fewPlanes(int planes) {
    Sensor sensor;
    sensor.planes = planes;
    if (planes == 8) sensor.step_deg = 4.0;
    if (planes == 4) sensor.lowest_deg = -7.0;
    if (planes == 1) sensor.lowest_deg = -5.0;
    return sensor;
}

World flatWorld() { return tiltedWorld(0.0, 0.0); }

World tiltedWorld(double pitch_deg, double bank_deg) {
    GroundStrip g;
    g.slope = {std::tan(radians(pitch_deg)), std::tan(radians(bank_deg))};
    return {{g}, {}};
}

OrientedBox boxAt(double x, double y, double yaw_deg, const Eigen::Vector3d& size) {
    return {{x, y, 0.5 * size.z()}, size, radians(yaw_deg)};
}

OrientedBox carAt(double x, double y, double yaw_deg) { return boxAt(x, y, yaw_deg, {4.5, 1.8, 1.5}); }

OrientedBox personAt(double x, double y) { return boxAt(x, y, 0.0, {0.5, 0.5, 1.75}); }

OrientedBox standOn(const World& world, OrientedBox box) {
    const GroundStrip& g = world.ground.at(0);
    const double ground = g.heightAt(box.center.x(), box.center.y());
    const double sink = 0.5 * g.slope.norm() * box.size.head<2>().norm();
    box.center.z() = ground + 0.5 * (box.size.z() - sink);
    box.size.z() += sink;
    return box;
}

World street() {
    World world = flatWorld();
    world.boxes = {carAt(12.0, 0.5, 0.0),
                   carAt(20.0, 4.5, 180.0),
                   carAt(-10.0, -3.5, 5.0),
                   carAt(6.0, -4.0, 0.0),
                   carAt(28.0, -4.0, 30.0),
                   carAt(-18.0, 3.5, 180.0),
                   personAt(8.0, 5.5),
                   personAt(15.0, -6.5),
                   boxAt(0.0, 12.0, 0.0, {80.0, 0.3, 6.0}),
                   boxAt(0.0, -12.0, 0.0, {80.0, 0.3, 6.0})};
    return world;
}

Scan moved(Scan scan, const Eigen::Matrix3d& rotation, const Eigen::Vector3d& shift) {
    const Eigen::Matrix3f r = rotation.cast<float>();
    const Eigen::Vector3f t = shift.cast<float>();
    for (Eigen::Vector3f& p : scan.cloud.xyz) p = r * p + t;
    scan.cloud.sensor_origin = r * scan.cloud.sensor_origin + t;
    scan.cloud.sensor_up = r * scan.cloud.sensor_up;
    return scan;
}

PointCloud upsideDown(PointCloud cloud) {
    const OrganizedView view = cloud.view;
    for (std::uint16_t& ring : cloud.ring) ring = static_cast<std::uint16_t>(view.rings - 1 - ring);
    for (std::int32_t& column : cloud.view.column_of) column = view.columns - 1 - column;
    for (int ring = 0; ring < view.rings; ++ring)
        for (int column = 0; column < view.columns; ++column)
            cloud.view.at(view.rings - 1 - ring, view.columns - 1 - column) = view.at(ring, column);
    cloud.sensor_up = -cloud.sensor_up;
    return cloud;
}

PointCloud cloudOf(const std::vector<Eigen::Vector3f>& points) {
    PointCloud cloud;
    cloud.xyz = points;
    cloud.sensor_origin = {0.0f, 0.0f, 1.8f};
    return cloud;
}

}  // namespace lidar_obstacles::test
