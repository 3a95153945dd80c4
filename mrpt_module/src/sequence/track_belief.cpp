// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/track_belief.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

constexpr double kClassMemory = 3.0;  ///< [s]
constexpr double kMostLooks = 3.0;    ///< independent looks that a long track counts for

constexpr double kWalking = 1.39;  ///< from 5 km/h on a motion tells the front as well as it can [m/s]
constexpr double kFrontPerSecond = 6.0;
constexpr double kSureOfFront = 6.0;  ///< log-odds are kept below
constexpr double kKnownFront = 2.0;
constexpr double kSureOfAxis = 2.0;

std::size_t placeOf(ObstacleClass cls) { return static_cast<std::size_t>(cls); }

}  // namespace

void ClassBelief::look(const ClassProbabilities& seen, double dt, double quality) {
    looks_ += 1.0;
    weight_ = weight_ * std::exp(-dt / kClassMemory) + quality;
    const double gain = quality / weight_;
    for (std::size_t k = 0; k < seen.size(); ++k)
        mean_log_[k] += gain * (std::log(std::max(kRarestInOneLook, static_cast<double>(seen[k]))) - mean_log_[k]);
    best_ = topClass(probabilities());
}

void ClassBelief::moved(double speed, double travelled) {
    constexpr double kUnlikely = -4.0;
    constexpr double kNever = 2.0 * kUnlikely;
    constexpr double kRunning = 3.5;  // few people run faster [m/s]
    if (speed > 1.0 && travelled > 2.0) {
        motion_[placeOf(ObstacleClass::Structure)] = kNever;
        motion_[placeOf(ObstacleClass::Unknown)] = kUnlikely;
    }
    if (speed > kRunning && travelled > 2.0) motion_[placeOf(ObstacleClass::Pedestrian)] = kUnlikely;
}

ClassProbabilities ClassBelief::probabilities() const {
    const double factor = std::min(kMostLooks, std::sqrt(std::max(1.0, looks_)));
    std::array<double, kClasses> p{};
    double highest = -1e300;
    for (std::size_t k = 0; k < p.size(); ++k) {
        p[k] = factor * mean_log_[k] + motion_[k];
        highest = std::max(highest, p[k]);
    }
    double sum = 0.0;
    for (double& v : p) sum += v = std::exp(v - highest);
    ClassProbabilities shares{};
    for (std::size_t k = 0; k < p.size(); ++k) shares[k] = static_cast<float>(p[k] / sum);
    return shares;
}

void DirectionBelief::see(int quarters) {
    constexpr double kVote = 0.5;
    axis_ = std::clamp(axis_ + (quarters % 2 == 0 ? kVote : -kVote), -kSureOfAxis, kSureOfAxis);
}

void DirectionBelief::move(const Eigen::Vector2d& velocity, double dt) {
    constexpr double kAside = 0.5;  // the sine of 30 degrees: nearer to +-90 degrees nothing is said about the front
    const double speed = velocity.norm();
    if (speed < kCreeping) return;
    const double sure = std::min(1.0, speed / kWalking);
    if (std::abs(velocity.x()) > kAside * speed)
        front_ = std::clamp(front_ + kFrontPerSecond * dt * sure * velocity.x() / speed, -kSureOfFront, kSureOfFront);
    const double along = 2.0 * velocity.x() * velocity.x() / (speed * speed) - 1.0;
    if (speed > kWalking) axis_ = std::clamp(axis_ + kFrontPerSecond * dt * along, -kSureOfAxis, kSureOfAxis);
}

void DirectionBelief::proveAxis(bool along) { axis_ = along ? std::max(0.0, axis_) : -kSureOfAxis; }

int DirectionBelief::takeTurn() {
    if (axis_ < -0.5) {
        axis_ = -axis_;
        front_ = 0.0;
        return 1;
    }
    if (front_ > -kKnownFront) return 0;
    front_ = -front_;
    return 2;
}

bool DirectionBelief::known() const { return front_ >= kKnownFront && axis_ > 0.0; }

}  // namespace lidar_obstacles
