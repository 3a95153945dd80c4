// SPDX-License-Identifier: BSD-3-Clause
#include "objects/face_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lidar_obstacles/ground.h"
#include "scan/floor_to_int.h"

namespace lidar_obstacles {
namespace {

using Vec2 = Eigen::Vector2d;
constexpr auto kPiF = static_cast<float>(M_PI);
constexpr int kMaxContour = 40;

/// What the sensor sees of the outline: the nearest return of each azimuth step, and its share of the outline.
struct Contour {
    std::vector<Vec2> points;     ///< relative to the sensor, in the order of azimuth, in either sense
    std::vector<double> weights;  ///< length of outline it stands for [m]
};

/// The azimuth step of each point, counted from that of the first, so that those of a cluster do not wrap: columns of
/// the view where there is one of one sensor.
std::vector<int> azimuthSteps(const CroppedCluster& c) {
    constexpr float kStep = 0.0035f;  // 0.2 deg, for clouds without such a view
    const OrganizedView& view = c.cloud.view;
    std::vector<int> steps(c.points.size());
    if (!view.empty() && c.cloud.sensors.empty()) {
        const int middle = view.column_of[c.cluster.points[0]];
        const int half = view.columns / 2;
        for (std::size_t i = 0; i < steps.size(); ++i) {
            const int step = view.column_of[c.cluster.points[i]] - middle;
            steps[i] = step > half ? step - view.columns : step < -half ? step + view.columns : step;
        }
        return steps;
    }
    const auto angleOf = [](const Vec2& p) { return fastAtan2(static_cast<float>(p.y()), static_cast<float>(p.x())); };
    const float middle = angleOf(c.points[0]);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const float a = angleOf(c.points[i]) - middle;
        steps[i] = floorToInt((a > kPiF ? a - 2 * kPiF : a < -kPiF ? a + 2 * kPiF : a) / kStep);
    }
    return steps;
}

/// The nearest point of each azimuth step: places in the list, in the order of azimuth.
std::vector<std::int32_t> nearestPerAzimuth(const CroppedCluster& c) {
    const std::vector<int> steps = azimuthSteps(c);
    const auto [first, last] = std::minmax_element(steps.begin(), steps.end());
    std::vector<std::int32_t> nearest(*last - *first + 1, -1);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        std::int32_t& n = nearest[steps[i] - *first];
        if (n < 0 || c.points[i].squaredNorm() < c.points[n].squaredNorm()) n = static_cast<std::int32_t>(i);
    }
    nearest.erase(std::remove(nearest.begin(), nearest.end(), -1), nearest.end());
    return nearest;
}

/// Do the rings above and below show that return i lies on a flat surface? Far neighbours tell nothing.
bool onFlatSurface(const PointCloud& cloud, std::int32_t i) {
    constexpr float kFar = 0.6f;    // [m]
    constexpr float kSteep = 0.5f;  // rise over run
    const OrganizedView& view = cloud.view;
    if (view.empty()) return false;
    bool flat = false;
    for (const int step : {-1, 1}) {
        const int ring = cloud.ring[i] + step;
        const bool is_there = ring >= cloud.firstRing(cloud.ring[i]) && ring < cloud.endRing(cloud.ring[i]);
        const std::int32_t j = is_there ? view.at(ring, view.column_of[i]) : -1;
        if (j < 0) continue;
        const float run = (cloud.xyz[j] - cloud.xyz[i]).head<2>().norm();
        if (run > kFar) continue;
        if (std::abs(cloud.xyz[j].z() - cloud.xyz[i].z()) > kSteep * run) return false;
        flat = true;
    }
    return flat;
}

/// Lowers the weight of points on flat surfaces, unless the outline has little else.
void discountFlat(const CroppedCluster& cropped, const std::vector<std::int32_t>& nearest, Contour& c) {
    constexpr double kDiscount = 0.15;
    constexpr double kMinUpright = 0.3;  // share of the outline
    std::vector<double> discounted = c.weights;
    double upright = 0.0;
    double total = 0.0;
    for (std::size_t i = 0; i < nearest.size(); ++i) {
        const bool flat = onFlatSurface(cropped.cloud, cropped.cluster.points[nearest[i]]);
        if (flat) discounted[i] *= kDiscount;
        upright += flat ? 0.0 : c.weights[i];
        total += c.weights[i];
    }
    if (upright >= kMinUpright * total) c.weights = discounted;
}

