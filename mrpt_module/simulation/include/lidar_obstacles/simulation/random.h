// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Random numbers that depend on what they are for and on nothing else.
#pragma once

#include <cmath>
#include <cstdint>

namespace lidar_obstacles::simulation {

/// A stream of numbers named by a seed and up to three indices (SplitMix64, Steele et al. 2014). Two streams of
/// different names are unrelated, so results do not depend on the order in which streams are used, nor on threads.
/// An object is for one thread at a time.
class Random {
  public:
    explicit Random(std::uint64_t seed, std::uint64_t a = 0, std::uint64_t b = 0, std::uint64_t c = 0)
        : state_(mix(mix(mix(mix(seed) + a) + b) + c)) {}

    /// In [0, 1).
    double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
    double uniform(double low, double high) { return low + (high - low) * uniform(); }
    /// Mean 0, standard deviation 1 (Box and Muller).
    double gaussian() {
        const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
        return radius * std::cos(2.0 * M_PI * uniform());
    }

  private:
    static constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15U;

    static std::uint64_t mix(std::uint64_t z) {
        z += kStep;
        z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
        z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
        return z ^ (z >> 31U);
    }
    std::uint64_t next() {
        const std::uint64_t number = mix(state_);
        state_ += kStep;
        return number;
    }

    std::uint64_t state_;
};

}  // namespace lidar_obstacles::simulation
