// SPDX-License-Identifier: BSD-3-Clause
// Which returns are one piece: closing, components, scan lines.
#include "lidar_obstacles/clustering.h"

#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "lidar_obstacles/occupancy_grid.h"
#include "support/box_geometry.h"

namespace lidar_obstacles {
namespace {

using namespace test;

/// The stages up to clusters, on the ground as the world has it.
struct Chain {
    Scan scan;
    GroundModel ground;
    DetectorParams params;
    std::vector<std::int32_t> candidates;
    OccupancyGrid grid;

    explicit Chain(const World& world, const Sensor& sensor = {}) : Chain(castRays(world, sensor)) {}
    explicit Chain(Scan seen) : scan(std::move(seen)) {
        ground = knownGround(scan);
        candidates = cropToRegion(scan.cloud, ground, params.region);
        grid = buildOccupancyGrid(scan.cloud, candidates, ground, {params.region, params.grid});
    }
    std::vector<Cluster> components() const { return clusterCells(grid, scan.cloud, candidates, params.clustering); }
    /// How many candidates on the object each cluster holds, largest first.
    std::vector<int> shares(const std::vector<Cluster>& clusters, int object) const {
        std::vector<int> counts;
        for (const Cluster& c : clusters) {
            const auto on = scan.countOn(c.points, object);
            if (on > 0) counts.push_back(static_cast<int>(on));
        }
        std::sort(counts.rbegin(), counts.rend());
        return counts;
    }
    /// Do two objects have a cluster in common?
    bool merged(const std::vector<Cluster>& clusters, int a, int b) const {
        return std::any_of(clusters.begin(), clusters.end(), [&](const Cluster& c) {
            const auto holds = [&](int object) {
                return std::any_of(c.points.begin(), c.points.end(), [&](int i) { return scan.hit[i] == object; });
            };
            return holds(a) && holds(b);
        });
    }
};

World with(const std::vector<OrientedBox>& boxes) {
    World world = flatWorld();
    world.boxes = boxes;
    return world;
}

/// A grid of unknown cells around the sensor with the given ones occupied, a return in the middle of each.
struct CellScene {
    PointCloud cloud;
    OccupancyGrid grid;

