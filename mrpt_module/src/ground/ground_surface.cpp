// SPDX-License-Identifier: BSD-3-Clause
#include "ground/ground_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Dense>

namespace lidar_obstacles {
namespace {

/// Ranges of the nodes [m]: rings meet level ground in such steps.
const std::vector<double> kRanges{1.5, 2.5, 4.0, 6.0, 9.0, 13.0, 18.0, 25.0, 34.0, 46.0};

// Standard deviations: of a seed from smooth ground [m], of how much the slope changes from node to node outwards (1.5
// deg) and along a circle (3 deg; its nodes are in fixed directions).
constexpr double kSeed = 0.04;
constexpr double kBendOutwards = 0.026;
constexpr double kBendAlong = 0.05;

/// A place on the surface: the four nodes around it and their shares.
struct Place {
    std::array<int, 4> node{};
    std::array<double, 4> share{};
};

/// Direction of a place, counted in those of the nodes.
double directionOf(const GroundModel& model, double dx, double dy) {
    const auto angle = static_cast<double>(fastAtan2(static_cast<float>(dy), static_cast<float>(dx)));
    return std::max(0.0, (angle + M_PI) * (model.sectors / (2.0 * M_PI)));
}

Place placeOf(const GroundModel& model, double x, double y) {
    const double dx = x - model.center.x();
    const double dy = y - model.center.y();
    const double turned = directionOf(model, dx, dy);
    const auto count = static_cast<int>(model.ranges.size());
    const int first = static_cast<int>(turned);
    const double along = turned - first;
    const double range = std::sqrt(dx * dx + dy * dy);
    int inner = 0;
    while (inner + 2 < count && range > model.ranges[inner + 1]) ++inner;
    const double low = model.ranges[inner];
    const double outwards = std::clamp((range - low) / (model.ranges[inner + 1] - low), 0.0, 1.0);
    const int right = first % model.sectors * count + inner;
    const int left = (first + 1) % model.sectors * count + inner;
    return {{right, right + 1, left, left + 1},
            {(1.0 - along) * (1.0 - outwards), (1.0 - along) * outwards, along * (1.0 - outwards), along * outwards}};
}

double riseAt(const GroundModel& model, const Place& place) {
    double rise = 0.0;
    for (std::size_t k = 0; k < 4; ++k) rise += place.share[k] * model.rise[place.node[k]];
    return rise;
}

/// Least squares over the heights of the nodes. Directions are numbered from the front and the back of the circle in
/// turn (0, S - 1, 1, S - 2 ..), so that the matrix is a band although they go around.
class NodeEquations {
  public:
    NodeEquations(int sectors, int count)
        : band_(4 * count + 1),  // a node and the second next one along the circle
          matrix_(static_cast<std::size_t>(sectors * count * band_), 0.0),
          right_(static_cast<std::size_t>(sectors * count), 0.0) {
        row_.reserve(right_.size());
        for (int sector = 0; sector < sectors; ++sector) {
            const int place = 2 * sector < sectors ? 2 * sector : 2 * (sectors - sector) - 1;
            for (int k = 0; k < count; ++k) row_.push_back(place * count + k);
        }
    }

    /// sum(factor * height of node) is `value`, with that weight.
    template <std::size_t N>
    void add(const std::array<int, N>& node, const std::array<double, N>& factor, double value, double weight) {
        std::array<int, N> row{};
        for (std::size_t a = 0; a < N; ++a) row[a] = row_[node[a]];
        for (std::size_t a = 0; a < N; ++a) {
            right_[row[a]] += weight * factor[a] * value;
            for (std::size_t b = 0; b < N; ++b)
                if (row[a] >= row[b]) at(row[a], row[b]) += weight * factor[a] * factor[b];
        }
    }

    /// The heights of the nodes (Cholesky's decomposition of a band). The equations are used up.
    std::vector<double> solve() {
        const auto size = static_cast<int>(right_.size());
        for (int j = 0; j < size; ++j) {  // a column at a time, what is below it follows
            const double pivot = 1.0 / std::sqrt(at(j, j));
            const int end = std::min(size, j + band_);
            for (int i = j; i < end; ++i) at(i, j) *= pivot;
            for (int k = j + 1; k < end; ++k) {
                const double factor = at(k, j);
                if (factor == 0.0) continue;
                for (int i = k; i < end; ++i) at(i, k) -= factor * at(i, j);
            }
        }
        for (int j = 0; j < size; ++j) {
            right_[j] /= at(j, j);
            for (int i = j + 1; i < std::min(size, j + band_); ++i) right_[i] -= at(i, j) * right_[j];
        }
        for (int j = size - 1; j >= 0; --j) {
            for (int i = j + 1; i < std::min(size, j + band_); ++i) right_[j] -= at(i, j) * right_[i];
            right_[j] /= at(j, j);
        }
        std::vector<double> heights(right_.size());
        for (int node = 0; node < size; ++node) heights[node] = right_[row_[node]];
        return heights;
    }

