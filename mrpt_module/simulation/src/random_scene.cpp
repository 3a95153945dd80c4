// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/random_scene.h"

#include <array>
#include <cmath>

#include "lidar_obstacles/simulation/lasers.h"
#include "lidar_obstacles/simulation/random.h"
#include "scene_layouts.h"

namespace lidar_obstacles::simulation {
namespace {

constexpr double kDuration = 4.0;  ///< [s]
constexpr double kDegree = M_PI / 180.0;

/// What is different from kind to kind.
struct KindSpec {
    RandomScene kind;
    const char* name;
    void (*lay)(SceneDraft& draft);
    double narrow, wide;  ///< pavement [m]
    double low, high;     ///< height of the sensor [m]
    double fastest;       ///< of the vehicle [m/s]
    double rough;         ///< ground off the pavement at most [m]
    double slope;         ///< at most
    Material beside;      ///< off the pavement
};

constexpr std::array<KindSpec, 7> kKinds{{
    {RandomScene::Street, "street", layStreet, 5.5, 15.0, 0.5, 3.0, 14.0, 0.10, 0.06, Material::Grass},
    {RandomScene::CarPark, "car-park", layCarPark, 60.0, 80.0, 0.4, 2.8, 5.0, 0.0, 0.03, Material::Asphalt},
    {RandomScene::Sidewalk, "sidewalk", laySidewalk, 5.5, 10.0, 0.4, 1.4, 1.6, 0.10, 0.06, Material::Grass},
    {RandomScene::ForestRoad, "forest-road", layForestRoad, 3.5, 7.0, 0.4, 3.0, 10.0, 0.35, 0.09, Material::TallGrass},
    {RandomScene::Track, "track", layTrack, 8.0, 14.0, 0.8, 2.5, 25.0, 0.15, 0.05, Material::Grass},
    {RandomScene::Park, "park", layPark, 2.0, 5.0, 0.4, 2.4, 3.0, 0.25, 0.05, Material::TallGrass},
    {RandomScene::OpenRoad, "open-road", layOpenRoad, 6.0, 16.0, 0.5, 3.0, 25.0, 0.10, 0.05, Material::Grass},
}};

const KindSpec& specOf(RandomScene kind) { return kKinds[static_cast<std::size_t>(kind)]; }

TrackSpec anyTrack(const KindSpec& kind, double length, Random& random) {
    TrackSpec track;
    track.width = random.uniform(kind.narrow, kind.wide);
    track.heading = random.uniform(-M_PI, M_PI);
    const bool straight = kind.kind == RandomScene::CarPark || random.uniform() < 0.4;
    const double radius = random.uniform(70.0, 300.0) * (random.uniform() < 0.5 ? -1.0 : 1.0);
    const double before = straight ? length : random.uniform(0.1, 0.5) * length;
    track.segments.push_back({before, 0.0});
    if (!straight) track.segments.push_back({length - before, (length - before) / radius});
    const auto height = [&] { return random.uniform(-1.0, 1.0) * kind.slope * length / 3.0; };
    track.elevation = Curve({{0.0, 0.0}, {length / 3.0, height()}, {2.0 * length / 3.0, height()}, {length, 0.0}});
    track.bank = Curve(random.uniform(-0.04, 0.04));
    return track;
}

TerrainSpec anyTerrain(const KindSpec& kind, Random& random) {
    TerrainSpec terrain;
    terrain.reach = 45.0;
    terrain.cell = 2.0;
    terrain.roughness = kind.rough * random.uniform();
    terrain.beside = kind.beside;
    if (kind.kind != RandomScene::CarPark) {
        const double bank = random.uniform(-0.8, 1.5) * (random.uniform() < 0.5 ? 1.0 : 0.2);  // a ditch, a slope
        terrain.verge = Curve({{4.0, 0.0}, {8.0, 0.3 * bank}, {25.0, bank}});
    }
    return terrain;
}

Pose6 anyError(Random& random) {
    Pose6 error;
    error.position = {0.01 * random.gaussian(), 0.01 * random.gaussian(), 0.02 * random.gaussian()};
    error.yaw = 0.3 * kDegree * random.gaussian();
    error.pitch = 0.5 * kDegree * random.gaussian();
    error.roll = 0.4 * kDegree * random.gaussian();
    return error;
}

SensorSpec anySensor(const KindSpec& kind, Random& random) {
    SensorSpec sensor;
    const bool tilted = random.uniform() < 0.25;
    sensor.pose.position.z() = random.uniform(kind.low, kind.high);
    sensor.pose.yaw = random.uniform(-M_PI, M_PI);
    sensor.pose.pitch = tilted ? kDegree * random.uniform(-12.0, 15.0) : kDegree * random.gaussian();
    sensor.pose.roll = tilted ? kDegree * random.uniform(-6.0, 6.0) : 0.7 * kDegree * random.gaussian();
    sensor.mount_error = anyError(random);
    sensor.range_noise = 0.005 * std::pow(6.0, random.uniform());
    sensor.laser_bias = random.uniform(0.0, 0.012);
    const double u = random.uniform();
    sensor.rate = u < 0.7 ? 10.0 : u < 0.85 ? 5.0 : 20.0;
    sensor.dropout = random.uniform() < 0.5 ? 0.0 : random.uniform(0.0, 0.06);
    sensor.rain = random.uniform() < 0.9 ? 0.0 : random.uniform(0.0, 0.01);
    return sensor;
}

EgoSpec anyEgo(const KindSpec& kind, const TrackSpec& track, double height, Random& random) {
    EgoSpec ego;
    const bool robot = kind.kind == RandomScene::Sidewalk || height < 1.0;
    ego.wheelbase = robot ? 0.5 : random.uniform(2.3, 3.2);
    ego.gauge = robot ? 0.4 : random.uniform(1.4, 1.7);
    const double speed = random.uniform() < 0.2 ? 0.0 : random.uniform(0.0, kind.fastest);
    double d = -random.uniform(0.1, 0.27) * track.width;
    if (kind.kind == RandomScene::CarPark) d = random.uniform(-1.0, 1.0);
    if (kind.kind == RandomScene::Sidewalk) d = -0.5 * track.width - random.uniform(0.6, 1.4);
    const double start = 45.0;
    ego.waypoints = {{0.0, start, d}, {kDuration, start + std::max(1e-3, speed * kDuration), d}};
    return ego;
}

}  // namespace

const char* toString(RandomScene kind) { return specOf(kind).name; }

std::optional<RandomScene> randomSceneNamed(const std::string& name) {
    for (const KindSpec& spec : kKinds)
        if (name == spec.name) return spec.kind;
    return std::nullopt;
}

const std::vector<RandomScene>& randomScenes() {
    static const std::vector<RandomScene> kinds = [] {
        std::vector<RandomScene> all;
        for (const KindSpec& spec : kKinds) all.push_back(spec.kind);
        return all;
    }();
    return kinds;
}

Scenario randomScenario(RandomScene kind, std::uint64_t seed) {
    const KindSpec& spec = specOf(kind);
    Random random(seed, 501, static_cast<std::uint64_t>(kind));
    Scenario scenario;
    scenario.duration = kDuration;
    scenario.sensor = anySensor(spec, random);
    scenario.terrain = anyTerrain(spec, random);
    const double length = spec.kind == RandomScene::CarPark ? 90.0 : 110.0 + spec.fastest * kDuration;
    scenario.track = anyTrack(spec, length, random);
    scenario.ego = anyEgo(spec, scenario.track, scenario.sensor.pose.position.z(), random);
    SceneDraft draft(std::move(scenario), Random(seed, 502, static_cast<std::uint64_t>(kind)));
    spec.lay(draft);
    return draft.take();
}

std::vector<double> randomLasers(RandomScene kind, std::uint64_t seed) {
    constexpr std::array kOthers{LaserLayout::Vlp16HiRes, LaserLayout::Hdl32, LaserLayout::Hdl64};
    Random random(seed, 504, static_cast<std::uint64_t>(kind));
    const double other = kOthers.size() * (3.0 * random.uniform() - 2.0);  // two of three are a VLP-16
    return decimated(elevationsOf(other < 0.0 ? LaserLayout::Vlp16 : kOthers[static_cast<std::size_t>(other)]), 16);
}

}  // namespace lidar_obstacles::simulation
