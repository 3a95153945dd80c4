// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/ground.h"
#include "ground/checked_ground.h"
#include "ground/ground_runs.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

namespace lidar_obstacles {
namespace {

constexpr float kPi = 3.14159265f;
constexpr int kBands = 3;

}  // namespace

/// The planes of neighbouring patches go over into each other. In the middle of a patch its own plane counts alone, on
/// its border both count the same, in between linearly: a plane is trusted up to half a patch beyond its border.
double GroundModel::heightAt(double x, double y) const {
    if (planes.empty()) return 0.0;
    const double dx = x - center.x();
    const double dy = y - center.y();
    const double turned =
        0.5 + (fastAtan2(static_cast<float>(dy), static_cast<float>(dx)) + kPi) * (sectors / (2.0 * kPi));
    const auto next = static_cast<int>(turned);
    const double share = turned - next;
    const std::size_t bands = band_limits.size() + 1;
    const std::size_t after = bands * static_cast<std::size_t>(next < sectors ? next : next - sectors);
    const std::size_t before = after > 0 ? after - bands : planes.size() - bands;
    const auto at = [&](std::size_t band) {
        const double height = planes[before + band].heightAt(x, y);
        return height + share * (planes[after + band].heightAt(x, y) - height);
    };
    const double range = std::sqrt(dx * dx + dy * dy);
    double inner = 0.0;  // limit of the band
    for (std::size_t band = 0; band + 1 < bands; ++band) {
        const double limit = band_limits[band];
        const double width = band + 2 < bands ? std::min(limit - inner, band_limits[band + 1] - limit) : limit - inner;
        const double beyond = (range - limit) / std::max(width, 1e-6);
        if (beyond <= -0.5) return at(band);
        if (beyond < 0.5) return at(band) + (0.5 + beyond) * (at(band + 1) - at(band));
        inner = limit;
    }
    return at(bands - 1);
}

namespace {

int bandOf(double range, const std::vector<double>& limits) {
    int band = 0;
    while (band < static_cast<int>(limits.size()) && range >= limits[band]) ++band;
    return band;
}

/// Range limits between the bands, so that each holds the same number of ground rings (Zermas et al. divide by
/// metres; sixteen rings leave most of such segments empty).
std::vector<double> bandLimits(const std::vector<GroundSeed>& seeds, const GroundPlane& plane) {
    std::vector<std::vector<double>> ranges_of_row;
    for (const GroundSeed& s : seeds) {
        // a wide gate: the ground may bend away from the plane of the scan
        if (std::abs(s.p.z() - plane.heightAt(s.p.x(), s.p.y())) > 0.2 + 0.05 * s.range) continue;
        if (static_cast<int>(ranges_of_row.size()) <= s.row) ranges_of_row.resize(s.row + 1);
        ranges_of_row[s.row].push_back(s.range);
    }
    std::vector<double> rows;
    for (std::vector<double>& r : ranges_of_row) {
        if (r.size() < 3) continue;
        std::nth_element(r.begin(), r.begin() + r.size() / 2, r.end());
        rows.push_back(r[r.size() / 2]);
    }
    std::sort(rows.begin(), rows.end());
    std::vector<double> limits;
    const int bands = std::min(kBands, static_cast<int>(rows.size()) / 2);
    for (int b = 1; b < bands; ++b) {
        const std::size_t first = rows.size() * b / bands;  // first ring of band b
        limits.push_back(0.5 * (rows[first - 1] + rows[first]));
    }
    return limits;
}

struct Patch {
    int sector = 0;
    double inner = 0.0;
    double outer = 0.0;
    double above = 1.0;  ///< seeds above the prior count up to this share of the tolerance
};

/// Least squares on the seeds near the prior plane; the prior itself enters as four observations at the patch's
/// corners, so that a patch with few seeds stays with it.
GroundPlane refine(const std::vector<const GroundSeed*>& seeds, const GroundPlane& prior, const Patch& patch,
                   const GroundModel& model) {
    constexpr double kPriorWeight = 0.5;
    constexpr double kUsualStep = 0.15;  // [m]
    constexpr double kLeastWeight = 0.2;
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    const auto observe = [&](double x, double y, double z, double weight) {
        const Eigen::Vector3d row(x, y, 1.0);
        a += weight * row * row.transpose();
        b += weight * row * z;
    };
    for (int corner = 0; corner < 4; ++corner) {
        const double angle = 2 * kPi * (patch.sector + (corner & 1)) / model.sectors - kPi;
        const double range = (corner & 2) != 0 ? patch.outer : patch.inner;
        const double x = model.center.x() + range * std::cos(angle);
        const double y = model.center.y() + range * std::sin(angle);
        observe(x, y, prior.heightAt(x, y), kPriorWeight);
    }
    GroundPlane plane;
    for (const GroundSeed* s : seeds) {
        const double h = s->p.z() - prior.heightAt(s->p.x(), s->p.y());
        const double tolerance = 0.12 + 0.012 * s->range;
        if (!s->followed && (h < -tolerance || h > patch.above * tolerance)) continue;
        // what stands on the ground reaches down to it in few seeds: those above count less, the lowest are the ground
        const double above = std::max(0.0, h) / kUsualStep;
        const double least = s->followed ? 1.0 : kLeastWeight;
        observe(s->p.x(), s->p.y(), s->p.z(), std::max(least, 1.0 / (1.0 + above * above)));
        ++plane.support;
    }
    const Eigen::Vector3d abc = a.ldlt().solve(b);
    plane.slope = abc.head<2>();
    plane.offset = abc.z();
    return plane;
}

/// The better of two priors for a patch: the one with more seeds on it.
const GroundPlane& betterPrior(const std::vector<const GroundSeed*>& seeds, const GroundPlane& scan,
                               const GroundPlane& inner) {
    int votes = 0;
    for (const GroundSeed* s : seeds) {
        const double tolerance = 0.1 + 0.01 * s->range;
        votes += std::abs(s->p.z() - inner.heightAt(s->p.x(), s->p.y())) < tolerance;
        votes -= std::abs(s->p.z() - scan.heightAt(s->p.x(), s->p.y())) < tolerance;
    }
    return votes > 0 ? inner : scan;
}

/// A patch and the plane to start from.
struct PatchPrior {
    GroundPlane plane;
    Patch patch;
};

/// Refits a patch; the last time seeds above it count less, as the ground is what lies lowest. Stops before it gets
/// steeper than ground can be.
GroundPlane refineRepeatedly(const std::vector<const GroundSeed*>& seeds, PatchPrior prior, const GroundParams& params,
                             const GroundModel& model) {
    const double steepest = std::tan(params.max_slope_deg * kPi / 180.0);
    prior.plane.support = 0;
    for (int i = 0; i < params.iterations; ++i) {
        prior.patch.above = i + 1 < params.iterations ? 1.0 : 0.6;
        const GroundPlane next = refine(seeds, prior.plane, prior.patch, model);
        if (next.slope.norm() > steepest) break;
        prior.plane = next;
    }
    return prior.plane;
}

void fitPatches(const std::vector<GroundSeed>& seeds, const GroundPlane& scan, const GroundParams& params,
                GroundModel& model) {
    const int bands = static_cast<int>(model.band_limits.size()) + 1;
    model.planes.assign(static_cast<std::size_t>(model.sectors) * bands, scan);
    std::vector<std::vector<const GroundSeed*>> members(static_cast<std::size_t>(bands));  // of a sector, by band
    auto next = seeds.begin();  // in the order of their sectors
    for (int sector = 0; sector < model.sectors; ++sector) {
        for (auto& own : members) own.clear();
        for (; next != seeds.end() && next->bin * model.sectors / kSeedBins == sector; ++next)
            members[bandOf(next->range, model.band_limits)].push_back(&*next);
        GroundPlane inner = scan;
        for (int band = 0; band < bands; ++band) {
            const Patch patch{sector, band == 0 ? 1.0 : model.band_limits[band - 1],
                              band + 1 < bands ? model.band_limits[band] : 40.0, 1.0};
            inner = refineRepeatedly(members[band], {betterPrior(members[band], scan, inner), patch}, params, model);
            model.planes[sector * bands + band] = inner;
        }
    }
}

void setNormal(GroundModel& model) {
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    double weight = 0.0;
    for (const GroundPlane& p : model.planes) {
        slope += p.support * p.slope;
        weight += p.support;
    }
    if (weight > 0.0) slope /= weight;
    model.normal = Eigen::Vector3d(-slope.x(), -slope.y(), 1.0).normalized();
}

void labelReturns(const PointCloud& cloud, const GroundParams& params, GroundModel& model) {
    const Eigen::Vector2f center = model.center.cast<float>();
    const auto threshold = static_cast<float>(params.threshold);
    const auto growth = static_cast<float>(params.threshold_per_metre);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f& p = cloud.xyz[i];
        const auto height = static_cast<float>(p.z() - model.heightAt(p.x(), p.y()));
        model.height[i] = height;
        model.is_ground[i] = static_cast<std::uint8_t>(height < threshold + growth * (p.head<2>() - center).norm());
    }
}

}  // namespace

