// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/types.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lidar_obstacles {

bool OccupancyGrid::cellAt(double x, double y, int& col, int& row) const {
    col = static_cast<int>(std::floor((x - origin.x()) / resolution));
    row = static_cast<int>(std::floor((y - origin.y()) / resolution));
    return col >= 0 && col < width && row >= 0 && row < height;
}

namespace {

bool viewFits(const PointCloud& cloud) {
    const OrganizedView& view = cloud.view;
    if (view.empty()) return true;
    const auto size = static_cast<std::int32_t>(cloud.size());
    if (view.index.size() != static_cast<std::size_t>(view.rings) * view.columns) return false;
    if (view.column_of.size() != cloud.size() || cloud.ring.size() != cloud.size()) return false;
    // counted, not left at the first: loops without a way out are fast
    const auto outside = [](const std::vector<std::int32_t>& numbers, std::int32_t least, std::int32_t end) {
        const auto from = static_cast<std::uint32_t>(least);
        const std::uint32_t allowed = static_cast<std::uint32_t>(end) - from;
        std::size_t count = 0;
        for (const std::int32_t n : numbers)
            count += static_cast<std::size_t>(static_cast<std::uint32_t>(n) - from >= allowed);
        return count;
    };
    std::size_t wrong = outside(view.index, -1, size) + outside(view.column_of, 0, view.columns);
    for (const std::uint16_t ring : cloud.ring) wrong += static_cast<std::size_t>(ring >= view.rings);
    return wrong == 0;
}

bool sensorsFit(const PointCloud& cloud) {
    if (cloud.sensors.empty()) return true;
    SensorRays before;
    for (const SensorRays& s : cloud.sensors) {
        if (s.end < before.end || s.end_ring < before.end_ring) return false;
        for (std::int32_t i = before.end; i < std::min(s.end, static_cast<std::int32_t>(cloud.ring.size())); ++i)
            if (cloud.ring[i] < before.end_ring || cloud.ring[i] >= s.end_ring) return false;
        before = s;
    }
    return before.end == static_cast<std::int32_t>(cloud.size()) && before.end_ring == cloud.view.rings;
}

}  // namespace

void validate(const PointCloud& cloud) {
    constexpr float kFarthest = 1e5f;  // beyond it cells and bins no longer fit an int [m]
    const auto fits = [&](std::size_t n) { return n == 0 || n == cloud.size(); };
    if (!fits(cloud.ring.size()) || !fits(cloud.intensity.size()) || !fits(cloud.time_offset.size()))
        throw std::invalid_argument("PointCloud: ring, intensity or time_offset do not fit the returns");
    if (!viewFits(cloud)) throw std::invalid_argument("PointCloud: the view does not fit the returns");
    if (!sensorsFit(cloud)) throw std::invalid_argument("PointCloud: the sensors do not fit the returns and rings");
    if (cloud.empty()) return;
    static_assert(sizeof(Eigen::Vector3f) == 3 * sizeof(float));
    const Eigen::Map<const Eigen::ArrayXf> all(cloud.xyz.front().data(), 3 * static_cast<Eigen::Index>(cloud.size()));
    const bool all_near =
        all.matrix().squaredNorm() < kFarthest * kFarthest;  // as a rule: then no coordinate is beyond it
    if (!all_near && !(all.abs().maxCoeff<Eigen::PropagateNaN>() < kFarthest))
        throw std::invalid_argument("PointCloud: a coordinate is not finite or beyond 100 km");
}

std::array<Eigen::Vector2d, 4> cornersFromAbove(const OrientedBox& box) {
    const Eigen::Vector2d along(std::cos(box.yaw), std::sin(box.yaw)), across(-along.y(), along.x());
    const Eigen::Vector2d l = 0.5 * box.size.x() * along, w = 0.5 * box.size.y() * across;
    const Eigen::Vector2d c = box.center.head<2>();
    return {c + l + w, c - l + w, c - l - w, c + l - w};
}

const char* toString(ObstacleClass c) {
    switch (c) {
        case ObstacleClass::Vehicle:
            return "vehicle";
        case ObstacleClass::Pedestrian:
            return "pedestrian";
        case ObstacleClass::Cyclist:
            return "cyclist";
        case ObstacleClass::Structure:
            return "structure";
        case ObstacleClass::Unknown:
            break;
    }
    return "unknown";
}

const char* toString(RejectReason r) {
    switch (r) {
        case RejectReason::TooFewPoints:
            return "too_few_points";
        case RejectReason::TooSmall:
            return "too_small";
        case RejectReason::TooLow:
            return "too_low";
        case RejectReason::TooLarge:
            return "too_large";
        case RejectReason::Floating:
            break;
    }
    return "floating";
}

const char* toString(HeadingRule r) {
    switch (r) {
        case HeadingRule::Plane:
            return "plane";
        case HeadingRule::TwoSides:
            return "two_sides";
        case HeadingRule::Line:
            return "line";
        case HeadingRule::None:
            break;
    }
    return "none";
}

std::string facesText(std::uint8_t faces) {
    std::string text;
    if ((faces & kFront) != 0) text += 'F';
    if ((faces & kBack) != 0) text += 'B';
    if ((faces & kLeft) != 0) text += 'L';
    if ((faces & kRight) != 0) text += 'R';
    return text.empty() ? "-" : text;
}

const char* toString(GroundEvidence e) {
    switch (e) {
        case GroundEvidence::Good:
            return "good";
        case GroundEvidence::Weak:
            return "weak";
        case GroundEvidence::None:
            break;
    }
    return "none";
}

double normalizeAngle(double rad) {
    double a = std::fmod(rad + M_PI, 2.0 * M_PI);
    if (a < 0.0) a += 2.0 * M_PI;
    if (a >= 2.0 * M_PI) a = 0.0;  // -tiny + 2 pi rounds up
    return a - M_PI;
}

}  // namespace lidar_obstacles
