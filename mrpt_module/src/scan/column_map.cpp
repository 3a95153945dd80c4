// SPDX-License-Identifier: BSD-3-Clause
#include "scan/column_map.h"

#include <cmath>
#include <complex>

namespace lidar_obstacles {
namespace {

constexpr double kCircle = 2.0 * M_PI;

/// Mean direction of the column at azimuth 0 if columns run in this sense; its length (0 .. 1) tells how well the
/// returns agree.
std::complex<double> columnAtZero(const PointCloud& cloud, double sense) {
    constexpr std::size_t kLooked = 64;
    std::complex<double> sum;
    const std::size_t stride = 1 + cloud.size() / kLooked;
    int looked = 0;
    for (std::size_t i = 0; i < cloud.size(); i += stride, ++looked) {
        const Eigen::Vector3d d = (cloud.xyz[i] - cloud.originOf(static_cast<std::int32_t>(i))).cast<double>();
        const double turn = kCircle * cloud.view.column_of[i] / cloud.view.columns;
        sum += std::polar(1.0, turn - sense * std::atan2(d.y(), d.x()));
    }
    return sum / static_cast<double>(looked);
}

}  // namespace

ColumnMap::ColumnMap(const PointCloud& cloud) : columns_(cloud.view.columns) {
    const std::complex<double> clockwise = columnAtZero(cloud, -1.0);
    const std::complex<double> counter = columnAtZero(cloud, 1.0);
    sense_ = std::abs(counter) > std::abs(clockwise) ? 1 : -1;
    zero_ = std::arg(sense_ > 0 ? counter : clockwise) / kCircle * columns_;
}

int ColumnMap::columnOf(double azimuth) const {
    const int column = static_cast<int>(std::lround(zero_ + sense_ * azimuth / kCircle * columns_));
    return (column % columns_ + columns_) % columns_;
}

}  // namespace lidar_obstacles
