// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/track_filter.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

/// How often a model gives way to another [1/s]; rows: from, columns: to.
constexpr double kChanges[kMotionModels][kMotionModels] = {{0.0, 0.05, 0.01}, {0.1, 0.0, 0.4}, {0.1, 0.8, 0.0}};
constexpr double kStandingSpeed = 0.02;  ///< what a standing thing may still move [m/s]
constexpr double kYawDrift = 0.02;       ///< of a yaw whose view changes [rad per root of a second]
constexpr double kMinWeight = 1e-4;

/// Covariance of white acceleration over dt: of (position, velocity), in the axes of the way.
void addAcceleration(MotionCovariance& P, const Eigen::Vector2d& way, double dt, const MotionNoise& noise) {
    const Eigen::Vector2d across(-way.y(), way.x());
    const Eigen::Matrix2d a = noise.along * noise.along * (way * way.transpose()) +
                              noise.across * noise.across * (across * across.transpose());
    // as if it changed at 10 Hz, so that two steps of dt / 2 give what one of dt does
    constexpr double kStep = 0.1;
    P.block<2, 2>(kPosX, kPosX) += kStep * dt * dt * dt / 3.0 * a;
    P.block<2, 2>(kPosX, kVelX) += kStep * dt * dt / 2.0 * a;
    P.block<2, 2>(kVelX, kPosX) += kStep * dt * dt / 2.0 * a;
    P.block<2, 2>(kVelX, kVelX) += kStep * dt * a;
}

Eigen::Vector2d wayOf(const MotionState& x) {
    const Eigen::Vector2d v = x.segment<2>(kVelX);
    if (v.squaredNorm() > 1.0) return v.normalized();
    return {std::cos(x[kYaw]), std::sin(x[kYaw])};
}

void predictStanding(MotionState& x, MotionCovariance& P, double dt, const MotionNoise& noise) {
    for (const int k : {kVelX, kVelY, kTurn}) {
        x[k] = 0.0;
        P.row(k).setZero();
        P.col(k).setZero();
    }
    P(kVelX, kVelX) = P(kVelY, kVelY) = kStandingSpeed * kStandingSpeed;
    P(kTurn, kTurn) = kYawDrift * kYawDrift;
    P(kPosX, kPosX) += noise.standing * noise.standing * dt;
    P(kPosY, kPosY) += noise.standing * noise.standing * dt;
    P(kYaw, kYaw) += kYawDrift * kYawDrift * dt;
}

void predictStraight(MotionState& x, MotionCovariance& P, double dt, const MotionNoise& noise) {
    MotionCovariance F = MotionCovariance::Identity();
    F(kPosX, kVelX) = F(kPosY, kVelY) = dt;
    F(kTurn, kTurn) = 0.0;
    x = F * x;
    P = F * P * F.transpose();
    addAcceleration(P, wayOf(x), dt, noise);
    P(kTurn, kTurn) += kYawDrift * kYawDrift;
    P(kYaw, kYaw) += 4.0 * kYawDrift * kYawDrift * dt;
}

/// A circle, to first order in the angle turned within one step (its Jacobian; the state itself goes round exactly
/// about the mean direction).
void predictTurning(MotionState& x, MotionCovariance& P, double dt, const MotionNoise& noise) {
    const double turned = x[kTurn] * dt;
    const Eigen::Matrix2d half{{std::cos(turned / 2), -std::sin(turned / 2)},
                               {std::sin(turned / 2), std::cos(turned / 2)}};
    const Eigen::Matrix2d whole = half * half;
    const Eigen::Vector2d v = x.segment<2>(kVelX);
    const Eigen::Vector2d left(-v.y(), v.x());
    MotionCovariance F = MotionCovariance::Identity();
    F.block<2, 2>(kPosX, kVelX) = dt * half;
    F.block<2, 2>(kVelX, kVelX) = whole;
    F.block<2, 1>(kPosX, kTurn) = 0.5 * dt * dt * left;
    F.block<2, 1>(kVelX, kTurn) = dt * left;
    F(kYaw, kTurn) = dt;
    x.head<2>() += dt * (half * v);
    x.segment<2>(kVelX) = whole * v;
    x[kYaw] += turned;
    P = F * P * F.transpose();
    addAcceleration(P, wayOf(x), dt, noise);
    P(kTurn, kTurn) += noise.turn * noise.turn * dt;
    P(kYaw, kYaw) += kYawDrift * kYawDrift * dt;
}

