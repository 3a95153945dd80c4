// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/low_memory.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sequence/zone_shape.h"

namespace lidar_obstacles {
namespace {

constexpr float kFarthestBeam = 15.0f;  ///< returns beyond say nothing about low things [m]

LowThing movedThing(const LowThing& thing, const Eigen::Isometry2d& T) {
    LowThing there = thing;
    const Eigen::Isometry2f t = T.cast<float>();
    for (LowSpan& s : there.spans) s = {t * s.from, t * s.to};
    there.box.center.head<2>() = T * Eigen::Vector2d(thing.box.center.head<2>());
    there.box.yaw = normalizeAngle(thing.box.yaw + std::atan2(T.linear()(1, 0), T.linear()(0, 0)));
    return there;
}

bool areNear(const LowThing& a, const LowThing& b) {
    constexpr double kApart = 0.4;  // [m]
    if (a.kind != b.kind) return false;
    const double reach = 0.5 * (a.box.size.head<2>().norm() + b.box.size.head<2>().norm()) + kApart;
    if ((a.box.center - b.box.center).head<2>().norm() > reach) return false;
    return boost::geometry::distance(toPolygon(cornersOf(a.box)), toPolygon(cornersOf(b.box))) <= kApart;
}

/// Returns on the ground by azimuth around the sensor: how low the beams passed before them.
class LowBeams {
  public:
    LowBeams(const PointCloud& cloud, const GroundModel& ground) : origin_(cloud.sensor_origin.head<2>()) {
        height_ = cloud.sensor_origin.z() - static_cast<float>(ground.heightAt(static_cast<double>(origin_.x()),
                                                                               static_cast<double>(origin_.y())));
        for (std::size_t i = 0; i < cloud.size(); ++i) {
            const Eigen::Vector2f way = cloud.xyz[i].head<2>() - origin_;
            const float range = way.norm();
            if (ground.is_ground[i] != 0 && range < kFarthestBeam)
                ends_[binOf(way)].push_back({range, ground.height[i]});
        }
    }

    /// Was a thing so high not where a span is? Beams passed there lower than half of it, or met the ground in a drop.
    bool contradicts(const LowSpan& span, const LowThing& thing, double step) const {
        constexpr float kBehind = 0.1f;  // [m]
        const Eigen::Vector2f way = span.from - origin_;
        const float from = way.norm(), to = (span.to - origin_).norm();
        const auto& ends = ends_[binOf(way)];
        return std::any_of(ends.begin(), ends.end(), [&](const End& end) {
            if (thing.kind == LowKind::Drop)
                return std::abs(end.height) < static_cast<float>(step) && end.range > from + 0.1f &&
                       end.range < to - 0.1f;
            if (end.range < from + kBehind) return false;
            const float passed = height_ + (end.height - height_) * from / end.range;
            return passed < 0.5f * static_cast<float>(thing.height);
        });
    }

  private:
    struct End {
        float range, height;
    };
    static constexpr int kBins = 720;

    static std::size_t binOf(const Eigen::Vector2f& way) {
        const double turn =
            (std::atan2(static_cast<double>(way.y()), static_cast<double>(way.x())) + M_PI) / (2.0 * M_PI);
        return static_cast<std::size_t>(std::clamp(static_cast<int>(turn * kBins), 0, kBins - 1));
    }

    Eigen::Vector2f origin_;
    float height_ = 0.0f;  ///< of the sensor above the ground [m]
    std::array<std::vector<End>, kBins> ends_;
};

bool isContradicted(const LowThing& thing, const LowBeams& beams) {
    constexpr double kShare = 0.3;
    constexpr double kStep = 0.1;  // what is so level with the ground is ground [m]
    const auto gone = std::count_if(thing.spans.begin(), thing.spans.end(),
                                    [&](const LowSpan& s) { return beams.contradicts(s, thing, kStep); });
    return static_cast<double>(gone) > kShare * static_cast<double>(thing.spans.size());
}

}  // namespace

void LowMemory::update(const PointCloud& cloud, const Eigen::Isometry2d& T_world_vehicle, DetectionResult& result) {
    const Eigen::Isometry2d T_vehicle_world = T_world_vehicle.inverse();
    std::vector<Kept> now;
    now.reserve(result.low.size());
    for (const LowThing& thing : result.low)
        if (thing.kind != LowKind::NoGround) now.push_back({movedThing(thing, T_world_vehicle), cloud.timestamp, 1});
    const std::size_t seen = now.size();
    std::optional<LowBeams> beams;
    for (Kept& kept : things_) {
        bool again = false;
        for (std::size_t k = 0; k < seen; ++k) {
            if (!areNear(kept.thing, now[k].thing)) continue;
            now[k].scans = std::max(now[k].scans, kept.scans + 1);
            again = true;
        }
        const double age = cloud.timestamp - kept.time;
        if (again || age > kept_ || age < 0.0) continue;
        LowThing there = movedThing(kept.thing, T_vehicle_world);
        if (!beams) beams.emplace(cloud, result.ground);
        if (isContradicted(there, *beams)) continue;
        there.age = age;
        there.points.clear();
        if (kept.scans > 1) result.low.push_back(std::move(there));
        now.push_back(std::move(kept));
    }
    things_ = std::move(now);
}

}  // namespace lidar_obstacles