  private:
    /// Of the lower triangle, column by column from the diagonal down.
    double& at(int row, int column) { return matrix_[static_cast<std::size_t>(column * band_ + row - column)]; }

    int band_;
    std::vector<int> row_;  ///< of each node
    std::vector<double> matrix_;
    std::vector<double> right_;
};

double weightOf(double deviation) { return kSeed * kSeed / (deviation * deviation); }

/// What is known of any ground, relative to the plane of the scan.
NodeEquations smoothGround(const GroundModel& model, const GroundParams& params) {
    const auto count = static_cast<int>(model.ranges.size());
    const double steepest = std::tan(params.max_slope_deg * M_PI / 180.0);
    NodeEquations equations(model.sectors, count);
    for (int sector = 0; sector < model.sectors; ++sector)
        for (int k = 0; k < count; ++k) {
            const int node = sector * count + k;
            const int right = (sector + model.sectors - 1) % model.sectors * count + k;
            const int left = (sector + 1) % model.sectors * count + k;
            equations.add<3>({right, node, left}, {1.0, -2.0, 1.0}, 0.0,
                             weightOf(kBendAlong * model.ranges[k] * 2.0 * M_PI / model.sectors));
            if (k + 1 == count) continue;
            const double step = model.ranges[k + 1] - model.ranges[k];
            equations.add<2>({node, node + 1}, {-1.0, 1.0}, 0.0, weightOf(steepest * step));
            if (k + 2 == count) continue;
            const double next = model.ranges[k + 2] - model.ranges[k + 1];
            const double middle = 0.5 * (step + next);
            equations.add<3>({node, node + 1, node + 2}, {middle / step, -middle / step - middle / next, middle / next},
                             0.0, weightOf(kBendOutwards * middle));
        }
    return equations;
}

/// How much a seed counts that lies so high above the surface of the round before; 0: not at all. What stands on the
/// ground reaches down to it in few seeds: those above count less, the lowest are the ground.
double weightOf(const GroundSeed& seed, double above, bool last) {
    constexpr double kUsualStep = 0.15;  // [m]
    constexpr double kLeast = 0.2;
    // Of the tolerance: the ground is what lies lowest, and what stands higher has no ground that leads up to it. Once
    // more so in the last round, when the surface has settled.
    constexpr double kAbove = 0.6;
    constexpr double kLastAbove = 0.36;
    const double tolerance = 0.12 + 0.012 * seed.range;
    if (!seed.followed && (above < -tolerance || above > (last ? kLastAbove : kAbove) * tolerance)) return 0.0;
    const double steps = std::max(0.0, above) / kUsualStep;
    return std::max(seed.followed ? 1.0 : kLeast, 1.0 / (1.0 + steps * steps));
}

/// The mean slope where seeds are.
Eigen::Vector3d normalOf(const std::vector<GroundSeed>& seeds, const std::vector<Place>& places,
                         const GroundModel& model) {
    Eigen::Matrix3d a = 1e-6 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < seeds.size(); ++k) {
        const Eigen::Vector3d row(seeds[k].p.x(), seeds[k].p.y(), 1.0);
        a += row * row.transpose();
        b += row * riseAt(model, places[k]);
    }
    const Eigen::Vector2d slope = model.plane.slope + a.ldlt().solve(b).head<2>();
    return Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
}

/// How far the surface rises above the plane, direction by direction.
class SurfaceRise {
  public:
    explicit SurfaceRise(const GroundModel& model)
        : count_(model.ranges.size()),
          sectors_(static_cast<std::size_t>(model.sectors)),
          ranges_(model.ranges.begin(), model.ranges.end()),
          rise_(model.rise.begin(), model.rise.end()) {
        for (std::size_t k = 0; k + 1 < count_; ++k) per_metre_.push_back(1.0f / (ranges_[k + 1] - ranges_[k]));
        std::uint8_t inner = 0;
        for (std::size_t cell = 0; cell < inner_.size(); ++cell) {
            while (inner + 2U < count_ && static_cast<float>(cell) * kCell >= ranges_[inner + 1]) ++inner;
            inner_[cell] = inner;
        }
    }

