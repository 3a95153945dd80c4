#include "join_gap.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {

Gap gapBetween(const Footprint& a, const Footprint& b) {
    Gap gap;
    for (std::size_t m = 0; m < a.outline.size(); ++m)
        for (std::size_t n = 0; n < b.outline.size(); ++n) {
            const cv::Point2f way = a.outline[m] - b.outline[n];
            const float squared = way.dot(way);
            if (squared < gap.length) gap = {a.returns[m], b.returns[n], squared};
        }
    gap.length = std::sqrt(gap.length);
    return gap;
}

namespace {

float cross(const Eigen::Vector2f& a, const Eigen::Vector2f& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Where a beam ended with regard to the gap between two components.
enum class Beam : std::uint8_t { Elsewhere, Before, Through };

/// Through: it passed where a vehicle would have stopped it, below its windows. Before: something nearer ended it.
Beam beamAcross(const Beams& scan, const Gap& gap, std::int32_t i) {
    constexpr float kLowest = 0.1f;
    constexpr float kWindows = 0.8f;
    constexpr float kApart = 0.5f;
    const PointCloud& cloud = scan.cloud;
    const Eigen::Vector2f sensor = cloud.sensor_origin.head<2>();
    const Eigen::Vector2f from = cloud.xyz[gap.from].head<2>() - sensor;
    const Eigen::Vector2f along = cloud.xyz[gap.to].head<2>() - cloud.xyz[gap.from].head<2>();
    const Eigen::Vector2f beam = cloud.xyz[i].head<2>() - sensor;
    const float turn = cross(beam, along);
    if (std::abs(turn) < 1e-6f) return Beam::Elsewhere;
    const float share = cross(from, along) / turn;  // of the beam in front of the gap
    const float beyond = (1.0f - share) * beam.norm();
    if (share > 1.0f && beyond < -kApart && !scan.ground.is_ground[i]) return Beam::Before;
    if (share <= 0.0f || beyond < kApart) return Beam::Elsewhere;
    const float sensor_height = cloud.sensor_origin.z() - cloud.xyz[i].z() + scan.ground.height[i];
    const float height = sensor_height + share * (scan.ground.height[i] - sensor_height);
    return height > kLowest && height < kWindows ? Beam::Through : Beam::Elsewhere;
}

/// What a column of the scan shows between two components.
Beam columnAcross(const Beams& scan, const Gap& gap, int column) {
    const OrganizedView& view = scan.cloud.view;
    Beam seen = Beam::Elsewhere;
    for (int ring = 0; ring < view.rings; ++ring) {
        const std::int32_t i = view.at(ring, column);
        if (i < 0) continue;
        const Beam beam = beamAcross(scan, gap, i);
        if (beam == Beam::Through) return beam;
        if (beam == Beam::Before) seen = beam;
    }
    return seen;
}

}  // namespace

bool nothingBetween(const Beams& scan, const Gap& gap, bool may_be_hidden) {
    constexpr int kMinColumns = 2;
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
    int free = 0;
    int hidden = 0;
    for (int k = 1; k < columns; ++k) {
        const Beam seen = columnAcross(scan, gap, view.wrap(first + k));
        free += seen == Beam::Through;
        hidden += seen == Beam::Before;
    }
    return free <= kFreeShare * between && (may_be_hidden || hidden <= kHiddenShare * between);
}

}  // namespace lidar_obstacles
