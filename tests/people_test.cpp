// Two people side by side, taken apart at the gap between them.
#include <gtest/gtest.h>

#include "lidar_obstacles/clustering.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

struct Group {
    Scan scan;
    Cluster together;

    explicit Group(const std::vector<OrientedBox>& boxes, const Sensor& sensor = {}) {
        World world = flatWorld();
        world.boxes = boxes;
        scan = castRays(world, sensor);
        for (std::size_t i = 0; i < scan.cloud.size(); ++i)
            if (scan.hit[i] != kOnGround) together.points.push_back(static_cast<std::int32_t>(i));
    }
    std::vector<Cluster> split() const { return splitPeople({together}, scan.cloud, knownGround(scan)); }
    void expectWhole() const {
        const auto parts = split();
        ASSERT_EQ(parts.size(), 1u);
        EXPECT_EQ(parts[0].points, together.points);
    }
};

/// Two people, their middles `apart` from each other across the line of sight to (x, 0), or along it.
std::vector<OrientedBox> pair(double x, double apart, bool across = true) {
    const Eigen::Vector2d half = 0.5 * apart * (across ? Eigen::Vector2d::UnitY() : Eigen::Vector2d::UnitX());
    const Eigen::Vector3d size(0.3, 0.45, 1.75);
    return {boxAt(x - half.x(), -half.y(), 0.0, size), boxAt(x + half.x(), half.y(), 0.0, size)};
}

TEST(People, TwoSideBySideAreTakenApart) {
    for (const double x : {4.0, 7.0, 10.0})
        for (const double apart : {0.8, 1.0}) {  // 0.35 m and more between them
            const Group group(pair(x, apart));
            const auto parts = group.split();
            ASSERT_EQ(parts.size(), 2u) << x << ", " << apart;
            for (const Cluster& part : parts) {
                const int one = group.scan.hit[part.points[0]];
                for (const std::int32_t i : part.points) ASSERT_EQ(group.scan.hit[i], one);
            }
            EXPECT_EQ(parts[0].points.size() + parts[1].points.size(), group.together.points.size());
        }
}

TEST(People, OneStaysOne) {
    Group({personAt(6.0, 0.0)}).expectWhole();
    Group({boxAt(6.0, 0.0, 0.0, {0.5, 0.9, 1.75})}).expectWhole();
}

TEST(People, ANarrowGapPartsNobody) { Group(pair(6.0, 0.6)).expectWhole(); }  // 0.15 m between them

TEST(People, CarsAndLowThingsStayWhole) {
    Group({carAt(9.0, 0.0, 0.0)}).expectWhole();
    Group({boxAt(6.0, -0.5, 0.0, {0.3, 0.4, 0.7}), boxAt(6.0, 0.5, 0.0, {0.3, 0.4, 0.7})}).expectWhole();
}

TEST(People, NoComponentsGiveNone) { EXPECT_TRUE(splitPeople({}, PointCloud{}, GroundModel{}).empty()); }

}  // namespace
}  // namespace lidar_obstacles
