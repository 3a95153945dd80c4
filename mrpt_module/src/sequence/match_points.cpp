// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/match_points.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles {
namespace {

constexpr float kSide = 0.35f;            // a surface that goes on so far to both sides is no post [m]
constexpr float kFarthest = 100.0f;       // [m]
constexpr std::size_t kUnordered = 2500;  // points of a scan without rings

/// Direction of the surface that goes on to both sides of a return, seen from above; zero where none does.
Eigen::Vector2f tangentAt(const PointCloud& cloud, int ring, int column) {
    constexpr float kOff = 0.1f;      // of a straight surface [m]
    constexpr float kLongest = 1.5f;  // to the return at either side [m]
    const OrganizedView& view = cloud.view;
    const Eigen::Vector2f p = cloud.xyz[view.at(ring, column)].head<2>();
    const float step = static_cast<float>(2.0 * M_PI) / static_cast<float>(view.columns);
    const float range = (p - cloud.originOfRing(ring).head<2>()).norm();
    const int columns = static_cast<int>(kSide / std::max(range * step, 1e-3f)) + 1;
    if (columns > view.columns / 16) return Eigen::Vector2f::Zero();
    const std::int32_t a = view.at(ring, view.wrap(column - columns));
    const std::int32_t b = view.at(ring, view.wrap(column + columns));
    if (a < 0 || b < 0) return Eigen::Vector2f::Zero();
    const Eigen::Vector2f before = p - cloud.xyz[a].head<2>(), after = cloud.xyz[b].head<2>() - p;
    const Eigen::Vector2f tangent = (before + after).normalized();
    const float off = std::abs(tangent.x() * before.y() - tangent.y() * before.x());
    const bool goes_on = off < kOff && before.dot(tangent) > 0.0f && after.dot(tangent) > 0.0f &&
                         before.squaredNorm() < kLongest * kLongest && after.squaredNorm() < kLongest * kLongest;
    return goes_on ? tangent : Eigen::Vector2f::Zero();
}

float middleOf(const PointCloud& cloud) {
    if (cloud.time_offset.empty()) return 0.0f;
    const auto [low, high] = std::minmax_element(cloud.time_offset.begin(), cloud.time_offset.end());
    return 0.5f * (*low + *high);
}

/// Takes over a return of a cloud, if it is none of the own body.
class Picker {
  public:
    Picker(const PointCloud& cloud, const OwnBody& own_body, MatchPoints& out)
        : cloud_(cloud), own_body_(own_body), out_(out), middle_(middleOf(cloud)) {
        out.time = cloud.timestamp + static_cast<double>(middle_);
    }

    bool wants(std::int32_t i) const {
        const Eigen::Vector3f& p = cloud_.xyz[i];
        return (p - cloud_.originOf(i)).squaredNorm() < kFarthest * kFarthest && !own_body_.holds(p);
    }
    void take(std::int32_t i, const Eigen::Vector2f& tangent) {
        const float offset = cloud_.time_offset.empty() ? 0.0f : cloud_.time_offset[i] - middle_;
        out_.points.push_back({cloud_.xyz[i], offset, i, tangent});
    }

  private:
    const PointCloud& cloud_;
    const OwnBody& own_body_;
    MatchPoints& out_;
    float middle_;
};

}  // namespace

Eigen::Isometry3d moved(const Twist& twist, double seconds) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    const double angle = twist.turn.norm() * seconds;
    if (angle != 0.0) pose.linear() = Eigen::AngleAxisd(angle, twist.turn.normalized()).toRotationMatrix();
    // half of the turn is done where the middle of the way is
    const Eigen::Isometry3d half(Eigen::AngleAxisd(
        0.5 * angle, angle != 0.0 ? Eigen::Vector3d(twist.turn.normalized()) : Eigen::Vector3d::UnitZ()));
    pose.translation() = half.linear() * twist.speed * seconds;
    return pose;
}

Twist twistBetween(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b, double seconds) {
    const Eigen::Isometry3d step = a.inverse() * b;
    const Eigen::AngleAxisd turn(step.linear());
    const Eigen::AngleAxisd half(0.5 * turn.angle(), turn.axis());
    return {half.inverse() * step.translation() / seconds, turn.angle() * turn.axis() / seconds};
}

MatchPoints matchPoints(const PointCloud& cloud, const OwnBody& own_body, float apart) {
    MatchPoints scan;
    Picker picker(cloud, own_body, scan);
    const OrganizedView& view = cloud.view;
    if (view.empty()) {
        const std::size_t every = cloud.size() / kUnordered + 1;
        for (std::size_t i = 0; i < cloud.size(); i += every)
            if (picker.wants(static_cast<std::int32_t>(i)))
                picker.take(static_cast<std::int32_t>(i), Eigen::Vector2f::Zero());
        return scan;
    }
    for (int ring = 0; ring < view.rings; ++ring) {
        Eigen::Vector3f last = Eigen::Vector3f::Constant(1e6f);
        for (int column = 0; column < view.columns; ++column) {
            const std::int32_t i = view.at(ring, column);
            if (i < 0 || (cloud.xyz[i] - last).squaredNorm() < apart * apart || !picker.wants(i)) continue;
            last = cloud.xyz[i];
            picker.take(i, tangentAt(cloud, ring, column));
        }
    }
    return scan;
}

void straighten(const MatchPoints& scan, const Twist& twist, std::vector<Eigen::Vector3f>& straight) {
    const Eigen::Vector3f speed = twist.speed.cast<float>(), turn = twist.turn.cast<float>();
    straight.clear();
    for (const MatchPoint& m : scan.points) {
        // a twentieth of a second: the second power of the angle is enough
        const Eigen::Vector3f angle = turn * m.offset;
        const Eigen::Vector3f across = angle.cross(m.p);
        straight.emplace_back(m.p + across + 0.5f * angle.cross(across) + speed * m.offset);
    }
}

}  // namespace lidar_obstacles
