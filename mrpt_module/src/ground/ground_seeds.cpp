// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include <Eigen/Dense>

#include "lidar_obstacles/ground.h"

namespace lidar_obstacles {
namespace {

constexpr auto kPi = static_cast<float>(M_PI);
constexpr int kRangeBins = 24;         // rows of a cloud without rings
constexpr double kSteepGround = 0.47;  // rise over run (25 deg): steeper is no ground
constexpr double kWall = 3.0;          // rise over run: both ends lie on a wall

/// Numbers that are ordered as heights are: a float's bits are, but those of negative ones the other way round.
std::int32_t ordered(float height) {
    std::int32_t bits = 0;
    std::memcpy(&bits, &height, sizeof bits);
    return bits < 0 ? bits ^ std::numeric_limits<std::int32_t>::max() : bits;
}

/// The three lowest returns of one ring in one azimuth bin. Added without branches: whether a return is among the
/// lowest is nothing a processor can foresee.
struct LowestThree {
    static constexpr std::int64_t kNone = std::numeric_limits<std::int64_t>::max();

    std::array<std::int64_t, 3> lowest{kNone, kNone, kNone};  ///< height, then number
    int count = 0;

    void add(float height, std::int32_t i) {
        ++count;
        const std::int64_t own = std::int64_t{ordered(height)} * (std::int64_t{1} << 32) + i;
        const std::int64_t second = std::max(own, lowest[0]);
        const std::int64_t third = std::max(second, lowest[1]);
        lowest = {std::min(own, lowest[0]), std::min(second, lowest[1]), std::min(third, lowest[2])};
    }
    /// A low quantile: a single return below the ground (a reflection) does not become the seed.
    std::int32_t lowQuantile() const {
        return static_cast<std::int32_t>(lowest[count >= 6 ? 2 : count >= 3 ? 1 : 0] & 0xffffffffu);
    }
};

int rangeRow(float range) {  // 1 m .. 60 m in equal steps of the logarithm
    return std::clamp(static_cast<int>(std::log(std::max(range, 1.0f)) * (kRangeBins / 4.1f)), 0, kRangeBins - 1);
}

/// Did the same sensor see both in one azimuth bin?
bool isBeside(const GroundSeed& a, const GroundSeed& b) { return a.bin == b.bin && a.sensor == b.sensor; }

/// Drops seeds that a higher row of the same bin shows to stand on something steep.
std::vector<GroundSeed> dropSteep(const std::vector<GroundSeed>& seeds) {
    constexpr double kMinDistance = 0.15;  // nearer ones differ by noise
    constexpr double kInFront = 1.0;       // so much nearer, the higher one (a drop, a branch) hangs before the low one
    std::vector<bool> steep(seeds.size(), false);
    for (std::size_t i = 0; i < seeds.size(); ++i) {
        const GroundSeed& low = seeds[i];
        for (std::size_t j = i + 1; j < seeds.size() && isBeside(seeds[j], low); ++j) {
            const double rise = seeds[j].p.z() - low.p.z();
            const double run = std::max(seeds[j].range - low.range, 1e-3);
            if (rise < kMinDistance && run < kMinDistance) continue;
            if (rise > kSteepGround * run) steep[j] = true;
            if (seeds[j].range < low.range - kInFront) continue;  // the next one up tells
            if (rise > kWall * run) steep[i] = true;
            break;
        }
    }
    std::vector<GroundSeed> kept;
    for (std::size_t i = 0; i < seeds.size(); ++i)
        if (!steep[i]) kept.push_back(seeds[i]);
    return kept;
}

struct PlaneScore {
    double value = 0.0;
    int inliers = 0;
};

double seedTolerance(const GroundSeed& s) { return 0.08 + 0.006 * s.range; }

/// Seeds on the plane count for it, seeds below it against it: the ground has nothing under it.
PlaneScore score(const std::vector<GroundSeed>& seeds, const GroundPlane& plane) {
    PlaneScore r;
    for (const GroundSeed& s : seeds) {
        const double h = s.p.z() - plane.heightAt(s.p.x(), s.p.y());
        const double tolerance = seedTolerance(s);
        if (h < -2.0 * tolerance) {
            r.value -= 1.0;
        } else if (h < tolerance) {
            r.value += 1.0;
            ++r.inliers;
        }
    }
    return r;
}

bool solvePlane(const GroundSeed& a, const GroundSeed& b, const GroundSeed& c, GroundPlane& plane) {
    Eigen::Matrix3d m;
    m << a.p.x(), a.p.y(), 1.0, b.p.x(), b.p.y(), 1.0, c.p.x(), c.p.y(), 1.0;
    if (std::abs(m.determinant()) < 1.0) return false;  // the triangle holds less than half a square metre
    const Eigen::Vector3d abc = m.inverse() * Eigen::Vector3d(a.p.z(), b.p.z(), c.p.z());
    plane.slope = abc.head<2>();
    plane.offset = abc.z();
    return true;
}

/// Can the ground lie so? Not too steep, and below the sensor.
bool plausible(const GroundPlane& plane, const Eigen::Vector3f& sensor, const GroundParams& params) {
    constexpr double kMinSensorHeight = 0.25;
    constexpr double kMaxSensorHeight = 6.0;
    const double height = sensor.z() - plane.heightAt(sensor.x(), sensor.y());
    return plane.slope.norm() <= std::tan(params.max_slope_deg * kPi / 180.0) && height >= kMinSensorHeight &&
           height <= kMaxSensorHeight;
}

GroundPlane leastSquares(const std::vector<GroundSeed>& seeds, const GroundPlane& start) {
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    GroundPlane plane;
    for (const GroundSeed& s : seeds) {
        if (std::abs(s.p.z() - start.heightAt(s.p.x(), s.p.y())) > seedTolerance(s)) continue;
        const Eigen::Vector3d row(s.p.x(), s.p.y(), 1.0);
        a += row * row.transpose();
        b += row * s.p.z();
        ++plane.support;
    }
    if (plane.support < 3) return start;
    const Eigen::Vector3d abc = (a + 1e-6 * Eigen::Matrix3d::Identity()).ldlt().solve(b);
    plane.slope = abc.head<2>();
    plane.offset = abc.z();
    return plane;
}

}  // namespace

float fastAtan2(float y, float x) {
    const float ax = std::abs(x);
    const float ay = std::abs(y);
    const float t = std::min(ax, ay) / std::max(std::max(ax, ay), 1e-9f);
    float a = t * (kPi / 4 + 0.273f * (1.0f - t));
    if (ay > ax) a = kPi / 2 - a;
    if (x < 0.0f) a = kPi - a;
    return y < 0.0f ? -a : a;
}

std::vector<std::uint8_t> azimuthBins(const PointCloud& cloud) {
    constexpr std::uint8_t kUnset = 255;
    const Eigen::Vector3f& o = cloud.sensor_origin;
    const auto binOf = [&](std::size_t i) {
        const float angle = fastAtan2(cloud.xyz[i].y() - o.y(), cloud.xyz[i].x() - o.x());
        return static_cast<std::uint8_t>(
            std::clamp(static_cast<int>((angle + kPi) * (kSeedBins / (2 * kPi))), 0, kSeedBins - 1));
    };
    std::vector<std::uint8_t> bins(cloud.size());
    if (cloud.view.empty() || !cloud.sensors.empty()) {
        for (std::size_t i = 0; i < cloud.size(); ++i) bins[i] = binOf(i);
        return bins;
    }
    std::vector<std::uint8_t> bin_of_column(cloud.view.columns, kUnset);
    const std::size_t size = cloud.size();  // told once: to the compiler a byte that is stored may change anything
    const std::int32_t* column_of = cloud.view.column_of.data();
    for (std::size_t i = 0; i < size; ++i) {
        std::uint8_t& bin = bin_of_column[column_of[i]];
        if (bin == kUnset) bin = binOf(i);
        bins[i] = bin;
    }
    return bins;
}

std::vector<GroundSeed> groundSeeds(const PointCloud& cloud, const std::vector<std::uint8_t>& bins) {
    const bool has_rings = !cloud.ring.empty();
    const int highest = cloud.view.empty() && has_rings ? *std::max_element(cloud.ring.begin(), cloud.ring.end()) : 0;
    const int rows = !has_rings ? kRangeBins : std::max(cloud.view.rings, 1 + highest);
    std::vector<LowestThree> cells(static_cast<std::size_t>(kSeedBins) * rows);
    const Eigen::Vector3f& o = cloud.sensor_origin;
    std::size_t at = 0;
    LowestThree own;  // of the cell at this place: neighbours in the cloud are mostly in one
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f& p = cloud.xyz[i];
        const int row = has_rings ? cloud.ring[i] : rangeRow((p.head<2>() - o.head<2>()).norm());
        const std::size_t cell = bins[i] * static_cast<std::size_t>(rows) + static_cast<std::size_t>(row);
        if (cell != at) {
            cells[at] = own;
            own = cells[at = cell];
        }
        own.add(p.z(), static_cast<std::int32_t>(i));
    }
    cells[at] = own;
    std::vector<GroundSeed> seeds;
    for (std::size_t c = 0; c < cells.size(); ++c) {
        if (cells[c].count == 0) continue;
        GroundSeed s;
        s.p = cloud.xyz[cells[c].lowQuantile()].cast<double>();
        s.sensor = cloud.sensorOf(cells[c].lowQuantile());
        s.range = (s.p.head<2>() - o.head<2>().cast<double>()).norm();
        s.bin = static_cast<int>(c) / rows;
        s.row = static_cast<int>(c) % rows;
        seeds.push_back(s);
    }
    return dropSteep(seeds);
}