/// Factor of the rate at which what moves so comes to stand, 0 .. 1: what drives at 15 m/s does not stand a second
/// later. By how well its speed is known.
double chanceToStop(const MotionState& x, const MotionCovariance& P, const MotionNoise& noise) {
    const double braked = 2.0 * noise.along;  // two standard deviations, for a second [m/s]
    const Eigen::Vector2d v = x.segment<2>(kVelX);
    const double speed2 = v.squaredNorm();
    if (speed2 == 0.0) return 1.0;
    const double variance = v.dot(P.block<2, 2>(kVelX, kVelX) * v) / speed2;
    return std::exp(-0.5 * speed2 / (variance + braked * braked));
}

}  // namespace

void MotionFilter::begin(const Eigen::Vector2d& position, double yaw, double yaw_std, const MotionNoise& noise) {
    constexpr double kPositionStd = 0.3;
    weight_ = {0.4, 0.4, 0.2};
    for (std::size_t k = 0; k < kMotionModels; ++k) {
        Model& m = models_[k];
        m.x << position, 0.0, 0.0, yaw, 0.0;
        const double speed = k == kStanding ? kStandingSpeed : noise.max_speed;
        const double turn = k == kTurning ? 0.3 : kYawDrift;
        const MotionState std{{kPositionStd, kPositionStd, speed, speed, yaw_std, turn}};
        m.P = std.cwiseAbs2().asDiagonal();
    }
    combine();
}

/// The models' states before a step: each becomes what the others say, as far as they may have changed into it.
void MotionFilter::mix(double dt, const MotionNoise& noise, bool unseen) {
    double change[kMotionModels][kMotionModels];
    for (int i = 0; i < kMotionModels; ++i) {
        change[i][i] = 1.0;
        for (int j = 0; j < kMotionModels; ++j) {
            if (i == j) continue;
            const double rate =
                kChanges[i][j] * (unseen && j == kStanding ? chanceToStop(models_[i].x, models_[i].P, noise) : 1.0);
            change[i][j] = (1.0 - std::exp(-2.0 * rate * dt)) / 2.0;  // never more than an even chance
            change[i][i] -= change[i][j];
        }
    }
    const auto before = models_;
    const auto weight = weight_;
    for (std::size_t j = 0; j < kMotionModels; ++j) {
        double total = 0.0;
        for (std::size_t i = 0; i < kMotionModels; ++i) total += change[i][j] * weight[i];
        Model& m = models_[j];
        m.x.setZero();
        m.P.setZero();
        for (std::size_t i = 0; i < kMotionModels; ++i) m.x += change[i][j] * weight[i] / total * before[i].x;
        for (std::size_t i = 0; i < kMotionModels; ++i) {
            const MotionState d = before[i].x - m.x;
            m.P += change[i][j] * weight[i] / total * (before[i].P + d * d.transpose());
        }
        weight_[j] = total;
    }
}

void MotionFilter::combine() {
    mean_.setZero();
    covariance_.setZero();
    for (std::size_t k = 0; k < kMotionModels; ++k) mean_ += weight_[k] * models_[k].x;
    for (std::size_t k = 0; k < kMotionModels; ++k) {
        const MotionState d = models_[k].x - mean_;
        covariance_ += weight_[k] * (models_[k].P + d * d.transpose());
    }
}

