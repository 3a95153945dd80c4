// SPDX-License-Identifier: BSD-3-Clause
#include "simulated_lidar.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lidar_obstacles::examples {
namespace {

constexpr double kStep = 0.01;           // [s] of the robot's simulation
constexpr std::size_t kRemembered = 40;  // steps: a turn, and what lies around it
constexpr double kMargin = 0.02;         // [s] poses beyond both ends of a turn

/// Distance from a point to a box seen from above [m]; 0 inside.
double distance(const Eigen::Vector2d& point, const OrientedBox& box) {
    const Eigen::Vector2d d = Eigen::Rotation2Dd(-box.yaw) * (point - box.center.head<2>());
    return std::hypot(std::max(std::abs(d.x()) - box.size.x() / 2, 0.0),
                      std::max(std::abs(d.y()) - box.size.y() / 2, 0.0));
}

double nearestCorner(const OrientedBox& of, const OrientedBox& to) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const double l : {-0.5, 0.5})
        for (const double w : {-0.5, 0.5}) {
            const Eigen::Vector2d corner(l * of.size.x(), w * of.size.y());
            nearest = std::min(nearest, distance(of.center.head<2>() + Eigen::Rotation2Dd(of.yaw) * corner, to));
        }
    return nearest;
}

}  // namespace

double clearance(const OrientedBox& a, const OrientedBox& b) {
    return std::min(nearestCorner(a, b), nearestCorner(b, a));
}

SimulatedLidar::SimulatedLidar(const simulation::Scenario& scenario, mrpt::kinematics::CVehicleSimul_DiffDriven& robot)
    : world_(simulation::buildWorld(scenario)), robot_(robot) {
    const auto start = simulation::egoPoses(world_, {0.0, 0.1}).at(0.0);
    robot_.setCurrentGTPose({start.position.x(), start.position.y(), start.yaw});
    note();
}

std::vector<OrientedBox> SimulatedLidar::boxesAt(double time) const {
    std::vector<OrientedBox> boxes;
    boxes.reserve(world_.objects.size());
    for (const auto& object : world_.objects) {
        const auto pose = simulation::objectPoses(world_, object, {time, time + 0.1}, 0).at(time);
        const Eigen::Vector3d& size = object.model->size;
        boxes.push_back({pose.position + Eigen::Vector3d(0.0, 0.0, size.z() / 2), size, pose.yaw});
    }
    return boxes;
}

void SimulatedLidar::note() {
    const mrpt::math::TPose2D& pose = robot_.getCurrentGTPose();
    simulation::Pose6 on_ground = simulation::standOn(*world_.ground, {{pose.x, pose.y}, pose.phi}, {0.6, 0.5});
    if (!poses_.empty())  // poses are interpolated: no jump from pi to -pi
        on_ground.yaw = poses_.back().yaw + std::remainder(on_ground.yaw - poses_.back().yaw, 2.0 * M_PI);
    poses_.push_back(on_ground);
    if (poses_.size() > kRemembered) poses_.pop_front();
}

void SimulatedLidar::moveTo(double time) {
    while (robot_.getTime() < time) {
        robot_.simulateOneTimeStep(kStep);
        note();
    }
}

mrpt::obs::CObservationVelodyneScan::Ptr SimulatedLidar::turn() {
    const simulation::Turn turn = simulation::turnNumber(turn_++, world_.scenario.sensor.rate);
    moveTo(turn.end() + kMargin);
    simulation::TurnPoses poses = simulation::posesDuring(world_, turn);
    const double first = robot_.getTime() - kStep * static_cast<double>(poses_.size() - 1);
    const simulation::PoseTrack own(first, kStep, {poses_.begin(), poses_.end()});
    std::vector<simulation::Pose6> nodes = poses.ego.nodes();  // at the times of everybody else's
    const double step = (poses.ego.end() - poses.ego.start()) / static_cast<double>(nodes.size() - 1);
    for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = own.at(poses.ego.start() + static_cast<double>(k) * step);
    poses.ego = simulation::PoseTrack(poses.ego.start(), step, std::move(nodes));
    return simulation::toObservation(simulation::castScan(world_, turn, poses, turn_), world_.scenario.sensor);
}

}  // namespace lidar_obstacles::examples