    /// @param direction  counted in those of the nodes.
    void turnTo(double direction) {
        const auto first = static_cast<std::size_t>(direction);
        along_ = static_cast<float>(direction - static_cast<double>(first));
        right_ = &rise_[first % sectors_ * count_];
        left_ = &rise_[(first + 1) % sectors_ * count_];
    }
    float at(float range) const {
        const float within = std::clamp(range, ranges_.front(), ranges_.back());
        std::size_t inner = inner_[std::min(inner_.size() - 1, static_cast<std::size_t>(within / kCell))];
        inner += static_cast<std::size_t>(inner + 2 < count_ && within >= ranges_[inner + 1]);
        const float low = right_[inner] + along_ * (left_[inner] - right_[inner]);
        const float high = right_[inner + 1] + along_ * (left_[inner + 1] - right_[inner + 1]);
        return low + (high - low) * per_metre_[inner] * (within - ranges_[inner]);
    }

  private:
    static constexpr float kCell = 0.5f;  // [m], shorter than the ranges are apart

    std::size_t count_;  ///< ranges
    std::size_t sectors_;
    std::vector<float> ranges_;
    std::vector<float> rise_;
    std::vector<float> per_metre_;           ///< 1 over the distance of neighbouring ranges [1/m]
    std::array<std::uint8_t, 128> inner_{};  ///< range below each cell of ranges
    const float* right_ = nullptr;
    const float* left_ = nullptr;
    float along_ = 0.0f;  ///< from right to left
};

constexpr float kInOneDirection = 0.005f;  // sine

}  // namespace

void measureHeights(const PointCloud& cloud, GroundModel& model) {
    SurfaceRise rise(model);
    const Eigen::Vector2f center = model.center.cast<float>();
    const Eigen::Vector3f plane =
        Eigen::Vector3d(model.plane.offset, model.plane.slope.x(), model.plane.slope.y()).cast<float>();
    const bool by_column = !cloud.view.empty() && cloud.sensors.empty();
    std::int32_t column = -1;
    Eigen::Vector2f turned_to = Eigen::Vector2f::Zero();
    float turned_to_range = 0.0f;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f& p = cloud.xyz[i];
        const Eigen::Vector2f d = p.head<2>() - center;
        const float range = d.norm();
        // A column of a tilted or moving sensor is not in one direction.
        const float aside = std::abs(d.x() * turned_to.y() - d.y() * turned_to.x());
        if (!by_column || cloud.view.column_of[i] != column || aside > kInOneDirection * range * turned_to_range) {
            if (by_column) column = cloud.view.column_of[i];
            turned_to = d;
            turned_to_range = range;
            rise.turnTo(directionOf(model, d.x(), d.y()));
        }
        model.height[i] = p.z() - plane[0] - plane[1] * p.x() - plane[2] * p.y() - rise.at(range);
    }
}

double GroundModel::heightAt(double x, double y) const {
    const double level = plane.heightAt(x, y);
    return rise.empty() ? level : level + riseAt(*this, placeOf(*this, x, y));
}

void fitSurface(const std::vector<GroundSeed>& seeds, const GroundPlane& plane, const GroundParams& params,
                GroundModel& model) {
    model.plane = plane;
    model.sectors = params.sectors;
    model.ranges = kRanges;
    model.rise.assign(model.ranges.size() * static_cast<std::size_t>(model.sectors), 0.0);
    std::vector<Place> places;
    places.reserve(seeds.size());
    for (const GroundSeed& s : seeds) places.push_back(placeOf(model, s.p.x(), s.p.y()));
    const NodeEquations smooth = smoothGround(model, params);
    for (int round = 0; round < params.iterations; ++round) {
        NodeEquations equations = smooth;
        for (std::size_t k = 0; k < seeds.size(); ++k) {
            const double rise = seeds[k].p.z() - plane.heightAt(seeds[k].p.x(), seeds[k].p.y());
            const double weight = weightOf(seeds[k], rise - riseAt(model, places[k]), round + 1 == params.iterations);
            if (weight > 0.0) equations.add<4>(places[k].node, places[k].share, rise, weight);
        }
        model.rise = equations.solve();
    }
    model.normal = normalOf(seeds, places, model);
}

}  // namespace lidar_obstacles
