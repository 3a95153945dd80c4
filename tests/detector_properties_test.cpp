// SPDX-License-Identifier: BSD-3-Clause
// What holds for the boxes of any scan, on scenes drawn at random: they are finite, in order and in places of their
// own. Which way the sensor looks, what is far away and in which order returns come changes little.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <string>

#include "lidar_obstacles/pipelines.h"
#include "objects/overlap.h"
#include "support/pipeline_scene.h"
#include "support/size_model.h"

namespace lidar_obstacles {
namespace {

using namespace test;

constexpr unsigned kScenes = 12;

/// Cars, people, crates and walls wherever chance puts them, within 18 m; they may stand in each other.
World anyWorld(std::mt19937& random) {
    const auto any = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
    World world = flatWorld();
    for (int k = 0; k < 25; ++k) {
        const double distance = any(4.0, 18.0), bearing = any(-M_PI, M_PI), yaw = any(-180.0, 180.0);
        const Eigen::Vector3d any_size(any(0.2, 6.0), any(0.2, 3.0), any(0.4, 3.0));
        const Eigen::Vector3d sizes[] = {{4.5, 1.8, 1.5}, {0.5, 0.5, 1.75}, any_size, {15.0, 0.3, 2.5}};
        world.boxes.push_back(boxAt(distance * std::cos(bearing), distance * std::sin(bearing), yaw, sizes[k % 4]));
    }
    return world;
}

Sensor noisy(int planes) {
    Sensor sensor = fewPlanes(planes);
    sensor.noise = 0.02;
    return sensor;
}

/// A turn of a sensor of so many planes, of which some returns are missing.
Scan anyScan(unsigned seed, int planes) {
    std::mt19937 random(seed);
    const Scan scan = castRays(anyWorld(random), noisy(planes));
    return without(scan, [&](std::int32_t) { return random() % 20 == 0; });
}

/// The same returns in another order.
PointCloud inOrder(const PointCloud& cloud, const std::vector<std::int32_t>& order) {
    PointCloud other = cloud;
    std::vector<std::int32_t> place(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        const auto from = static_cast<std::size_t>(order[k]);
        place[from] = static_cast<std::int32_t>(k);
        other.xyz[k] = cloud.xyz[from];
        other.ring[k] = cloud.ring[from];
        other.view.column_of[k] = cloud.view.column_of[from];
    }
    for (std::int32_t& i : other.view.index) i = i < 0 ? -1 : place[static_cast<std::size_t>(i)];
    return other;
}

/// Returns 150 m away from beams of the upper half that nothing came back to, where no object stands near their
/// columns.
PointCloud withFarReturns(const Scan& scan, const Sensor& sensor) {
    constexpr int kBeside = 10;  // columns
    PointCloud cloud = scan.cloud;
    const int columns = cloud.view.columns;
    std::vector<bool> clear(static_cast<std::size_t>(columns), true);
    for (std::size_t i = 0; i < scan.hit.size(); ++i)
        for (int k = -kBeside; scan.hit[i] != kOnGround && k <= kBeside; ++k)
            clear[static_cast<std::size_t>((cloud.view.column_of[i] + k + columns) % columns)] = false;
    for (int ring = 0; ring < cloud.view.rings; ++ring)
        for (int column = 0; column < columns; ++column) {
            const double up = radians(sensor.lowest_deg + ring * sensor.step_deg);
            const double azimuth = M_PI - 2.0 * M_PI * (column + 0.5) / columns;
            if (up < 0.0 || !clear[static_cast<std::size_t>(column)] || cloud.view.at(ring, column) >= 0) continue;
            const Eigen::Vector3d way(std::cos(up) * std::cos(azimuth), std::cos(up) * std::sin(azimuth), std::sin(up));
            cloud.view.at(ring, column) = static_cast<std::int32_t>(cloud.size());
            cloud.view.column_of.push_back(column);
            cloud.ring.push_back(static_cast<std::uint16_t>(ring));
            cloud.xyz.push_back((sensor.position + 150.0 * way).cast<float>());
        }
    return cloud;
}

/// The scan turned to the left, and its view with it: as if the sensor had looked elsewhere first.
PointCloud turned(const Scan& scan, double angle, int columns) {
    Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    rotation = rotation.unaryExpr([](double r) { return std::abs(r) < 1e-15 ? 0.0 : r; });
    PointCloud cloud = moved(scan, rotation, Eigen::Vector3d::Zero()).cloud;
    const OrganizedView before = cloud.view;
    const auto place = [&](int column) { return (column + before.columns - columns) % before.columns; };
    for (std::int32_t& column : cloud.view.column_of) column = place(column);
    for (int ring = 0; ring < before.rings; ++ring)
        for (int column = 0; column < before.columns; ++column)
            cloud.view.at(ring, place(column)) = before.at(ring, column);
    return cloud;
}

bool isRoadUser(const Obstacle& o) { return o.cls != ObstacleClass::Structure && o.cls != ObstacleClass::Unknown; }

/// What is not known, and structure, is boxed in pieces, which may lie side by side in one place.
void expectApart(const std::vector<Obstacle>& obstacles) {
    const auto area = [](const Obstacle& o) { return o.box.size.x() * o.box.size.y(); };
    for (std::size_t a = 0; a < obstacles.size(); ++a)
        for (std::size_t b = a + 1; b < obstacles.size(); ++b) {
            const Obstacle &o = obstacles[a], &p = obstacles[b];
            if (!isRoadUser(o) || o.cls != p.cls) continue;
            EXPECT_LE(sharedArea(o.box, p.box), 0.1 * std::min(area(o), area(p)) + 1e-3) << a << ", " << b;
        }
}

void expectSound(const std::vector<Obstacle>& obstacles) {
    double before = 0.0;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        const Obstacle& o = obstacles[k];
        EXPECT_TRUE(isFinite(o.box) && std::isfinite(o.heading_std));
        EXPECT_GT(o.box.size.minCoeff(), 0.0);
        EXPECT_EQ(o.id, static_cast<int>(k));
        EXPECT_FALSE(o.points.empty());
        EXPECT_EQ(std::set<std::int32_t>(o.points.begin(), o.points.end()).size(), o.points.size());
        EXPECT_GE(o.box.center.head<2>().norm(), before) << "nearest first";
        before = o.box.center.head<2>().norm();
    }
    expectApart(obstacles);
}

/// How many obstacles there are again among others, turned by an angle around the vehicle: of the same returns, of the
/// same class, in the same place.
std::size_t foundAgain(const std::vector<Obstacle>& obstacles, const std::vector<Obstacle>& others, double angle) {
    const Eigen::AngleAxisd turn(angle, Eigen::Vector3d::UnitZ());
    return static_cast<std::size_t>(std::count_if(obstacles.begin(), obstacles.end(), [&](const Obstacle& o) {
        return std::any_of(others.begin(), others.end(), [&](const Obstacle& p) {
            return o.cls == p.cls && o.num_points == p.num_points &&
                   (p.box.center - turn * o.box.center).norm() < 0.01 &&
                   std::abs(p.box.size.prod() - o.box.size.prod()) < 0.01;
        });
    }));
}

/// Obstacles of many scenes, and how many of them were found again.
struct Again {
    std::size_t all = 0, again = 0;

