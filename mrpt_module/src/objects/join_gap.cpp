#include "objects/join_gap.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lidar_obstacles {

Gap gapBetween(const Footprint& a, const Footprint& b) {
    const auto squared = [&](int k) -> Footprint::Numbers { return (b.x - a.x[k]).square() + (b.y - a.y[k]).square(); };
    Footprint::Numbers least = squared(0);  // from each return of b
    for (int k = 1; k < Footprint::kDirections; ++k)
        if (a.returns[k] != a.returns[k - 1]) least = least.min(squared(k));
    Eigen::Index of_b = 0;
    Eigen::Index of_a = 0;
    const float length = std::sqrt(least.minCoeff(&of_b));
    least = (a.x - b.x[of_b]).square() + (a.y - b.y[of_b]).square();
    least.minCoeff(&of_a);
    return {a.returns[of_a], b.returns[of_b], length};
}

namespace {

float cross(const Eigen::Vector2f& a, const Eigen::Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Where a beam ended with regard to the gap between two components.
enum class Beam : std::uint8_t { Elsewhere, Before, Through, Above };

/// A gap seen from above, from the sensor.
struct GapLine {
    Eigen::Vector2f from;   ///< its one end [m]
    Eigen::Vector2f along;  ///< from there to its other end [m]
};

/// Through: it passed where a vehicle would have stopped it, below its windows. Before: something nearer ended it.
/// Above: it passed over that, or would have.
Beam beamAcross(const ScannedGround& scan, const GapLine& gap, std::int32_t i) {
    constexpr float kLowest = 0.1f;
    constexpr float kWindows = 0.8f;
    constexpr float kApart = 0.5f;
    const PointCloud& cloud = scan.cloud;
    const Eigen::Vector2f beam = cloud.xyz[i].head<2>() - cloud.sensor_origin.head<2>();
    const float turn = cross(beam, gap.along);
    if (std::abs(turn) < 1e-6f) return Beam::Elsewhere;
    const float share = cross(gap.from, gap.along) / turn;  // of the beam in front of the gap
    if (share <= 0.0f) return Beam::Elsewhere;
    const float sensor_height = cloud.sensor_origin.z() - cloud.xyz[i].z() + scan.ground.height[i];
    const float height = sensor_height + share * (scan.ground.height[i] - sensor_height);
    if (height >= kWindows) return Beam::Above;
    const float apart = (1.0f - share) * beam.norm();
    if (apart < -kApart && !scan.ground.is_ground[i]) return Beam::Before;
    return apart >= kApart && height > kLowest ? Beam::Through : Beam::Elsewhere;
}

/// What a column of the scan shows between two components.
Beam columnAcross(const ScannedGround& scan, const GapLine& gap, int column) {
    const OrganizedView& view = scan.cloud.view;
    Beam seen = Beam::Elsewhere;
    for (int ring = 0; ring < view.rings; ++ring) {
        const std::int32_t i = view.at(ring, column);
        if (i < 0) continue;
        const Beam beam = beamAcross(scan, gap, i);
        if (beam == Beam::Through) return beam;
        if (beam == Beam::Above) return seen;  // as are all planes above it
        if (beam == Beam::Before) seen = beam;
    }
    return seen;
}

}  // namespace

bool nothingBetween(const ScannedGround& scan, const Gap& gap, bool may_be_hidden) {
    constexpr int kMinColumns = 2;
    constexpr int kMostColumns = 24;  // enough to tell the shares below
    constexpr double kFreeShare = 0.2;
    constexpr double kHiddenShare = 0.5;
    const OrganizedView& view = scan.cloud.view;
    int first = view.column_of[gap.from];
    int columns = view.wrap(view.column_of[gap.to] - first);
    if (columns > view.columns / 2) {
        first = view.column_of[gap.to];
        columns = view.columns - columns;
    }
    const int between = columns - 1;
    if (between < kMinColumns) return false;
    const Eigen::Vector2f from = scan.cloud.xyz[gap.from].head<2>();
    const GapLine line{from - scan.cloud.sensor_origin.head<2>(), scan.cloud.xyz[gap.to].head<2>() - from};
    const int stride = 1 + between / kMostColumns;
    const int looked_at = 1 + (between - 1) / stride;
    int free = 0;
    int hidden = 0;
    for (int k = 1; k < columns; k += stride) {
        const Beam seen = columnAcross(scan, line, view.wrap(first + k));
        free += seen == Beam::Through;
        hidden += seen == Beam::Before;
        if (free > kFreeShare * looked_at || (!may_be_hidden && hidden > kHiddenShare * looked_at)) return false;
    }
    return true;
}

}  // namespace lidar_obstacles
