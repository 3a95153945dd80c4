// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/track.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace lidar_obstacles::simulation {
namespace {

constexpr double kStep = 0.5;  ///< between nodes [m]

Eigen::Vector2d direction(double heading) { return {std::cos(heading), std::sin(heading)}; }

}  // namespace

Track::Track(const TrackSpec& spec) : spec_(spec) {
    for (const TrackSegment& s : spec_.segments) {
        length_ += s.length;
        total_turn_ += s.turn;
    }
    if (!(length_ > 0.0)) throw std::invalid_argument("a track needs segments");
    const auto n = static_cast<std::size_t>(std::ceil(length_ / kStep));
    step_ = length_ / static_cast<double>(n);
    nodes_.push_back({Eigen::Vector2d::Zero(), smoothHeading(0.0)});
    for (std::size_t i = 1; i <= n; ++i) {
        const double s = static_cast<double>(i) * step_;
        // Gauss-Legendre with two points: exact to the third order of the curvature's change.
        constexpr double kGauss = 0.28867513459481287;
        const double middle = s - 0.5 * step_;
        const Eigen::Vector2d mean = 0.5 * (direction(smoothHeading(middle - kGauss * step_)) +
                                            direction(smoothHeading(middle + kGauss * step_)));
        nodes_.push_back({nodes_.back().position + step_ * mean, smoothHeading(s)});
    }
    if (spec_.closed) closeGap();
}

void Track::closeGap() {
    const Eigen::Vector2d gap = nodes_.back().position;
    if (gap.norm() > length_ / 30.0)
        throw std::invalid_argument("the end of the closed track lies at (" + std::to_string(gap.x()) + ", " +
                                    std::to_string(gap.y()) + "), not at its start");
    if (std::abs(std::abs(total_turn_) - 2.0 * M_PI) > 1e-3)
        throw std::invalid_argument("the closed track turns by " + std::to_string(total_turn_ * 180.0 / M_PI) +
                                    " deg in all, not by 360");
    if (std::abs(spec_.elevation(0.0) - spec_.elevation(length_)) > 0.01 ||
        std::abs(spec_.bank(0.0) - spec_.bank(length_)) > 1e-3)
        throw std::invalid_argument("elevation and bank of a closed track must end, at s = " + std::to_string(length_) +
                                    ", with what they begin with");
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        nodes_[i].position -= gap * static_cast<double>(i) / static_cast<double>(nodes_.size() - 1);
}

double Track::wrap(double s) const { return spec_.closed ? s - length_ * std::floor(s / length_) : s; }

/// Heading if curvature changed at once.
double Track::rawHeading(double s) const {
    if (spec_.closed) {
        const double laps = std::floor(s / length_);
        if (laps != 0.0) return rawHeading(s - laps * length_) + laps * total_turn_;
    }
    double heading = spec_.heading;
    for (const TrackSegment& segment : spec_.segments) {
        if (s <= segment.length) return heading + segment.turn * std::max(s, 0.0) / segment.length;
        heading += segment.turn;
        s -= segment.length;
    }
    return heading;
}

/// Mean heading over the transition length: its curvature changes steadily.
double Track::smoothHeading(double s) const {
    constexpr int kSamples = 16;
    double sum = 0.0;
    for (int k = 0; k < kSamples; ++k) sum += rawHeading(s + spec_.transition * ((k + 0.5) / kSamples - 0.5));
    return sum / kSamples;
}

TrackPoint Track::at(double s) const {
    const double on = wrap(s);
    const double inside = std::clamp(on, 0.0, length_);
    const auto i = std::min(static_cast<std::size_t>(inside / step_), nodes_.size() - 2);
    const Node &a = nodes_[i], &b = nodes_[i + 1];
    const double u = inside / step_ - static_cast<double>(i), v = 1.0 - u;
    TrackPoint point;
    point.position = (1.0 + 2.0 * u) * v * v * a.position + u * u * (3.0 - 2.0 * u) * b.position +
                     step_ * (u * v * v * direction(a.heading) - u * u * v * direction(b.heading));
    point.heading = v * a.heading + u * b.heading;
    point.position += (on - inside) * direction(point.heading);
    point.elevation = spec_.elevation(on);
    point.bank = spec_.bank(on);
    return point;
}

Eigen::Vector2d Track::place(double s, double d) const {
    const TrackPoint point = at(s);
    const Eigen::Vector2d ahead = direction(point.heading);
    return point.position + d * Eigen::Vector2d(-ahead.y(), ahead.x());
}

}  // namespace lidar_obstacles::simulation