    void add(const std::vector<Obstacle>& obstacles, const std::vector<Obstacle>& others, double angle) {
        all += std::max(obstacles.size(), others.size());
        again += foundAgain(obstacles, others, angle);
    }
};

/// The scenes by 16, 8 and 4 planes, each with the algorithm that is meant for it.
class DetectorProperties : public testing::TestWithParam<int> {
  protected:
    int planes() const { return GetParam(); }
    DetectorParams params() const {
        return withAlgorithm(planes() == 16  ? Algorithm::Planes16
                             : planes() == 8 ? Algorithm::Planes8
                                             : Algorithm::Auto);
    }
    std::vector<Obstacle> obstaclesOf(const PointCloud& cloud) const { return detect(cloud, params()).obstacles; }
    /// By size: bare cuboids are like nothing that the recognizer has learned.
    std::vector<Obstacle> bySizeOf(const PointCloud& cloud) const { return detect(cloud, bySize(params())).obstacles; }
};

TEST_P(DetectorProperties, BoxesAreFiniteInOrderAndInPlacesOfTheirOwn) {
    for (unsigned seed = 0; seed < 3 * kScenes; ++seed) {
        SCOPED_TRACE(seed);
        expectSound(obstaclesOf(anyScan(seed, planes()).cloud));
    }
}

TEST_P(DetectorProperties, AnyPointsWithoutRingsGiveSoundBoxesToo) {
    std::mt19937 random(5);
    for (unsigned run = 0; run < kScenes; ++run) {
        SCOPED_TRACE(run);
        const auto any = [&](float low, float high) {
            return low + (high - low) * static_cast<float>(random() / 4294967296.0);
        };
        std::vector<Eigen::Vector3f> points;
        for (int clump = 0; clump < 30; ++clump) {
            const Eigen::Vector3f at(any(-40, 40), any(-40, 40), any(-2, 3)), size(any(0, 4), any(0, 4), any(0, 2));
            for (int k = 0; k < 80; ++k)
                points.push_back(at + size.cwiseProduct(Eigen::Vector3f(any(-1, 1), any(-1, 1), any(-1, 1))));
        }
        points.emplace_back(9e4F, -9e4F, 1e4F);
        points.insert(points.end(), 20, Eigen::Vector3f(7.0F, 1.0F, 1.0F));  // all in one place
        expectSound(obstaclesOf(cloudOf(points)));
    }
}

/// Ties between equal sides, and planes of the ground that are voted for, may fall otherwise.
TEST_P(DetectorProperties, AQuarterTurnTurnsTheBoxesAndChangesLittleElse) {
    Again boxes;
    for (unsigned seed = 0; seed < kScenes; ++seed) {
        const Scan scan = anyScan(seed, planes());
        const auto obstacles = obstaclesOf(scan.cloud);
        for (const int quarters : {1, 2, 3}) {
            const double angle = quarters * M_PI_2;
            const int columns = quarters * scan.cloud.view.columns / 4;
            boxes.add(obstacles, obstaclesOf(turned(scan, angle, columns)), angle);
        }
    }
    EXPECT_GT(boxes.all, 500U);
    EXPECT_GE(static_cast<double>(boxes.again), 0.75 * static_cast<double>(boxes.all));
}

/// Of larger clouds smaller shares are looked at where spacing and noise are measured.
TEST_P(DetectorProperties, FarReturnsWhereNothingStandsChangeLittle) {
    if (planes() == 4) GTEST_SKIP() << "no beam looks up";
    Again boxes;
    std::size_t far = 0;
    for (unsigned seed = 0; seed < kScenes; ++seed) {
        const Scan scan = anyScan(seed, planes());
        const PointCloud more = withFarReturns(scan, noisy(planes()));
        far += more.size() - scan.cloud.size();
        boxes.add(obstaclesOf(scan.cloud), obstaclesOf(more), 0.0);
    }
    EXPECT_GT(far, 1000U);
    EXPECT_GE(static_cast<double>(boxes.again), 0.75 * static_cast<double>(boxes.all));
}

/// Each object that the first found well, the second found in the same place, as the same. Not to the last bit: cells
/// begin elsewhere, and of many returns only some are looked at.
void expectSameObjects(const Scan& scan, const std::vector<Obstacle>& obstacles, const std::vector<Obstacle>& others,
                       const std::vector<std::int32_t>& order, double angle) {
    Scan reordered = scan;
    for (std::size_t k = 0; k < order.size(); ++k) reordered.hit[k] = scan.hit[static_cast<std::size_t>(order[k])];
    for (int object = 0; object < 8; ++object) {  // cars and people of the street
        if (scan.returnsOn(object).size() < 30) continue;
        const Obstacle *o = obstacleOn(scan, obstacles, object), *p = obstacleOn(reordered, others, object);
        ASSERT_TRUE(o && p) << object;
        EXPECT_EQ(o->cls, p->cls) << object;
        const Eigen::Vector3d center = Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * o->box.center;
        EXPECT_LT((p->box.center - center).head<2>().norm(), 0.15) << object;
    }
}

TEST_P(DetectorProperties, ByStepsOfTheSensorTurnedTheSameObjectsAreFound) {
    const Scan scan = castRays(street(), noisy(planes()));
    const auto obstacles = bySizeOf(scan.cloud);
    std::vector<std::int32_t> order(scan.cloud.size());
    std::iota(order.begin(), order.end(), 0);
    for (const int columns : {1, 2, 7, 50, 213}) {
        SCOPED_TRACE(columns);
        const double angle = 2.0 * M_PI * columns / scan.cloud.view.columns;
        expectSameObjects(scan, obstacles, bySizeOf(turned(scan, angle, columns)), order, angle);
    }
}

TEST_P(DetectorProperties, InAnotherOrderOfTheReturnsTheSameObjectsAreFound) {
    const Scan scan = castRays(street(), noisy(planes()));
    const auto obstacles = bySizeOf(scan.cloud);
    std::vector<std::int32_t> order(scan.cloud.size());
    std::iota(order.begin(), order.end(), 0);
    const auto by_ring = [&](std::int32_t a, std::int32_t b) { return scan.cloud.ring[a] < scan.cloud.ring[b]; };
    std::stable_sort(order.begin(), order.end(), by_ring);  // as others write them
    expectSameObjects(scan, obstacles, bySizeOf(inOrder(scan.cloud, order)), order, 0.0);
    std::mt19937 random(1);
    for (int run = 0; run < 5; ++run) {
        SCOPED_TRACE(run);
        for (std::size_t k = order.size() - 1; k > 0; --k) std::swap(order[k], order[random() % (k + 1)]);
        expectSameObjects(scan, obstacles, bySizeOf(inOrder(scan.cloud, order)), order, 0.0);
    }
}

INSTANTIATE_TEST_SUITE_P(Planes, DetectorProperties, testing::Values(16, 8, 4));

}  // namespace
}  // namespace lidar_obstacles