void MotionFilter::predict(double dt, const MotionNoise& noise, bool unseen) {
    mix(dt, noise, unseen);
    predictStanding(models_[kStanding].x, models_[kStanding].P, dt, noise);
    predictStraight(models_[kStraight].x, models_[kStraight].P, dt, noise);
    predictTurning(models_[kTurning].x, models_[kTurning].P, dt, noise);
    combine();
}

double MotionFilter::update(const Measurements& measurements) {
    constexpr double kTail = 6.0;     // squared error beyond which a box is no longer taken as Gaussian
    constexpr double kMaxVote = 1.0;  // log of the likelihood ratio of one scan: errors of scan and next are alike
    std::array<double, kMotionModels> log_likelihood{};
    double worst = 1.0;
    for (int n = 0; n < measurements.count; ++n) {
        const Measurement& z = measurements.list[static_cast<std::size_t>(n)];
        std::array<double, kMotionModels> innovation{};
        std::array<double, kMotionModels> variance{};
        double best = 1e300;
        for (std::size_t k = 0; k < kMotionModels; ++k) {
            innovation[k] = z.innovation - z.row.dot(models_[k].x - mean_);
            variance[k] = z.row.dot(models_[k].P * z.row);
            best = std::min(best, innovation[k] * innovation[k] / (variance[k] + z.variance));
        }
        const double wider = std::max(1.0, best / kTail);
        worst = std::max(worst, wider);
        for (std::size_t k = 0; k < kMotionModels; ++k) {
            Model& m = models_[k];
            const double s = wider * (variance[k] + z.variance);
            const MotionState gain = (m.P * z.row) / s;
            log_likelihood[k] -= 0.5 * (innovation[k] * innovation[k] / s + std::log(s));
            m.P -= gain * (m.P * z.row).transpose();
            m.P = 0.5 * (m.P + m.P.transpose()).eval();
            m.x += gain * innovation[k];
        }
    }
    const double highest = *std::max_element(log_likelihood.begin(), log_likelihood.end());
    double total = 0.0;
    for (std::size_t k = 0; k < kMotionModels; ++k) {
        weight_[k] = std::max(kMinWeight, weight_[k] * std::exp(std::max(-kMaxVote, log_likelihood[k] - highest)));
        total += weight_[k];
    }
    for (double& w : weight_) w /= total;
    combine();
    return worst;
}

bool MotionFilter::rollAlongYaw(double std) {
    constexpr double kGate = 9.0;
    const Eigen::Vector2d side(-std::sin(yaw()), std::cos(yaw()));
    const Eigen::Vector2d ahead(side.y(), -side.x());
    MotionState row = MotionState::Zero();
    row.segment<2>(kVelX) = side;
    row[kYaw] = -ahead.dot(velocity());
    const double sideways = side.dot(velocity());
    if (sideways * sideways > kGate * (row.dot(covariance_ * row) + std * std)) return false;
    for (const int k : {kStraight, kTurning}) {
        Model& m = models_[static_cast<std::size_t>(k)];
        const double innovation = -sideways - row.dot(m.x - mean_);
        const MotionState gain = (m.P * row) / (row.dot(m.P * row) + std * std);
        m.P -= gain * (m.P * row).transpose();
        m.P = 0.5 * (m.P + m.P.transpose()).eval();
        m.x += gain * innovation;
    }
    combine();
    return true;
}

void MotionFilter::relabelYaw(double angle) {
    for (Model& m : models_) m.x[kYaw] += angle;
    mean_[kYaw] += angle;
}

double MotionFilter::distance2(const Measurements& measurements, double floor) const {
    double sum = 0.0;
    for (int n = 0; n < measurements.count; ++n) {
        const Measurement& z = measurements.list[static_cast<std::size_t>(n)];
        const double spread = z.row.dot(covariance_ * z.row) + floor * floor * z.row.head<2>().squaredNorm();
        sum += z.innovation * z.innovation / (spread + z.variance);
    }
    return sum;
}

}  // namespace lidar_obstacles
