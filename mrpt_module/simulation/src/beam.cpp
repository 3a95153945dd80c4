// SPDX-License-Identifier: BSD-3-Clause
#include "beam.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles::simulation {
namespace {

constexpr double kBeamWidth = 0.75e-3;  ///< standard deviation of the light across the beam (3 mrad in all) [rad]
constexpr double kPulse = 0.9;          ///< surfaces nearer than that to each other in range give one echo [m]
constexpr int kMostPanes = 4;           ///< panes of glass or wire that a ray goes through
constexpr int kMostSurfaces = 24;       ///< these and the surfaces of leaves

/// Signal over threshold. A tenth of the light sent back at 100 m head-on is what the sensor is specified for.
double signal(double reflectivity, double cosine, double range) {
    constexpr double kReference = 250.0;  // [m]
    return reflectivity * cosine * (kReference / range) * (kReference / range);
}

/// Share of the shots of that signal that are seen.
double detection(double signal) { return 1.0 / (1.0 + std::exp(-10.0 * (signal - 0.3))); }

}  // namespace

/// How far the light gets behind the point where it goes in among leaves: as between things strewn at random (Beer's
/// law), denser in some places and thinner in others.
double BeamCaster::depthIn(const RayHit& leaves, const Ray& ray, Random& random) const {
    constexpr float kClump = 0.2f;       // size of those places [m]
    constexpr double kUnevenness = 0.6;  // standard deviation of the logarithm of the density
    const Eigen::Vector3f place = (ray.origin + leaves.distance * ray.direction) / kClump;
    const auto cell = [&](int k) { return static_cast<std::uint64_t>(std::llround(std::floor(place[k]))); };
    const double density = std::exp(kUnevenness * Random(cell(0), cell(1), cell(2)).gaussian());
    return -opticsOf(materialOf(leaves)).free_path / density * std::log(1.0 - random.uniform());
}

/// What sends the light back: the first thing that is not glass or wire that it goes through, or something among
/// leaves. Volumes of leaves may overlap.
std::optional<Stop> BeamCaster::stopOf(const Shot& shot, const RayHit& first, Random& random) const {
    Ray ray = shot.ray;
    std::optional<RayHit> at = first;
    int inside = 0;  // volumes of leaves
    for (int panes = 0, surfaces = 0; panes < kMostPanes && surfaces < kMostSurfaces && at; ++surfaces) {
        const Optics& optics = opticsOf(materialOf(*at));
        if (optics.free_path > 0.0) {
            inside += worldNormal(*at, shot).dot(ray.direction) < 0.0f ? 1 : -1;
        } else {
            if (random.uniform() >= optics.pass) return Stop{*at};
            ++panes;
        }
        ray.near = at->distance + 0.01f;
        const std::optional<RayHit> next = scene_.cast(ray);
        if (inside > 0 && optics.free_path > 0.0) {
            const double depth = depthIn(*at, ray, random);
            if (!next || at->distance + depth < next->distance) return Stop{*at, depth};
        }
        at = next;
    }
    if (!at) return std::nullopt;
    return Stop{*at};
}

/// A part of the beam may meet another surface than its middle does. Is it near in range the two pulses run together
/// and a distance in between is told; otherwise the sensor tells the stronger one, here always the middle's.
double BeamCaster::withMixing(const Ray& ray, const RayHit& hit, const Eigen::Vector3f& normal, Random& random) const {
    constexpr double kSameSurface = 0.05;  // [m]
    const Eigen::Vector3f across = ray.direction.unitOrthogonal(), up = ray.direction.cross(across);
    Ray edge = ray;
    edge.direction = (ray.direction + static_cast<float>(kBeamWidth * random.gaussian()) * across +
                      static_cast<float>(kBeamWidth * random.gaussian()) * up)
                         .normalized();
    const double range = hit.distance, share = random.uniform(0.0, 0.5);
    const auto other = scene_.cast(edge);
    if (!other || std::abs(other->distance - range) > kPulse) return range;
    // Where the edge of the beam would meet the plane of the surface: there a beam's width is averaged, not mixed.
    const double on_plane = range * normal.dot(ray.direction) / normal.dot(edge.direction);
    if (std::abs(other->distance - on_plane) < kSameSurface) return range;
    return range + share * (other->distance - range);
}

Eigen::Vector3f BeamCaster::worldNormal(const RayHit& hit, const Shot& shot) const {
    const PoseTrack* poses = bodies_[hit.body].poses;
    if (!poses) return hit.normal;
    return toIsometry(poses->at(shot.time)).linear().cast<float>() * hit.normal;
}

std::optional<Echo> BeamCaster::echoOf(const Stop& stop, const Shot& shot, Random& random) const {
    constexpr double kAnyLeaf = 0.5;  // mean cosine of leaves that stand at random
    const RayHit& hit = stop.hit;
    const Optics& optics = opticsOf(materialOf(hit));
    const Eigen::Vector3f normal = worldNormal(hit, shot);
    const float cosine_to = normal.dot(shot.ray.direction);
    const bool among_leaves = optics.free_path > 0.0;
    const double cosine = optics.retro ? 1.0 : among_leaves ? kAnyLeaf : std::abs(cosine_to);
    if (optics.specular && cosine < 0.95) return std::nullopt;
    if (optics.loss > 0.0 && random.uniform() < optics.loss) return std::nullopt;
    const double range = hit.distance + stop.depth;
    const double haze = std::exp(-sensor_.rain * range / 20.0);
    if (random.uniform() >= detection(haze * signal(optics.reflectivity, cosine, range))) return std::nullopt;
    Echo echo;
    const double noise = std::hypot(sensor_.range_noise, optics.depth) * random.gaussian();
    echo.range = (among_leaves ? range : withMixing(shot.ray, hit, normal, random)) + noise;
    const double brightness = optics.retro ? 225.0 : 100.0 * optics.reflectivity * std::sqrt(cosine);
    echo.brightness = std::clamp(brightness * (1.0 + 0.08 * random.gaussian()), 1.0, 255.0);
    echo.body = hit.body;
    echo.triangle = hit.triangle;
    echo.normal = cosine_to > 0.0f ? Eigen::Vector3f(-hit.normal) : hit.normal;
    return echo;
}

/// A drop before the distance `before`: the nearer the more likely to send enough light back.
std::optional<Echo> BeamCaster::dropEcho(double before, Random& random) const {
    constexpr double kMean = 3.0, kFarthest = 15.0;  // [m]
    const double room = std::min(before, kFarthest) - sensor_.min_range;
    if (room <= 0.0) return std::nullopt;
    const double share = random.uniform() * (1.0 - std::exp(-room / kMean));
    Echo echo;
    echo.range = sensor_.min_range - kMean * std::log(1.0 - share);
    echo.brightness = random.uniform(1.0, 12.0);
    return echo;
}

std::optional<Echo> BeamCaster::shoot(const Shot& shot, Random& random, std::uint32_t& first) const {
    const std::optional<RayHit> hit = scene_.cast(shot.ray);
    first = hit ? hit->body : kNoBody;
    if (sensor_.rain > 0.0 && random.uniform() < sensor_.rain) return dropEcho(hit ? hit->distance : 1e3, random);
    if (!hit) return std::nullopt;
    if (sensor_.dropout > 0.0 && random.uniform() < sensor_.dropout) return std::nullopt;
    const std::optional<Stop> stop = stopOf(shot, *hit, random);
    return stop ? echoOf(*stop, shot, random) : std::nullopt;
}

}  // namespace lidar_obstacles::simulation