GroundModel segmentGround(const PointCloud& cloud, const GroundParams& params) {
    DetectorParams all;
    all.ground = params;
    validate(all);
    validate(cloud);
    return segmentCheckedGround(cloud, params);
}

GroundModel segmentCheckedGround(const PointCloud& cloud, const GroundParams& params) {
    GroundModel model;
    model.center = cloud.sensor_origin.head<2>().cast<double>();
    model.is_ground.assign(cloud.size(), 0);
    model.height.resize(cloud.size());
    const std::vector<std::uint8_t> bins = azimuthBins(cloud);
    std::vector<GroundSeed> seeds = groundSeeds(cloud, bins);
    const GroundPlane scan = fitScanPlane(seeds, cloud.sensor_origin, params);
    if (scan.support == 0) {
        for (std::size_t i = 0; i < cloud.size(); ++i) model.height[i] = cloud.xyz[i].z();
        return model;
    }
    model.evidence = scan.support >= 3 * params.min_seeds ? GroundEvidence::Good : GroundEvidence::Weak;
    followGround(scan, seeds);
    model.sectors = params.sectors;
    model.band_limits = bandLimits(seeds, scan);
    fitPatches(seeds, scan, params, model);
    setNormal(model);
    labelReturns(cloud, params, model);
    if (params.standing_runs) keepStandingRuns(cloud, model);
    keepFeetOfObstacles(cloud, model);
    if (params.rising_runs) followRisingGround(cloud, model);
    return model;
}

}  // namespace lidar_obstacles
