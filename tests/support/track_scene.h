// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Bodies that move on a plane, and the boxes that a detector would see of them: for tests of the tracker.
#pragma once

#include <array>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "lidar_obstacles/tracking.h"

namespace lidar_obstacles::test {

/// Where something is on the ground; world frame.
struct Place {
    double x = 0.0;
    double y = 0.0;
    double yaw = 0.0;
};

inline Eigen::Isometry3d poseAt(const Place& p) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.translate(Eigen::Vector3d(p.x, p.y, 0.0));
    T.rotate(Eigen::AngleAxisd(p.yaw, Eigen::Vector3d::UnitZ()));
    return T;
}

/// A body, standing on the ground.
struct Body {
    ObstacleClass cls = ObstacleClass::Vehicle;
    Eigen::Vector3d size{4.3, 1.8, 1.5};
    Place place;
};

inline Body carAt(const Place& place) { return {ObstacleClass::Vehicle, {4.3, 1.8, 1.5}, place}; }
inline Body personAt(const Place& place) { return {ObstacleClass::Pedestrian, {0.6, 0.6, 1.75}, place}; }

/// A detector of known errors: seen faces are right within `face_std`, what is not seen is guessed within `guess_std`,
/// headings are right within `yaw_std`. Every body is seen as if it stood alone.
class Detector {
  public:
    explicit Detector(unsigned seed = 1) : random_(seed) {}

    SeenBox see(const Body& body, const Place& ego, double time) {
        const Eigen::Isometry3d T_world_vehicle = poseAt(ego);
        SeenBox b;
        b.time = time;
        b.T_world_vehicle = T_world_vehicle;
        b.num_points = 100;
        b.classes.fill(0.05f);
        b.classes[static_cast<std::size_t>(body.cls)] = 0.8f;
        b.heading_valid = body.cls != ObstacleClass::Pedestrian;
        b.heading_std = b.heading_valid ? yaw_std : 0.0;
        const Eigen::Vector3d center =
            T_world_vehicle.inverse() * Eigen::Vector3d(body.place.x, body.place.y, 0.5 * body.size.z());
        b.box = {center, body.size, normalizeAngle(body.place.yaw - ego.yaw + noise(b.heading_valid ? yaw_std : 0.0))};
        b.seen_box = b.box;
        if (b.heading_valid) b.faces = facesTowards(b.box);
        for (int k = 0; k < 2; ++k) disturb(b, k);
        return b;
    }

    double face_std = 0.03;
    double guess_std = 0.5;
    double yaw_std = 0.01;

  private:
    double noise(double std) { return std > 0.0 ? std::normal_distribution<double>(0.0, std)(random_) : 0.0; }

    static Eigen::Vector2d axisOf(const OrientedBox& box, int k) {
        const Eigen::Vector2d ahead(std::cos(box.yaw), std::sin(box.yaw));
        return k == 0 ? ahead : Eigen::Vector2d(-ahead.y(), ahead.x());
    }

    static std::uint8_t facesTowards(const OrientedBox& box) {
        std::uint8_t faces = 0;
        for (int k = 0; k < 2; ++k) {
            const double along = -axisOf(box, k).dot(box.center.head<2>());
            if (along > 0.5 * box.size[k]) faces = static_cast<std::uint8_t>(faces | (k == 0 ? kFront : kLeft));
            if (along < -0.5 * box.size[k]) faces = static_cast<std::uint8_t>(faces | (k == 0 ? kBack : kRight));
        }
        return faces;
    }

    /// Errors of both edges along an axis; with one face of a body seen and none beside it, its depth is not seen.
    void disturb(SeenBox& b, int k) {
        const std::uint8_t of_axis = k == 0 ? kFront | kBack : kLeft | kRight;
        const bool end_on =
            b.faces != 0 && (b.faces & of_axis) != 0 && (b.faces & static_cast<std::uint8_t>(~of_axis)) == 0;
        const Eigen::Vector2d n = axisOf(b.box, k);
        const double sense = n.dot(b.box.center.head<2>()) > 0.0 ? 1.0 : -1.0;  // away from the vehicle
        const double near = noise(face_std), far = end_on ? noise(guess_std) : noise(2.0 * face_std);
        const auto shift = [&](OrientedBox& box, double by_near, double by_far) {
            box.size[k] += by_far - by_near;
            box.center.head<2>() += 0.5 * (by_far + by_near) * sense * n;
        };
        shift(b.box, near, far);
        shift(b.seen_box, near, end_on ? 0.3 - b.seen_box.size[k] : far);
    }

    std::mt19937 random_;
};

/// Scan after scan at 10 Hz: bodies in, rows out.
class Drive {
  public:
    explicit Drive(TrackingParams params = {}, unsigned seed = 1) : detector(seed), tracker(params) {}

    /// @param step  since the scan before [s]
    const std::vector<TrackedBox>& scan(const std::vector<Body>& bodies, const Place& ego = {}, double step = 0.1) {
        time += step;
        input.time = time;
        input.T_world_vehicle = poseAt(ego);
        input.boxes.clear();
        for (const Body& body : bodies) input.boxes.push_back(detector.see(body, ego, time));
        return tracker.update(input);
    }

    Detector detector;
    Tracker tracker;
    TrackingScan input;
    double time = 1000.0;
};

/// The row that took in box `source`; fails the test where there is none.
inline const TrackedBox& rowOfBox(const std::vector<TrackedBox>& rows, int source) {
    for (const TrackedBox& row : rows)
        if (row.source == source) return row;
    throw std::runtime_error("no row of box " + std::to_string(source));
}

}  // namespace lidar_obstacles::test