GroundPlane fitScanPlane(const std::vector<GroundSeed>& all, const Eigen::Vector3f& sensor_origin,
                         const GroundParams& params) {
    constexpr double kReach = 30.0;  // farther out the ground need not be the same plane
    constexpr std::size_t kVoters = 250;
    std::vector<GroundSeed> seeds;
    for (const GroundSeed& s : all)
        if (s.range < kReach) seeds.push_back(s);
    std::vector<GroundSeed> voters;  // every k-th seed is enough to compare hypotheses
    for (std::size_t i = 0; i < seeds.size(); i += 1 + seeds.size() / kVoters) voters.push_back(seeds[i]);
    GroundPlane best;
    if (static_cast<int>(seeds.size()) < params.min_seeds) return best;
    std::mt19937 random(static_cast<std::uint32_t>(params.seed));
    PlaneScore best_score;
    // Seeds are ordered by azimuth. Every other sample comes from one neighbourhood: where the ground bends, three
    // seeds from all around hardly ever lie on one plane.
    const std::size_t neighbourhood = std::max<std::size_t>(3, seeds.size() / 6);
    for (int i = 0; i < params.ransac_iterations; ++i) {
        const std::size_t reach = i % 2 == 0 ? seeds.size() : neighbourhood;
        const std::size_t first = random() % seeds.size();
        const auto draw = [&]() -> const GroundSeed& { return seeds[(first + random() % reach) % seeds.size()]; };
        const GroundSeed& a = draw();  // one by one: arguments are evaluated in any order
        const GroundSeed& b = draw();
        const GroundSeed& c = draw();
        GroundPlane plane;
        if (!solvePlane(a, b, c, plane) || !plausible(plane, sensor_origin, params)) continue;
        const PlaneScore s = score(voters, plane);
        if (s.value > best_score.value) {
            best_score = s;
            best = plane;
        }
    }
    if (score(seeds, best).inliers < params.min_seeds) return GroundPlane{};
    for (int i = 0; i < params.iterations; ++i) best = leastSquares(seeds, best);
    if (!plausible(best, sensor_origin, params)) return GroundPlane{};
    return best;
}

