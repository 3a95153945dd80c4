// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Smooth curves through given values.
#pragma once

#include <vector>

namespace lidar_obstacles::simulation {

/// A curve y(x) through knots that is smooth and, between two knots, never leaves the range of their values: piecewise
/// cubic Hermite interpolation with the slopes of Fritsch and Butland (1984). Constant before the first and after the
/// last knot.
/// Its const members may be called by several threads at a time.
class Curve {
  public:
    struct Knot {
        double x;
        double y;
    };

    /// The constant 0.
    Curve() : Curve(0.0) {}
    /// The constant `value`.
    explicit Curve(double value) : Curve(std::vector<Knot>{{0.0, value}}) {}
    /// @throws std::invalid_argument if there is no knot or the x do not rise.
    explicit Curve(std::vector<Knot> knots);

    double operator()(double x) const;
    double firstX() const { return knots_.front().x; }
    double lastX() const { return knots_.back().x; }

  private:
    std::vector<Knot> knots_;
    std::vector<double> slope_;  ///< dy/dx at each knot
};

}  // namespace lidar_obstacles::simulation
