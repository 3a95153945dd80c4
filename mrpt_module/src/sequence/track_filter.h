// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// How a track moves: standing, straight on and turning as an interacting multiple model (Blom and Bar-Shalom 1988).
#pragma once

#include <Eigen/Core>
#include <array>

namespace lidar_obstacles {

/// Places in the state of motion: position [m], velocity over ground [m/s], yaw [rad], yaw rate [rad/s]; world frame.
/// The position is that of a point fixed to the body (track_shape.h), not of a box that may grow.
enum StateIndex { kPosX, kPosY, kVelX, kVelY, kYaw, kTurn, kStateSize };
using MotionState = Eigen::Matrix<double, kStateSize, 1>;
using MotionCovariance = Eigen::Matrix<double, kStateSize, kStateSize>;

enum MotionModel { kStanding, kStraight, kTurning, kMotionModels };

/// What a kind of road user can do.
struct MotionNoise {
    double along = 2.5;       ///< acceleration along the way, standard deviation [m/s2]
    double across = 1.5;      ///< across it [m/s2]
    double turn = 0.5;        ///< change of the yaw rate [rad/s2]
    double standing = 0.1;    ///< how boxes of what stands wander about, as their view changes [m per root of a second]
    double max_speed = 20.0;  ///< of what is seen for the first time, standard deviation [m/s]
};

/// One number that was measured: `row` . state, with its error.
struct Measurement {
    MotionState row = MotionState::Zero();
    double innovation = 0.0;  ///< measured less predicted, at MotionFilter::mean()
    double variance = 1.0;
};

/// Up to four measurements of one scan.
struct Measurements {
    std::array<Measurement, 4> list{};
    int count = 0;

    void add(const Measurement& m) { list[static_cast<std::size_t>(count++)] = m; }
};

class MotionFilter {
  public:
    /// Begins at a place, with a speed that is not known.
    void begin(const Eigen::Vector2d& position, double yaw, double yaw_std, const MotionNoise& noise);
    /// Goes on by `dt` [s], > 0. @param unseen  no box shows it in this scan: it stops no faster than it can brake.
    /// While boxes show it, a speed may also have been their mistake.
    void predict(double dt, const MotionNoise& noise, bool unseen = false);
    /// Takes in what one scan measured. What fits no model is trusted less: the error of a box has long tails.
    /// @return how many times larger the variances had to be taken, >= 1.
    double update(const Measurements& measurements);
    /// A body on wheels does not slide: its velocity is along its yaw, within `std` [m/s]. @return false where the
    /// velocity contradicts, which is then left as it is.
    bool rollAlongYaw(double std);
    /// Turns the body's yaw by `angle` without touching its motion: front and side were confused.
    void relabelYaw(double angle);
    /// How far measurements lie from what is expected: sum of squares in units of their errors; the position is taken
    /// to be at least `floor` [m] uncertain.
    double distance2(const Measurements& measurements, double floor) const;

    const MotionState& mean() const { return mean_; }
    const MotionCovariance& covariance() const { return covariance_; }
    Eigen::Vector2d position() const { return mean_.head<2>(); }
    Eigen::Vector2d velocity() const { return mean_.segment<2>(kVelX); }
    double yaw() const { return mean_[kYaw]; }
    /// Probability that it stands.
    double standing() const { return weight_[kStanding]; }

  private:
    struct Model {
        MotionState x = MotionState::Zero();
        MotionCovariance P = MotionCovariance::Identity();
    };
    void mix(double dt, const MotionNoise& noise, bool unseen);
    void combine();

    std::array<Model, kMotionModels> models_;
    std::array<double, kMotionModels> weight_{};
    MotionState mean_ = MotionState::Zero();
    MotionCovariance covariance_ = MotionCovariance::Identity();
};

}  // namespace lidar_obstacles