    explicit CellScene(const std::vector<cv::Point>& cells) {
        grid.origin = {-10.0, -10.0};
        grid.resolution = 0.2;
        grid.width = 100;
        grid.height = 100;
        for (const cv::Point& c : cells) grid.occupied.push_back(c.y * 100 + c.x);
        std::sort(grid.occupied.begin(), grid.occupied.end());
        for (const std::int32_t cell : grid.occupied) {
            const Eigen::Vector2f p = grid.cellCenter(cell).cast<float>();
            cloud.xyz.emplace_back(p.x(), p.y(), 1.0f);
            grid.place_of_candidate.push_back(static_cast<std::int32_t>(grid.place_of_candidate.size()));
        }
    }
    std::vector<Cluster> clusters(double closing) const {
        ClusteringParams params;
        params.closing = closing;
        params.closing_per_metre = 0.0;
        return clusterCells(grid, cloud, allReturns(cloud), params);
    }
};

TEST(Clustering, AGridWithoutCellsOrWithoutOccupiedOnesHasNoClusters) {
    EXPECT_TRUE(clusterCells(OccupancyGrid{}, PointCloud{}, {}, ClusteringParams{}).empty());
    EXPECT_TRUE(CellScene({}).clusters(0.6).empty());
}

TEST(Clustering, OneReturnIsOneCluster) {
    const auto clusters = CellScene({{40, 60}}).clusters(0.0);
    ASSERT_EQ(clusters.size(), 1u);
    EXPECT_EQ(clusters[0].points, std::vector<std::int32_t>{0});
}

TEST(Clustering, CellsThatTouchAtACornerAreOne) {
    EXPECT_EQ(CellScene({{40, 60}, {41, 61}}).clusters(0.0).size(), 1u);
    EXPECT_EQ(CellScene({{40, 60}, {42, 60}}).clusters(0.0).size(), 2u);
}

TEST(Clustering, ClosingBridgesGapsUpToItsSizeInBothDirectionsAndNoneBeyond) {
    for (int cells = 1; cells <= 6; ++cells) {       // odd and even kernels
        const double closing = (cells + 1.5) * 0.2;  // from centre to centre
        for (const cv::Point& direction : {cv::Point(1, 0), cv::Point(0, 1)}) {
            const cv::Point first(50, 50);
            EXPECT_EQ(CellScene({first, first + (cells + 1) * direction}).clusters(closing).size(), 1u) << cells;
            EXPECT_EQ(CellScene({first, first + (cells + 2) * direction}).clusters(closing).size(), 2u) << cells;
        }
    }
}

TEST(Clustering, ClosingLosesNoOccupiedCellAndDoesNotShiftAny) {
    std::vector<cv::Point> cells;
    cv::RNG random(3);
    for (int k = 0; k < 60; ++k) cells.emplace_back(random.uniform(0, 100), random.uniform(0, 100));
    for (double closing = 0.2; closing < 1.5; closing += 0.2) {
        std::size_t found = 0;
        for (const Cluster& c : CellScene(cells).clusters(closing)) found += c.points.size();
        EXPECT_EQ(found, cells.size()) << closing;
    }
}

/// The pieces of cells when each cell is compared with each other: it is joined with those of lower rows, and the one
/// before it in its own, that are within its reach. The smallest label of each cell's piece.
std::vector<int> piecesOneByOne(const CellScene& scene, const ClusteringParams& params) {
    const OccupancyGrid& grid = scene.grid;
    std::vector<int> label(grid.occupied.size());
    std::iota(label.begin(), label.end(), 0);
    for (std::size_t own = 0; own < label.size(); ++own) {
        const int col = grid.occupied[own] % grid.width;
        const int row = grid.occupied[own] / grid.width;
        const int reach = closingReach(grid.cellCenter(grid.occupied[own]).norm(), grid.resolution, params);
        for (std::size_t other = 0; other < own; ++other) {
            const int lower = row - grid.occupied[other] / grid.width;
            const bool near = (lower > 0 || other + 1 == own) && lower <= reach &&
                              std::abs(col - grid.occupied[other] % grid.width) <= reach;
            if (!near || label[own] == label[other]) continue;
            const auto [to, from] = std::minmax(label[own], label[other]);
            std::replace(label.begin(), label.end(), int{from}, int{to});
        }
    }
    return label;
}

TEST(Clustering, CellsAreJoinedAsIfEachWereComparedWithEachOther) {
    cv::RNG random(11);
    for (int scene_number = 0; scene_number < 200; ++scene_number) {
        std::vector<cv::Point> cells;
        for (int wall = 0; wall < 12; ++wall) {  // in any direction, with gaps
            cv::Point2d at(random.uniform(0, 100), random.uniform(0, 100));
            const cv::Point2d step(random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0));
            for (int k = random.uniform(1, 20); k > 0; --k, at += step)
                if (at.x >= 0 && at.x < 99 && at.y >= 0 && at.y < 99) cells.emplace_back(at);
        }
        std::sort(cells.begin(), cells.end(), [](auto& a, auto& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
        cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
        const CellScene scene(cells);
        ClusteringParams params;
        const bool steep = scene_number % 2 == 1;  // reaches differ by almost as much as cells are apart
        params.closing = steep ? -0.3 * (scene_number % 24) : 0.1 * (scene_number % 10);
        params.closing_per_metre = steep ? 0.9 : 0.05 * (scene_number % 4);
        const std::vector<int> expected = piecesOneByOne(scene, params);
        std::vector<int> found(expected.size(), -1);
        for (const Cluster& c : clusterCells(scene.grid, scene.cloud, allReturns(scene.cloud), params))
            for (const std::int32_t i : c.points) found[i] = c.points.front();
        EXPECT_EQ(found, expected) << "scene " << scene_number;
    }
}

TEST(Clustering, AlongARowTheReachIsThatOfEachPlace) {
    // a wall along y = 3 from 0 to 40 m, and a cell 0.8 m beside it near the sensor and far away
    OccupancyGrid grid;
    grid.origin = {0.0, 0.0};
    grid.resolution = 0.2;
    grid.width = 201;
    grid.height = 20;
    for (const int row : {11, 15, 19}) {
        if (row == 15)
            for (int col = 0; col <= 200; ++col) grid.occupied.push_back(row * grid.width + col);
        else
            for (const int col : {5, 195}) grid.occupied.push_back(row * grid.width + col);
    }
    PointCloud cloud;
    for (const std::int32_t cell : grid.occupied) {
        grid.place_of_candidate.push_back(static_cast<std::int32_t>(grid.place_of_candidate.size()));
        const Eigen::Vector2f p = grid.cellCenter(cell).cast<float>();
        cloud.xyz.emplace_back(p.x(), p.y(), 1.0f);
    }
    ClusteringParams params;
    params.closing = 0.2;
    params.closing_per_metre = 0.02;  // one cell at 3 m, five at 40 m
    const auto clusters = clusterCells(grid, cloud, allReturns(cloud), params);
    ASSERT_EQ(clusters.size(), 3u) << "the two near cells stand by themselves";
    std::vector<std::size_t> sizes;
    for (const Cluster& c : clusters) sizes.push_back(c.points.size());
    std::sort(sizes.begin(), sizes.end());
    EXPECT_EQ(sizes, (std::vector<std::size_t>{1, 1, 203}));
}

TEST(Clustering, TheClosingGrowsWithRange) {
    ClusteringParams params;
    params.closing = 0.2;
    params.closing_per_metre = 0.02;  // beyond 20 m three cells of 0.2 m are neighbours, at 0 .. 10 m one
    for (const auto& [col, clusters] : {std::pair{100, 2u}, std::pair{200, 1u}}) {
        OccupancyGrid grid;
        grid.origin = {-20.0, -20.0};
        grid.resolution = 0.2;
        grid.width = 210;
        grid.height = 210;
        PointCloud cloud;
        for (const int c : {col, col + 3}) {
            grid.place_of_candidate.push_back(static_cast<std::int32_t>(grid.occupied.size()));
            grid.occupied.push_back(102 * 210 + c);
            const Eigen::Vector2f p = grid.cellCenter(c, 102).cast<float>();
            cloud.xyz.emplace_back(p.x(), p.y(), 1.0f);
        }
        EXPECT_EQ(clusterCells(grid, cloud, allReturns(cloud), params).size(), clusters);
    }
}

TEST(Clustering, CarsParkedHalfAMetreApartAreTwo) {
    for (const double x : {3.0, 6.0, 9.0}) {
        // one behind the other along the kerb: bumpers at x + 2.25 and x + 2.75
        const Chain chain(with({carAt(x, 4.0, 0.0), carAt(x + 5.0, 4.0, 0.0)}));
        EXPECT_FALSE(chain.merged(chain.components(), 0, 1)) << x;
    }
    // side by side across a car park: sides at 1.75 m and 2.25 m
    const Chain chain(with({carAt(9.0, 0.85, 0.0), carAt(9.0, -1.45, 0.0)}));
    EXPECT_FALSE(chain.merged(chain.components(), 0, 1));
}

TEST(Clustering, ACarAtAGrazingAngleIsMostlyOnePiece) {
    for (const double x : {12.0, 20.0, 30.0}) {
        Sensor sensor;
        sensor.noise = 0.02;
        const Chain chain(with({carAt(x, 2.5, 0.0)}), sensor);
        const std::vector<int> shares = chain.shares(chain.components(), 0);
        ASSERT_FALSE(shares.empty());
        const auto candidates = static_cast<double>(chain.scan.returnsOn(0).size());
        // the roof's edge and the far end may stand alone: two or three returns of each of five planes
        EXPECT_GE(shares[0], 0.85 * candidates) << "at " << x << " m in " << shares.size() << " pieces";
    }
}

TEST(Clustering, ACarAcrossTheSeamOfTheScanIsOne) {
    const Chain chain(with({carAt(-10.0, 0.0, 0.0)}));  // columns run from straight behind to straight behind
    const std::vector<int> shares = chain.shares(chain.components(), 0);
    ASSERT_EQ(shares.size(), 1u);
    EXPECT_EQ(static_cast<std::size_t>(shares[0]), chain.scan.returnsOn(0).size());
}

TEST(Clustering, AGapThatNobodyLookedIntoPartsNothing) {
    Sensor sensor;
    sensor.columns = 720;
    const Scan scan = castRays(with({carAt(12.0, 0.0, 0.0)}), sensor);  // its rear is 9.75 m away, a column 8.5 cm wide
    const auto piecesWithout = [&](int object) {                        // 5 columns of it, or of all
        const Chain chain(without(scan, [&](std::int32_t i) {
            const Eigen::Vector3f& p = scan.cloud.xyz[i];
            const double azimuth = degrees(std::atan2(p.y(), p.x()));
            return azimuth < -0.1 && azimuth > -2.6 && (object < 0 || scan.hit[i] == object);
        }));
        return chain.shares(chain.components(), 0).size();
    };
    EXPECT_EQ(piecesWithout(-1), 1u) << "a packet is missing, or the turn has its seam there";
    EXPECT_EQ(piecesWithout(0), 2u) << "beams passed between";
}

TEST(Clustering, ATurnThatIsCutBetweenPacketsPartsNoCar) {
    const Scan scan = castRays(with({carAt(12.0, 0.0, 0.0)}), Sensor{});
    const auto pieces = [&](double missing) {  // [deg]
        const Chain chain(without(scan, [&](std::int32_t i) {
            const Eigen::Vector3f& p = scan.cloud.xyz[i];
            const double azimuth = degrees(std::atan2(p.y(), p.x()));
            return std::abs(azimuth) < 0.5 * missing;
        }));
        return chain.shares(chain.components(), 0).size();
    };
    EXPECT_EQ(pieces(2.5), 1u);
    EXPECT_EQ(pieces(4.6), 1u) << "a whole packet";
    EXPECT_EQ(pieces(5.6), 2u) << "more may hold anything";
}

TEST(Clustering, AcrossAHoleWhatIsFartherAwayIsAnotherThing) {
    // a car, and 1.2 m behind its rear's right half a wall
    const Scan scan = castRays(with({carAt(12.0, 1.0, 0.0), boxAt(11.0, -2.0, 0.0, {0.2, 4.0, 1.5})}), Sensor{});
    const Chain chain(without(scan, [&](std::int32_t i) {
        const Eigen::Vector3f& p = scan.cloud.xyz[i];
        const double azimuth = degrees(std::atan2(p.y(), p.x()));
        return azimuth < 1.5 && azimuth > -1.5;
    }));
    EXPECT_FALSE(chain.merged(chain.components(), 0, 1));
}

TEST(Clustering, APersonAMetreBesideACarIsAnother) {
    const Chain chain(with({carAt(10.0, 0.0, 0.0), personAt(9.0, 2.15)}));
    EXPECT_FALSE(chain.merged(chain.components(), 0, 1));
}

TEST(Clustering, NoCandidateVanishesAndNoneIsCountedTwice) {
    Sensor sensor;
    sensor.noise = 0.02;
    const Chain chain(street(), sensor);
    std::map<std::int32_t, int> seen;
    for (const Cluster& c : chain.components())
        for (const std::int32_t i : c.points) ++seen[i];
    for (const auto& [point, times] : seen) ASSERT_EQ(times, 1) << "return " << point;
    for (std::size_t k = 0; k < chain.candidates.size(); ++k) {
        if (chain.grid.place_of_candidate[k] < 0) continue;
        ASSERT_EQ(seen.count(chain.candidates[k]), 1u) << "an occupied return in no cluster";
    }
}

TEST(Clustering, TheSameCloudGivesTheSameClusters) {
    const Chain chain(street());
    const auto a = chain.components();
    const auto b = chain.components();
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_EQ(a[k].points, b[k].points);
}

}  // namespace
}  // namespace lidar_obstacles
