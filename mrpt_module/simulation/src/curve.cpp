// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/curve.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lidar_obstacles::simulation {
namespace {

/// Slope at a knot between chords of slope d0 over h0 and d1 over h1: their weighted harmonic mean, 0 at an extremum.
double innerSlope(double h0, double d0, double h1, double d1) {
    if (d0 * d1 <= 0.0) return 0.0;
    const double w0 = 2.0 * h1 + h0, w1 = h1 + 2.0 * h0;
    return (w0 + w1) / (w0 / d0 + w1 / d1);
}

}  // namespace

Curve::Curve(std::vector<Knot> knots) : knots_(std::move(knots)), slope_(knots_.size(), 0.0) {
    if (knots_.empty()) throw std::invalid_argument("a curve needs at least one knot");
    const std::size_t n = knots_.size();
    std::vector<double> h(n, 0.0), d(n, 0.0);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        h[i] = knots_[i + 1].x - knots_[i].x;
        if (!(h[i] > 0.0)) throw std::invalid_argument("the knots of a curve must rise in x");
        d[i] = (knots_[i + 1].y - knots_[i].y) / h[i];
    }
    if (n < 2) return;
    for (std::size_t i = 1; i + 1 < n; ++i) slope_[i] = innerSlope(h[i - 1], d[i - 1], h[i], d[i]);
    slope_.front() = d.front();
    slope_.back() = d[n - 2];
}

double Curve::operator()(double x) const {
    if (x <= knots_.front().x) return knots_.front().y;
    if (x >= knots_.back().x) return knots_.back().y;
    const auto after =
        std::upper_bound(knots_.begin(), knots_.end(), x, [](double v, const Knot& k) { return v < k.x; });
    const auto i = static_cast<std::size_t>(after - knots_.begin()) - 1;
    const double h = knots_[i + 1].x - knots_[i].x, u = (x - knots_[i].x) / h, v = 1.0 - u;
    return (1.0 + 2.0 * u) * v * v * knots_[i].y + u * v * v * h * slope_[i] +
           u * u * (3.0 - 2.0 * u) * knots_[i + 1].y - u * u * v * h * slope_[i + 1];
}

}  // namespace lidar_obstacles::simulation
