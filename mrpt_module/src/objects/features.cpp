#include "lidar_obstacles/features.h"

#include <algorithm>
#include <cmath>

#include "objects/feature_tools.h"
#include "objects/footprint.h"

namespace lidar_obstacles {
/// The smallest rectangle around a group, seen from above.
struct FeatureExtractor::Box {
    Eigen::Vector2f along{1.0f, 0.0f};  ///< its longer side
    Eigen::Vector2f across{0.0f, 1.0f};
    Eigen::AlignedBox2f extent;  ///< in these directions [m]
};

FeatureExtractor::FeatureExtractor(const Beams& beams, const GroundModel& ground)
    : beams_(beams),
      ground_(ground),
      owner_(beams.cloud().size(), -1),
      surface_top_(beams.cloud().size(), kUnknownTop) {}

FeatureVector FeatureExtractor::operator()(const Hypothesis& h, const Footprint& footprint) {
    FeatureVector f{};
    if (h.points.empty()) return f;
    gather(h.points);
    at(f, Feature::Returns) = std::log2(static_cast<float>(h.points.size()));
    const Box box = measureBox(h.points, footprint, f);
    measureHeights(h.points, f);
    measureProfile(h.points, box, f);
    measureRings(f);
    measureColumns(f);
    measureGaps(f);
    measureEnds(f);
    measureSurface(h.points, f);
    measureEdges(h.points, box, f);
    at(f, Feature::Gap) = h.gap;
    at(f, Feature::NextGap) = h.next_gap;
    at(f, Feature::Pieces) = static_cast<float>(std::min(16, h.pieces));
    const float range = at(f, Feature::Range);
    const int middle = static_cast<int>(runs_.size()) / 2;
    const float step = std::min(beams_.stepUp(middle), 0.2f);
    at(f, Feature::RingStep) = range * step;
    at(f, Feature::BeamStep) = range * beams_.azimuthStep();
    const Eigen::Vector3f& sensor = beams_.cloud().sensor_origin;
    at(f, Feature::SensorHeight) = sensor.z() - static_cast<float>(ground_.heightAt(sensor.x(), sensor.y()));
    at(f, Feature::Noise) = beams_.noise();
    return f;
}

/// Marks the group's returns as its own, and notes where it was hit in each column and by each ring.
void FeatureExtractor::gather(const std::vector<std::int32_t>& points) {
    const OrganizedView& view = beams_.cloud().view;
    ++stamp_;
    reference_ = beams_.column(points[0]);
    const int half = view.columns / 2;
    const auto place = [&](std::int32_t i) {
        const int d = beams_.column(i) - reference_;
        return d > half ? d - view.columns : d < -half ? d + view.columns : d;
    };
    int first = 0;
    int last = 0;
    for (const std::int32_t i : points) {
        owner_[i] = stamp_;
        first = std::min(first, place(i));
        last = std::max(last, place(i));
    }
    first_column_ = first;
    columns_.assign(static_cast<std::size_t>(last - first) + 1, Column{});
    runs_.assign(static_cast<std::size_t>(view.rings), RingRun{});
    for (const std::int32_t i : points) {
        const int at_column = place(i);
        Column& c = columns_[static_cast<std::size_t>(at_column - first)];
        const float range = beams_.range(i);
        const bool fresh = c.lowest < 0;
        c.near = fresh ? range : std::min(c.near, range);
        c.far = fresh ? range : std::max(c.far, range);
        if (fresh || beams_.ring(i) < beams_.ring(c.lowest)) c.lowest = i;
        if (fresh || beams_.ring(i) > beams_.ring(c.highest)) c.highest = i;
        RingRun& run = runs_[static_cast<std::size_t>(beams_.ring(i))];
        if (run.returns == 0 || at_column < run.first) {
            run.first = at_column;
            run.from = i;
        }
        if (run.returns == 0 || at_column > run.last) {
            run.last = at_column;
            run.to = i;
        }
        ++run.returns;
    }
}

FeatureExtractor::Box FeatureExtractor::measureBox(const std::vector<std::int32_t>& points, const Footprint& footprint,
                                                   FeatureVector& f) const {
    const PointCloud& cloud = beams_.cloud();
    const SmallestRectangle r = smallestRectangle(footprint);
    Box box;
    box.along = r.along;
    box.across = {-r.along.y(), r.along.x()};
    Eigen::Vector2f mean = Eigen::Vector2f::Zero();
    Eigen::Matrix2f squares = Eigen::Matrix2f::Zero();
    float nearest = 1e9f;
    const Eigen::Vector2f origin = cloud.xyz[points[0]].head<2>();
    for (const std::int32_t i : points) {
        const Eigen::Vector2f p = cloud.xyz[i].head<2>();
        box.extent.extend(Eigen::Vector2f(box.along.dot(p), box.across.dot(p)));
        mean += p - origin;
        squares += (p - origin) * (p - origin).transpose();
        nearest = std::min(nearest, beams_.range(i));
    }
    const auto n = static_cast<float>(points.size());
    mean /= n;
    const Eigen::Matrix2f spread = squares / n - mean * mean.transpose();
    const float half_trace = 0.5f * spread.trace();
    const float root = std::sqrt(std::max(0.0f, half_trace * half_trace - spread.determinant()));
    const float small = std::max(0.0f, half_trace - root);
    at(f, Feature::Thickness) = half_trace + root > 1e-9f ? std::sqrt(small / (half_trace + root)) : 0.0f;
    const Eigen::Vector2f sight = (origin + mean - cloud.sensor_origin.head<2>()).normalized();
    at(f, Feature::Facing) = std::abs(box.across.dot(sight));
    at(f, Feature::Range) = nearest;
    at(f, Feature::Length) = r.length;
    at(f, Feature::Width) = r.width;
    return box;
}

/// Height above the ground that the surface at a return reaches, followed from ring to ring [m].
float FeatureExtractor::surfaceTop(std::int32_t i) {
    constexpr float kRun = 0.25f;  // between two rings, and as much again of the rise
    if (surface_top_[i] > kUnknownTop) return surface_top_[i];
    const PointCloud& cloud = beams_.cloud();
    float top = ground_.height[i];
    for (int ring = beams_.ring(i) + 1; ring < cloud.view.rings; ++ring) {
        const std::int32_t j = cloud.view.at(ring, beams_.column(i));
        if (j < 0) continue;
        const float limit = kRun + kRun * (ground_.height[j] - ground_.height[i]);
        if (limit > 0.0f && std::abs(beams_.range(j) - beams_.range(i)) <= limit) top = surfaceTop(j);
        break;
    }
    return surface_top_[i] = top;
}

void FeatureExtractor::measureHeights(const std::vector<std::int32_t>& points, FeatureVector& f) {
    float low = 1e9f;
    float high = -1e9f;
    float sum = 0.0f;
    float squares = 0.0f;
    std::array<int, 5> bins{};
    for (const std::int32_t i : points) {
        const float h = ground_.height[i];
        low = std::min(low, h);
        high = std::max(high, h);
        sum += h;
        squares += h * h;
        ++bins[h < 0.4f ? 0 : h < 0.9f ? 1 : h < 1.4f ? 2 : h < 1.9f ? 3 : 4];
    }
    const auto n = static_cast<float>(points.size());
    float top = high;
    float limit = high;
    const std::size_t stride = 1 + columns_.size() / kMost;
    for (std::size_t k = 0; k < columns_.size(); k += stride) {
        const std::int32_t i = columns_[k].highest;
        if (i < 0) continue;
        top = std::max(top, surfaceTop(i));
        limit = std::max(limit, ground_.height[i] + beams_.stepUp(beams_.ring(i)) * beams_.range(i));
    }
    at(f, Feature::Top) = std::min(top, kFarAway);
    at(f, Feature::Bottom) = low;
    at(f, Feature::TopLimit) = std::min(limit, kFarAway);
    at(f, Feature::MeanHeight) = sum / n;
    at(f, Feature::HeightSpread) = std::sqrt(std::max(0.0f, squares / n - sum * sum / (n * n)));
    for (std::size_t k = 0; k < bins.size(); ++k)
        f[static_cast<std::size_t>(Feature::ShareKnee) + k] = static_cast<float>(bins[k]) / n;
}

/// Widths and distances of the thirds of its height.
void FeatureExtractor::measureProfile(const std::vector<std::int32_t>& points, const Box& box, FeatureVector& f) const {
    const float low = at(f, Feature::Bottom);
    float high = low;
    for (const std::int32_t i : points) high = std::max(high, ground_.height[i]);
    const float third = std::max(1e-3f, (high - low) / 3.0f);
    std::array<float, 3> first{1e9f, 1e9f, 1e9f};
    std::array<float, 3> last{-1e9f, -1e9f, -1e9f};
    std::array<float, 3> range{};
    std::array<int, 3> count{};
    for (std::size_t n = 0; n < points.size(); n += strideFor(points.size())) {
        const std::int32_t i = points[n];
        const auto k = static_cast<std::size_t>(std::clamp((ground_.height[i] - low) / third, 0.0f, 2.0f));
        const float place = box.along.dot(beams_.cloud().xyz[i].head<2>());
        first[k] = std::min(first[k], place);
        last[k] = std::max(last[k], place);
        range[k] += beams_.range(i);
        ++count[k];
    }
    const float length = std::max(0.05f, at(f, Feature::Length));
    for (std::size_t k = 0; k < 3; ++k)
        f[static_cast<std::size_t>(Feature::WidthLow) + k] = count[k] > 0 ? (last[k] - first[k]) / length : 0.0f;
    if (count[0] > 0 && count[2] > 0)
        at(f, Feature::Lean) = range[2] / static_cast<float>(count[2]) - range[0] / static_cast<float>(count[0]);
}

void FeatureExtractor::measureRings(FeatureVector& f) {
    int rings = 0;
    int returns = 0;
    int beams = 0;
    float sum = 0.0f;
    float squares = 0.0f;
    int lowest = -1;
    for (std::size_t ring = 0; ring < runs_.size(); ++ring) {
        const RingRun& run = runs_[ring];
        if (run.returns == 0) continue;
        if (lowest < 0) lowest = static_cast<int>(ring);
        ++rings;
        returns += run.returns;
        beams += run.last - run.first + 1;
        const float width = (beams_.cloud().xyz[run.to] - beams_.cloud().xyz[run.from]).head<2>().norm();
        sum += width;
        squares += width * width;
    }
    const auto n = static_cast<float>(std::max(1, rings));
    const float mean = sum / n;
    at(f, Feature::Rings) = static_cast<float>(rings);
    at(f, Feature::Fill) = std::min(1.0f, share(returns, beams));
    at(f, Feature::RingWidthSpread) = mean > 0.02f ? std::sqrt(std::max(0.0f, squares / n - mean * mean)) / mean : 0.0f;
    const float step = std::max(1e-3f, std::min(0.2f, beams_.stepUp(std::max(0, lowest)))) * at(f, Feature::Range);
    const float room = 1.0f + (at(f, Feature::Top) - at(f, Feature::Bottom)) / std::max(0.01f, step);
    at(f, Feature::RingShare) = std::min(2.0f, static_cast<float>(rings) / room);
}

void FeatureExtractor::measureSurface(const std::vector<std::int32_t>& points, FeatureVector& f) {
    const PointCloud& cloud = beams_.cloud();
    const OrganizedView& view = cloud.view;
    numbers_.clear();
    int pairs = 0, jumps = 0, steps = 0, steep = 0;
    for (std::size_t n = 0; n < points.size(); n += strideFor(points.size())) {
        const std::int32_t i = points[n];
        const std::int32_t next = beams_.beside(i, 1);
        if (next >= 0 && mine(next)) {
            ++pairs;
            jumps += std::abs(beams_.range(next) - beams_.range(i)) > 0.3f + 0.02f * beams_.range(i);
        }
        const float rough = beams_.roughness(i);
        if (rough >= 0.0f) numbers_.push_back(rough);
        const int ring = beams_.ring(i) + 1;
        const std::int32_t above = ring < view.rings ? view.at(ring, beams_.column(i)) : -1;
        if (above < 0 || !mine(above)) continue;
        ++steps;
        const float run = (cloud.xyz[above] - cloud.xyz[i]).head<2>().norm();
        steep += cloud.xyz[above].z() - cloud.xyz[i].z() > run;
    }
    const float median = quantile(numbers_, 0.5f, 0.0f);
    at(f, Feature::RoughMetres) = median;
    at(f, Feature::RoughMedian) = std::min(50.0f, median / beams_.noise());
    at(f, Feature::RoughHigh) = std::min(100.0f, quantile(numbers_, 0.9f, 0.0f) / beams_.noise());
    at(f, Feature::Jumps) = share(jumps, pairs);
    at(f, Feature::Steep) = share(steep, steps);
}

/// How near the returns lie to the two sides of the rectangle that are turned to the sensor.
void FeatureExtractor::measureEdges(const std::vector<std::int32_t>& points, const Box& box, FeatureVector& f) {
    const PointCloud& cloud = beams_.cloud();
    const Eigen::Vector2f sensor(box.along.dot(cloud.sensor_origin.head<2>()),
                                 box.across.dot(cloud.sensor_origin.head<2>()));
    const Eigen::Vector2f middle = box.extent.center();
    const Eigen::Vector2f seen(sensor.x() < middle.x() ? box.extent.min().x() : box.extent.max().x(),
                               sensor.y() < middle.y() ? box.extent.min().y() : box.extent.max().y());
    numbers_.clear();
    float sum = 0.0f;
    for (std::size_t n = 0; n < points.size(); n += strideFor(points.size())) {
        const Eigen::Vector2f p = cloud.xyz[points[n]].head<2>();
        const float d = std::min(std::abs(box.along.dot(p) - seen.x()), std::abs(box.across.dot(p) - seen.y()));
        numbers_.push_back(d);
        sum += d;
    }
    at(f, Feature::EdgeMean) = sum / static_cast<float>(numbers_.size());
    at(f, Feature::EdgeHigh) = quantile(numbers_, 0.9f, 0.0f);
}

}  // namespace lidar_obstacles
