// SPDX-License-Identifier: BSD-3-Clause
// Rings that a source counts from the top, or as its lasers fire, count upwards all the same.
#include "mrpt_bridge/input/ring_order.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "support/velodyne_packets.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::IsEmpty;

struct Rings {
    std::vector<Eigen::Vector3f> points;
    std::vector<std::uint16_t> ring;
};

/// 100 returns of each ring in turn, 20 m away, at these elevations [deg].
Rings ringsAt(const std::vector<double>& elevations) {
    Rings rings;
    for (int k = 0; k < 100; ++k)
        for (std::size_t r = 0; r < elevations.size(); ++r) {
            const double a = 0.06 * k, e = elevations[r] * M_PI / 180.0;
            rings.points.push_back(
                (20.0 * Eigen::Vector3d(std::cos(a) * std::cos(e), std::sin(a) * std::cos(e), std::sin(e)))
                    .cast<float>());
            rings.ring.push_back(static_cast<std::uint16_t>(r));
        }
    return rings;
}

std::vector<int> order(const Rings& rings, int count) { return ringsUpwards(rings.points, rings.ring, count); }

TEST(RingOrder, ThatIsRightStays) {
    EXPECT_THAT(order(ringsAt({-3, -1, 1, 3}), 4), IsEmpty());
    EXPECT_THAT(order(ringsAt({}), 16), IsEmpty());
    EXPECT_THAT(order(ringsAt({5}), 16), IsEmpty());
}

TEST(RingOrder, FromTheTopIsTurnedAround) {
    EXPECT_THAT(order(ringsAt({3, 1, -1, -3}), 4), ElementsAre(3, 2, 1, 0));
    Rings without_sky = ringsAt({-1, -3, -5, -7});
    for (auto& r : without_sky.ring) r = static_cast<std::uint16_t>(r + 2);  // the upper two saw nothing
    EXPECT_THAT(order(without_sky, 6), ElementsAre(5, 4, 3, 2, 1, 0));
}

TEST(RingOrder, OfFiringIsSorted) {
    EXPECT_THAT(order(ringsAt({-7, 1, -5, 3, -3, 5, -1, 7}), 8), ElementsAre(0, 4, 1, 5, 2, 6, 3, 7));
}

TEST(RingOrder, IsNotGuessedWhereRingsHoldManyElevations) {
    Rings rings = ringsAt({-7, 1, -5, 3, -3, 5, -1, 7});
    for (std::size_t i = 0; i < rings.points.size(); ++i)  // seen from another place
        rings.points[i].z() += static_cast<float>(i % 11) - 5.0F;
    EXPECT_THAT(order(rings, 8), IsEmpty());
}

TEST(RingOrder, OfCloudsThatMrptMadeIsThatOfTheSensor) {
    VelodyneScan scan = makeScan({}, [](double, double) { return 20.0; });
    scan.generatePointCloud();
    scan.scan_packets.clear();
    ASSERT_EQ(scan.point_cloud.laser_id.at(1), 1) << "the second to fire";
    const PointCloud cloud = toPointCloud(scan, SensorParams{});
    ASSERT_EQ(cloud.view.rings, 16);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        EXPECT_NEAR(std::asin(cloud.xyz[i].z() / cloud.xyz[i].norm()) * 180.0 / M_PI, -15.0 + 2.0 * cloud.ring[i],
                    0.01);
}

}  // namespace
}  // namespace lidar_obstacles
