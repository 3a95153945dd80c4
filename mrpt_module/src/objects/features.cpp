#include "lidar_obstacles/features.h"

#include <algorithm>
#include <cmath>

#include "objects/footprint.h"

namespace lidar_obstacles {
namespace {

constexpr float kFarAway = 10.0f;   // what is farther apart has nothing to do with each other [m]
constexpr std::size_t kMost = 256;  // returns that are looked at; of more, every k-th
constexpr int kMostColumns = 24;    // likewise
constexpr float kBehind = 0.5f;     // a beam that ends so far behind a thing passed it [m]
constexpr float kUnknownTop = -1e9f;

float& at(FeatureVector& f, Feature k) { return f[static_cast<std::size_t>(k)]; }

std::size_t strideFor(std::size_t count) { return 1 + count / kMost; }

/// The k-th of n (0 .. 1) of some numbers; `otherwise` where there is none. Reorders them.
float quantile(std::vector<float>& numbers, float k, float otherwise) {
    if (numbers.empty()) return otherwise;
    const auto place = numbers.begin() + static_cast<std::ptrdiff_t>(k * static_cast<float>(numbers.size() - 1));
    std::nth_element(numbers.begin(), place, numbers.end());
    return *place;
}

float share(int part, int of) { return of > 0 ? static_cast<float>(part) / static_cast<float>(of) : 0.0f; }

}  // namespace

/// The smallest rectangle around a group, seen from above.
struct FeatureExtractor::Box {
    Eigen::Vector2f along{1.0f, 0.0f};  ///< its longer side
    Eigen::Vector2f across{0.0f, 1.0f};
    Eigen::AlignedBox2f extent;  ///< in these directions [m]
};

const std::array<FeatureInfo, kFeatures>& featureInfos() {
    static const std::array<FeatureInfo, kFeatures> kInfos = {{
        {"returns", "", "logarithm of the number of returns, base 2"},
        {"range", "m", "horizontal distance of the nearest return from the sensor"},
        {"length", "m", "longer side of the smallest rectangle, seen from above"},
        {"width", "m", "shorter side"},
        {"facing", "", "how far the longer side is turned to the line of sight: 0 along it, 1 across"},
        {"top", "m", "height that its surfaces reach above the ground, followed beyond the region"},
        {"bottom", "m", "height of the lowest return"},
        {"top_limit", "m", "height at which the next ring passed above it, 10 at most"},
        {"mean_height", "m", "mean height of the returns"},
        {"height_spread", "m", "standard deviation of the heights"},
        {"share_knee", "", "share of the returns below .4 m"},
        {"share_hip", "", "from .4 to .9 m"},
        {"share_chest", "", "from .9 to 1.4 m"},
        {"share_head", "", "from 1.4 to 1.9 m"},
        {"share_above", "", "above 1.9 m"},
        {"width_low", "", "extent along the longer side of the lower third of the heights, as a share of it"},
        {"width_middle", "", "of the middle third"},
        {"width_high", "", "of the upper third"},
        {"lean", "m", "how much farther from the sensor the upper third is than the lower one"},
        {"ring_width_spread", "", "standard deviation of the widths that the rings see, over their mean"},
        {"rings", "", "rings that hit it"},
        {"ring_share", "", "those over the rings that its height has room for at its range"},
        {"fill", "", "returns over the beams between the first and the last of each ring"},
        {"through", "", "share of the beams through its volume that ended well behind it"},
        {"under", "", "beams that passed below it, over its columns"},
        {"hidden", "", "share of the beams towards it that something nearer ended"},
        {"ground_inside", "", "share of its columns with ground returns between its near and far side"},
        {"floating", "", "share of its columns in which the next beam down passed below it and went on"},
        {"gap_share", "", "share of the columns between its ends in which nothing of it was hit"},
        {"gap_free", "m", "width of those in which beams passed where it would have stopped them, below its windows"},
        {"gap_hidden", "m", "width of those in which something nearer ended the beams"},
        {"goes_on_more", "", "share of the rings at whose end the surface goes on beside it, on the side with more"},
        {"goes_on_less", "", "on the side with less"},
        {"hidden_more", "", "share of the rings at whose end something nearer stands, on the side with more"},
        {"hidden_less", "", "on the side with less"},
        {"goes_up", "", "share of the columns in which the next ring up hits the same surface, which is not in it"},
        {"goes_down", "", "the same for the next ring down"},
        {"rough_median", "", "distance of returns to the line between their neighbours, over the scan's noise: median"},
        {"rough_high", "", "the same: nine in ten are smaller"},
        {"rough_metres", "m", "the same median in metres"},
        {"jumps", "", "share of neighbouring beams inside it between which the range jumps"},
        {"edge_mean", "m", "mean distance of the returns to the nearer of the rectangle's sides towards the sensor"},
        {"edge_high", "m", "the same: nine in ten are smaller"},
        {"thickness", "", "smaller over larger standard deviation, seen from above"},
        {"steep", "", "share of the steps from ring to ring that rise more than they run"},
        {"gap", "m", "widest gap between the pieces it is made of"},
        {"next_gap", "m", "to the nearest other piece"},
        {"pieces", "", "how many pieces it is made of, 16 at most"},
        {"ring_step", "m", "distance of neighbouring rings at its range"},
        {"beam_step", "m", "distance of neighbouring beams of a ring at its range"},
        {"sensor_height", "m", "height of the sensor above the ground"},
        {"noise", "m", "of the scan's ranges"},
    }};
    return kInfos;
}

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
    columns_.assign(static_cast<std::size_t>(last - first + 1), Column{});
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

/// What the beams of its columns show: through it, below it, in front of it, above and below its surface.
void FeatureExtractor::measureColumns(FeatureVector& f) {
    const PointCloud& cloud = beams_.cloud();
    const OrganizedView& view = cloud.view;
    const float bottom = at(f, Feature::Bottom);
    int looked_at = 0, hits = 0, through = 0, under = 0, hidden = 0, inside = 0, floating = 0, up = 0, down = 0;
    const std::size_t stride = 1 + columns_.size() / kMostColumns;
    for (std::size_t k = 0; k < columns_.size(); k += stride) {
        const Column& c = columns_[k];
        if (c.lowest < 0) continue;
        ++looked_at;
        const int column = view.wrap(reference_ + first_column_ + static_cast<int>(k));
        const int low = beams_.ring(c.lowest);
        const int high = beams_.ring(c.highest);
        bool ground_inside = false;
        bool below_known = false;
        for (int ring = high; ring >= 0; --ring) {
            const std::int32_t j = view.at(ring, column);
            if (j < 0) continue;
            if (mine(j)) {
                ++hits;
                continue;
            }
            const float range = beams_.range(j);
            const bool ground = ground_.is_ground[j] != 0;
            if (ground && range > c.near + 0.3f && range < c.far - 0.3f) ground_inside = true;
            if (range > c.far + kBehind) {
                const float height = ground_.height[j] + (beams_.beamHeight(j, c.far) - cloud.xyz[j].z());
                ++(height < bottom ? under : through);
            } else if (range < c.near - kBehind && !ground) {
                ++hidden;
            }
            if (ring < low && !below_known) {
                below_known = true;
                floating += range > c.near + kBehind;
                down += !ground && std::abs(range - beams_.range(c.lowest)) <= kBehind;
            }
        }
        inside += ground_inside;
        for (int ring = high + 1; ring < view.rings; ++ring) {
            const std::int32_t j = view.at(ring, column);
            if (j < 0) continue;
            up += !mine(j) && std::abs(beams_.range(j) - beams_.range(c.highest)) <= kBehind;
            break;
        }
    }
    at(f, Feature::Through) = share(through, through + hits);
    at(f, Feature::Under) = share(under, looked_at);
    at(f, Feature::Hidden) = share(hidden, hidden + hits);
    at(f, Feature::GroundInside) = share(inside, looked_at);
    at(f, Feature::Floating) = share(floating, looked_at);
    at(f, Feature::GoesUp) = share(up, looked_at);
    at(f, Feature::GoesDown) = share(down, looked_at);
}

/// What the beams show between the columns in which it was hit: a gap that they passed parts two things; one that
/// something nearer hides does not.
void FeatureExtractor::measureGaps(FeatureVector& f) const {
    constexpr float kBelly = 0.3f;
    constexpr float kWindows = 0.8f;
    constexpr std::size_t kMostGaps = 96;  // columns that are looked at; of more, every k-th
    const PointCloud& cloud = beams_.cloud();
    const float highest = std::min(kWindows, at(f, Feature::Top) - 0.2f);
    int empty = 0, looked_at = 0, free = 0, hidden = 0;
    for (const Column& c : columns_) empty += c.lowest < 0;
    const std::size_t stride = 1 + static_cast<std::size_t>(empty) / kMostGaps;
    std::size_t last = 0;  // column before that was hit: the first and the last are
    std::size_t next = 0;
    for (std::size_t k = 0; k < columns_.size(); k += columns_[k].lowest < 0 ? stride : 1) {
        if (columns_[k].lowest >= 0) {
            last = k;
            continue;
        }
        if (next < k) next = k;
        while (columns_[next].lowest < 0) ++next;
        while (columns_[last + 1].lowest >= 0 && last + 1 < k) ++last;
        const float way = static_cast<float>(k - last) / static_cast<float>(next - last);
        const float line = columns_[last].near + way * (columns_[next].near - columns_[last].near);
        ++looked_at;
        bool passed = false, before = false;
        for (int ring = 0; ring < cloud.view.rings && !passed; ++ring) {
            const std::int32_t j =
                cloud.view.at(ring, cloud.view.wrap(reference_ + first_column_ + static_cast<int>(k)));
            if (j < 0) continue;
            const float height = ground_.height[j] + beams_.beamHeight(j, line) - cloud.xyz[j].z();
            if (height > highest) break;
            if (beams_.range(j) > line + kBehind)
                passed = height > kBelly;
            else
                before |= beams_.range(j) < line - kBehind && ground_.is_ground[j] == 0;
        }
        free += passed;
        hidden += before && !passed;
    }
    const float width = at(f, Feature::Range) * beams_.azimuthStep() * share(empty, std::max(1, looked_at));
    at(f, Feature::GapShare) = share(empty, static_cast<int>(columns_.size()));
    at(f, Feature::GapFree) = std::min(kFarAway, width * static_cast<float>(free));
    at(f, Feature::GapHidden) = std::min(kFarAway, width * static_cast<float>(hidden));
}

/// What stands beside it, ring by ring: the same surface, something nearer, or nothing.
void FeatureExtractor::measureEnds(FeatureVector& f) const {
    std::array<int, 2> on{}, hidden{};
    int rings = 0;
    for (const RingRun& run : runs_) {
        if (run.returns == 0) continue;
        ++rings;
        for (std::size_t side = 0; side < 2; ++side) {
            const std::int32_t end = side == 0 ? run.from : run.to;
            const std::int32_t j = beams_.beside(end, side == 0 ? -1 : 1);
            if (j < 0 || ground_.is_ground[j] != 0) continue;
            const float apart = beams_.range(j) - beams_.range(end);
            const float same = 0.3f + 0.02f * beams_.range(end);
            if (std::abs(apart) <= same)
                ++on[side];
            else if (apart < 0.0f)
                ++hidden[side];
        }
    }
    at(f, Feature::GoesOnMore) = share(std::max(on[0], on[1]), rings);
    at(f, Feature::GoesOnLess) = share(std::min(on[0], on[1]), rings);
    at(f, Feature::HiddenMore) = share(std::max(hidden[0], hidden[1]), rings);
    at(f, Feature::HiddenLess) = share(std::min(hidden[0], hidden[1]), rings);
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