Contour outline(const CroppedCluster& cropped) {
    const std::vector<std::int32_t> nearest = everyKth(nearestPerAzimuth(cropped), kMaxContour);
    Contour c;
    c.points.reserve(nearest.size());
    for (const std::int32_t i : nearest) c.points.push_back(cropped.points[i]);
    const std::size_t n = c.points.size();
    c.weights.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const double before = i > 0 ? (c.points[i] - c.points[i - 1]).norm() : 0.0;
        const double after = i + 1 < n ? (c.points[i + 1] - c.points[i]).norm() : 0.0;
        c.weights[i] = std::clamp(0.5 * (before + after), 0.02, 0.3);
    }
    discountFlat(cropped, nearest, c);
    return c;
}

/// One number for each point of an outline, so that all are computed at once; shorter outlines repeat their first point
/// without weight.
using Numbers = Eigen::Array<float, kMaxContour, 1>;

/// Their sum, by halves: any machine adds up in this order.
template <int kCount>
float sumOf(const Eigen::Array<float, kCount, 1>& numbers) {
    if constexpr (kCount % 2 == 0) {
        constexpr int kHalf = kCount / 2;
        return sumOf<kHalf>(numbers.template head<kHalf>() + numbers.template tail<kHalf>());
    } else {
        float sum = numbers[0];
        for (int k = 1; k < kCount; ++k) sum += numbers[k];
        return sum;
    }
}

/// A direction seen from above.
struct Direction {
    explicit Direction(double a)
        : angle(a), cosine(static_cast<float>(std::cos(a))), sine(static_cast<float>(std::sin(a))) {}

    double angle;  ///< [rad]
    float cosine;
    float sine;
};

/// An outline whose edges are looked for.
class EdgeCost {
  public:
    EdgeCost(const Contour& c, double limit) : limit_(static_cast<float>(limit)) {
        for (int i = 0; i < kMaxContour; ++i) {
            const bool there = i < static_cast<int>(c.points.size());
            x_[i] = static_cast<float>(c.points[there ? i : 0].x());
            y_[i] = static_cast<float>(c.points[there ? i : 0].y());
            weight_[i] = there ? static_cast<float>(c.weights[i]) : 0.0f;
        }
        total_ = sumOf<kMaxContour>(weight_);
    }

    /// Mean distance of the outline to the nearer of the two seen edges, each return counting by its share of it [m].
    float operator()(const Direction& d) const {
        const Numbers u = d.cosine * x_ + d.sine * y_;
        const Numbers v = d.cosine * y_ - d.sine * x_;
        return sumOf<kMaxContour>(weight_ * (u - edge(u)).abs().min((v - edge(v)).abs()).min(limit_)) / total_;
    }

  private:
    /// The place of the edge turned to the sensor; out of reach where none is seen.
    static float edge(const Numbers& places) {
        constexpr float kNone = 1e9f;
        const float low = places.minCoeff();
        const float high = places.maxCoeff();
        return low > 0.0f ? low : high < 0.0f ? high : kNone;
    }

    Numbers x_;
    Numbers y_;
    Numbers weight_;
    float limit_;
    float total_ = 0.0f;
};

std::vector<Direction> everyFiveDegrees() {
    constexpr int kQuarterTurn = 18;
    std::vector<Direction> directions;
    directions.reserve(kQuarterTurn);
    for (int k = 0; k < kQuarterTurn; ++k) directions.emplace_back(k * M_PI / 36.0);
    return directions;
}

/// Coarse to fine search of the angle in [0, 90 deg).
double searchAngle(const Contour& c, double limit) {
    const EdgeCost costOf(c, limit);
    static const std::vector<Direction> kCoarse = everyFiveDegrees();
    double best = 0.0;
    float best_cost = std::numeric_limits<float>::max();
    const auto attempt = [&](const Direction& d) {
        const float cost = costOf(d);
        if (cost < best_cost) {
            best_cost = cost;
            best = d.angle;
        }
    };
    for (const Direction& d : kCoarse) attempt(d);
    for (double step = M_PI / 120.0; step > 0.002; step /= 2.5) {
        const double center = best;
        attempt(Direction(center - step));
        attempt(Direction(center + step));
        if (best == center) continue;
        attempt(Direction(best + (best - center)));
    }
    return best;
}

}  // namespace

Orientation fitSeenFaces(const CroppedCluster& cropped, const PlaneFitParams& params) {
    const Contour contour = outline(cropped);
    const std::vector<Vec2> some = everyKth(cropped.points, 300);  // enough to average out the noise of range
    Orientation o;
    o.rule = HeadingRule::Plane;
    o.angle = searchAngle(contour, params.edge_limit);
    for (int k = 0; k < 2; ++k) alignWithFaces(contour.points, some, params.inlier_distance, o);
    return o;
}

}  // namespace lidar_obstacles
