#include "lidar_obstacles/types.h"

#include <cmath>
#include <stdexcept>

namespace lidar_obstacles {

bool OccupancyGrid::cellAt(double x, double y, int& col, int& row) const {
    col = static_cast<int>(std::floor((x - origin.x()) / resolution));
    row = static_cast<int>(std::floor((y - origin.y()) / resolution));
    return col >= 0 && col < width() && row >= 0 && row < height();
}

void validate(const PointCloud& cloud) {
    const auto fits = [&](std::size_t n) { return n == 0 || n == cloud.size(); };
    if (!fits(cloud.ring.size()) || !fits(cloud.intensity.size()) || !fits(cloud.time_offset.size()) ||
        (!cloud.view.empty() && (cloud.view.column_of.size() != cloud.size() || cloud.ring.size() != cloud.size())))
        throw std::invalid_argument("PointCloud: ring, intensity, time_offset or view do not fit the returns");
    Eigen::Vector3f zero = Eigen::Vector3f::Zero();
    for (const Eigen::Vector3f& p : cloud.xyz) zero += 0.0f * p;  // NaN and infinity do not become zero
    if (!(zero.squaredNorm() == 0.0f)) throw std::invalid_argument("PointCloud: a return is not finite");
}

const char* toString(ObstacleClass c) {
    switch (c) {
        case ObstacleClass::Vehicle:
            return "vehicle";
        case ObstacleClass::Pedestrian:
            return "pedestrian";
        case ObstacleClass::Cyclist:
            return "cyclist";
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
        case RejectReason::TooTall:
            return "too_tall";
        case RejectReason::Pole:
            return "pole";
        case RejectReason::Floating:
            break;
    }
    return "floating";
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
    constexpr double kPi = 3.14159265358979323846;
    double a = std::fmod(rad + kPi, 2.0 * kPi);
    if (a < 0.0) a += 2.0 * kPi;
    if (a >= 2.0 * kPi) a = 0.0;  // -tiny + 2 pi rounds up
    return a - kPi;
}

}  // namespace lidar_obstacles
