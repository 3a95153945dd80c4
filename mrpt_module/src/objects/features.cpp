// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/feature_extractor.h"

#include <algorithm>
#include <cmath>

#include "objects/feature_tools.h"
#include "objects/footprint.h"
#include "objects/quantiles.h"
#include "scan/listed.h"
#include "scan/looked_columns.h"

namespace lidar_obstacles {

FeatureExtractor::FeatureExtractor(const Beams& beams, const GroundModel& ground)
    : beams_(beams),
      ground_(ground),
      owner_(beams.cloud().size(), -1),
      surface_top_(beams.cloud().size(), kUnknownTop),
      known_(beams.cloud().size(), 0),
      neighbours_(new Neighbours[beams.cloud().size()]),  // not filled: most are never asked for
      end_ring_(beams.cloud().view.rings),
      origin_(beams.cloud().sensor_origin),
      looked_at_(std::make_unique<LookedColumns>(beams.cloud().view)),
      numbers_(std::make_unique<Quantiles>()) {}

FeatureExtractor::~FeatureExtractor() = default;

FeatureVector FeatureExtractor::operator()(const Hypothesis& h, const Footprint& footprint) {
    FeatureVector f{};
    if (h.points.empty()) return f;
    const std::vector<std::int32_t>& points = chooseSensor(h.points);
    gather(points);
    gatherColumns(points);
    at(f, Feature::Returns) = std::log2(static_cast<float>(points.size()));
    const Box box = measureBox(footprint, f);
    measureHeights(f);
    measureProfile(box, f);
    measureRings(f);
    measureColumns(f);
    measureGaps(f);
    measureEnds(f);
    measureNotches(f);
    measureSurface(points, f);
    measureEdges(box, f);
    at(f, Feature::Gap) = h.gap;
    at(f, Feature::NextGap) = h.next_gap;
    at(f, Feature::Pieces) = static_cast<float>(std::min(16, h.pieces));
    const float range = at(f, Feature::Range);
    const int middle = (first_ring_ + end_ring_) / 2;
    const float step = std::min(beams_.stepUp(middle), 0.2f);
    at(f, Feature::RingStep) = range * step;
    at(f, Feature::BeamStep) = range * beams_.azimuthStep();
    at(f, Feature::SensorHeight) = origin_.z() - static_cast<float>(ground_.heightAt(origin_.x(), origin_.y()));
    at(f, Feature::Noise) = beams_.noise();
    return f;
}

/// The returns of the sensor that sees the group best, in most places of its view: beams of different sensors are no
/// neighbours.
const std::vector<std::int32_t>& FeatureExtractor::chooseSensor(const std::vector<std::int32_t>& points) {
    const PointCloud& cloud = beams_.cloud();
    if (cloud.sensors.empty()) return points;
    std::vector<std::size_t> places(cloud.sensors.size(), 0);
    for (const std::int32_t i : points)
        places[cloud.sensorOf(i)] += 1 + kListed * static_cast<std::size_t>(isListed(cloud, i));
    const auto best = static_cast<std::size_t>(std::max_element(places.begin(), places.end()) - places.begin());
    origin_ = cloud.sensors[best].origin;
    end_ring_ = cloud.sensors[best].end_ring;
    first_ring_ = cloud.sensors[best].first_ring;
    of_sensor_.clear();
    for (const std::int32_t i : points)
        if (cloud.sensorOf(i) == best) of_sensor_.push_back(i);
    return of_sensor_;
}

/// Marks the group's returns as its own, and adds up what does not depend on its box.
void FeatureExtractor::gather(const std::vector<std::int32_t>& points) {
    const PointCloud& cloud = beams_.cloud();
    const int around = looked_at_->count();
    const int half = around / 2;
    ++stamp_;
    reference_ = looked_at_->placeOf(beams_.column(points[0]));
    members_.resize(points.size());
    const Eigen::Vector2f origin = cloud.xyz[points[0]].head<2>();
    Sums s;
    for (std::size_t n = 0; n < points.size(); ++n) {
        const std::int32_t i = points[n];
        owner_[i] = stamp_;
        const Eigen::Vector3f& p = cloud.xyz[i];
        const int d = looked_at_->placeOf(beams_.column(i)) - reference_;
        const int column = d > half ? d - around : d < -half ? d + around : d;
        const Member m{p.x(), p.y(), ground_.height[i], beams_.range(i), column, beams_.ring(i)};
        members_[n] = m;
        const float dx = m.x - origin.x();
        const float dy = m.y - origin.y();
        s.mean += Eigen::Vector2f(dx, dy);
        s.xx += dx * dx;
        s.xy += dx * dy;
        s.yy += dy * dy;
        s.height += m.height;
        s.height_squared += m.height * m.height;
        s.low = std::min(s.low, m.height);
        s.high = std::max(s.high, m.height);
        s.nearest = std::min(s.nearest, m.range);
        ++s.bins[static_cast<std::size_t>(m.height >= 0.4f) + static_cast<std::size_t>(m.height >= 0.9f) +
                 static_cast<std::size_t>(m.height >= 1.4f) + static_cast<std::size_t>(m.height >= 1.9f)];
    }
    sums_ = s;
}

int FeatureExtractor::viewColumn(std::size_t k) const {
    return looked_at_->columnAt(reference_ + first_column_ + static_cast<int>(k));
}

/// Notes where the group was hit in each column and by each ring.
void FeatureExtractor::gatherColumns(const std::vector<std::int32_t>& points) {
    int first = 0;
    int last = 0;
    for (const Member& m : members_) {
        first = std::min(first, m.column);
        last = std::max(last, m.column);
    }
    first_column_ = first;
    columns_.assign(static_cast<std::size_t>(last - first) + 1, Column{});
    runs_.assign(static_cast<std::size_t>(beams_.cloud().view.rings), RingRun{});
    for (std::size_t n = 0; n < points.size(); ++n) {
        const Member& m = members_[n];
        Column& c = columns_[static_cast<std::size_t>(m.column - first)];
        c.near = std::min(c.near, m.range);
        c.far = std::max(c.far, m.range);
        const bool lower = m.ring < c.low_ring;  // stored either way: which it is cannot be foreseen
        c.low_ring = lower ? m.ring : c.low_ring;
        c.lowest = lower ? points[n] : c.lowest;
        const bool higher = m.ring > c.high_ring;
        c.high_ring = higher ? m.ring : c.high_ring;
        c.highest = higher ? points[n] : c.highest;
        RingRun& run = runs_[static_cast<std::size_t>(m.ring)];
        if (m.column < run.first) {
            run.first = m.column;
            run.from = points[n];
        }
        if (m.column > run.last) {
            run.last = m.column;
            run.to = points[n];
        }
        ++run.returns;
    }
}

FeatureExtractor::Box FeatureExtractor::measureBox(const Footprint& footprint, FeatureVector& f) const {
    const SmallestRectangle r = smallestRectangle(footprint);
    Box box;
    box.along = r.along;
    box.across = {-r.along.y(), r.along.x()};
    for (const Member& m : members_)
        box.extent.extend(
            Eigen::Vector2f(box.along.x() * m.x + box.along.y() * m.y, box.across.x() * m.x + box.across.y() * m.y));
    const auto n = static_cast<float>(members_.size());
    const Eigen::Vector2f mean = sums_.mean / n;
    Eigen::Matrix2f squares;
    squares << sums_.xx, sums_.xy, sums_.xy, sums_.yy;
    const Eigen::Matrix2f spread = squares / n - mean * mean.transpose();
    const float half_trace = 0.5f * spread.trace();
    const float root = std::sqrt(std::max(0.0f, half_trace * half_trace - spread.determinant()));
    const float small = std::max(0.0f, half_trace - root);
    at(f, Feature::Thickness) = half_trace + root > 1e-9f ? std::sqrt(small / (half_trace + root)) : 0.0f;
    const Eigen::Vector2f origin(members_[0].x, members_[0].y);
    const Eigen::Vector2f sight = (origin + mean - origin_.head<2>()).normalized();
    at(f, Feature::Facing) = std::abs(box.across.dot(sight));
    at(f, Feature::Range) = sums_.nearest;
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
    for (int ring = beams_.ring(i) + 1; ring < end_ring_; ++ring) {
        const std::int32_t j = cloud.view.at(ring, beams_.column(i));
        if (j < 0) continue;
        const float limit = kRun + kRun * (ground_.height[j] - ground_.height[i]);
        if (limit > 0.0f && std::abs(beams_.range(j) - beams_.range(i)) <= limit) top = surfaceTop(j);
        break;
    }
    return surface_top_[i] = top;
}

void FeatureExtractor::measureHeights(FeatureVector& f) {
    const auto n = static_cast<float>(members_.size());
    const float sum = sums_.height;
    const float high = sums_.high;
    float top = high;
    float limit = high;
    const std::size_t stride = 1 + columns_.size() / kMost;
    for (std::size_t k = 0; k < columns_.size(); k += stride) {
        const std::int32_t i = columns_[k].highest;
        if (i < 0) continue;
        top = std::max(top, surfaceTop(i));
        limit = std::max(limit, ground_.height[i] + beams_.stepUp(columns_[k].high_ring) * beams_.range(i));
    }
    at(f, Feature::Top) = std::min(top, kFarAway);
    at(f, Feature::Bottom) = sums_.low;
    at(f, Feature::TopLimit) = std::min(limit, kFarAway);
    at(f, Feature::MeanHeight) = sum / n;
    at(f, Feature::HeightSpread) = std::sqrt(std::max(0.0f, sums_.height_squared / n - sum * sum / (n * n)));
    for (std::size_t k = 0; k < sums_.bins.size(); ++k)
        f[static_cast<std::size_t>(Feature::ShareKnee) + k] = static_cast<float>(sums_.bins[k]) / n;
}

/// Widths and distances of the thirds of its height.
void FeatureExtractor::measureProfile(const Box& box, FeatureVector& f) const {
    const float low = sums_.low;
    const float third = std::max(1e-3f, (sums_.high - low) / 3.0f);
    std::array<float, 3> first{1e9f, 1e9f, 1e9f};
    std::array<float, 3> last{-1e9f, -1e9f, -1e9f};
    std::array<float, 3> range{};
    std::array<int, 3> count{};
    for (std::size_t n = 0; n < members_.size(); n += strideFor(members_.size())) {
        const Member& m = members_[n];
        const auto k = static_cast<std::size_t>(std::clamp((m.height - low) / third, 0.0f, 2.0f));
        const float place = box.along.x() * m.x + box.along.y() * m.y;
        first[k] = std::min(first[k], place);
        last[k] = std::max(last[k], place);
        range[k] += m.range;
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

}  // namespace lidar_obstacles