void followGround(const GroundPlane& scan_plane, std::vector<GroundSeed>& seeds) {
    constexpr double kMaxStep = 0.10;
    constexpr double kMaxBend = 0.12;     // rise over run against the plane of the scan (7 deg)
    constexpr double kSameHeight = 0.25;  // neighbouring bins agree up to this much [m]
    constexpr int kNeighbours = 4;        // bins to either side
    constexpr int kMinAgreeing = 7;       // of these and the bin itself
    const auto height = [&](const GroundSeed& s) { return s.p.z() - scan_plane.heightAt(s.p.x(), s.p.y()); };
    int rows = 0;
    for (const GroundSeed& s : seeds) rows = std::max(rows, s.row + 1);
    constexpr float kNone = 1e9f;
    std::vector<float> reached(static_cast<std::size_t>(kSeedBins) * rows, kNone);  // height, where a walk came by
    for (std::size_t i = 0; i < seeds.size();) {
        double range = 0.0;
        double level = 0.0;
        const GroundSeed& first = seeds[i];
        for (; i < seeds.size() && isBeside(seeds[i], first); ++i) {
            const GroundSeed& s = seeds[i];
            if (std::abs(height(s) - level) > kMaxStep + kMaxBend * std::max(0.0, s.range - range)) continue;
            range = std::max(range, s.range);
            level = height(s);
            reached[s.bin * rows + s.row] = static_cast<float>(level);
        }
    }
    for (GroundSeed& s : seeds) {
        const float own = reached[s.bin * rows + s.row];
        if (own == kNone) continue;
        int agreeing = 0;
        for (int k = -kNeighbours; k <= kNeighbours; ++k)
            agreeing += std::abs(reached[(s.bin + k + kSeedBins) % kSeedBins * rows + s.row] - own) < kSameHeight;
        s.followed = agreeing >= kMinAgreeing;
    }
}

}  // namespace lidar_obstacles
