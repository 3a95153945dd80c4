// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/world.h"

#include <cmath>
#include <map>
#include <utility>

namespace lidar_obstacles::simulation {
namespace {

constexpr double kPoseStep = 0.02;  ///< of the lattice of poses [s]: 20 m/s and 30 deg/s bend by 0.5 mm within it

Mesh joined(Mesh a, const Mesh& b) {
    append(a, b);
    return a;
}

Stance egoStance(const Scenario& scenario) { return {scenario.ego.wheelbase, scenario.ego.gauge}; }

Motion motionOf(const ObjectSpec& spec, const World& world, const Model& model) {
    if (const auto* standing = std::get_if<Standing>(&spec.motion)) {
        const double heading = world.track->at(standing->s).heading;
        return PlanarPose{world.track->place(standing->s, standing->d), heading + standing->yaw};
    }
    if (const auto* grid = std::get_if<Gridded>(&spec.motion))
        return gridPoses(*grid, world.ego.at(0.0), model.size.head<2>());
    const auto& moving = std::get<Moving>(spec.motion);
    return Path(world.track, moving.waypoints, moving.follows_ego ? world.ego.along() : Curve());
}

/// @throws ScenarioError if a thing is beside the terrain at any time, looked at twice a second.
void requireGround(const World& world, const Motion& motion, const Stance& stance) {
    const double duration = durationOf(world.scenario);
    for (double t = 0.0; t <= duration; t += 0.5) {
        const auto scan = static_cast<std::size_t>(t * world.scenario.sensor.rate);
        standOn(*world.ground, poseOf(motion, t, scan), stance);
        if (std::holds_alternative<PlanarPose>(motion)) return;
    }
}

void addObjects(World& world) {
    using Built = std::pair<std::shared_ptr<const Model>, std::vector<RayMesh>>;
    std::map<std::pair<std::string, std::uint64_t>, Built> models;
    for (const ObjectSpec& spec : world.scenario.objects) {
        auto& [model, postures] = models[{spec.model, spec.variant}];
        if (!model) {
            model = modelNamed(spec.model, spec.variant);
            if (!model) throw ScenarioError("there is no model '" + spec.model + "'");
            for (const Mesh& posture : model->postures) postures.emplace_back(posture);
        }
        const int id = static_cast<int>(world.objects.size()) + 1;
        world.objects.push_back({id, model, postures, motionOf(spec, world, *model)});
        try {
            requireGround(world, world.objects.back().motion, world.objects.back().stance());
        } catch (const ScenarioError& e) {
            throw ScenarioError("object " + std::to_string(id) + " (" + spec.model + "): " + e.what());
        }
    }
}

std::shared_ptr<const Track> makeTrack(const TrackSpec& spec) {
    try {
        return std::make_shared<const Track>(spec);
    } catch (const std::invalid_argument& e) {
        throw ScenarioError("track: " + std::string(e.what()));
    }
}

/// The angle next to `reference` that differs from `angle` by full circles.
double unwrapped(double angle, double reference) { return reference + std::remainder(angle - reference, 2.0 * M_PI); }

PoseTrack sampled(const Ground& ground, const Stance& stance, const TimeSpan& span, const Path& path) {
    const auto first = static_cast<long>(std::floor(span.from / kPoseStep));
    const auto last = static_cast<long>(std::ceil(span.to / kPoseStep));
    std::vector<Pose6> nodes;
    for (long k = first; k <= last; ++k) {
        Pose6 pose = standOn(ground, path.at(static_cast<double>(k) * kPoseStep), stance);
        if (!nodes.empty()) pose.yaw = unwrapped(pose.yaw, nodes.back().yaw);
        nodes.push_back(pose);
    }
    return {static_cast<double>(first) * kPoseStep, kPoseStep, std::move(nodes)};
}

}  // namespace

World buildWorld(const Scenario& scenario) {
    auto track = makeTrack(scenario.track);
    const Ground terrain(terrainMesh(*track, scenario.terrain));
    const Clutter drivable = buildClutter(scenario.clutter, true, *track, terrain);
    auto ground = std::make_shared<const Ground>(joined(terrain.mesh().mesh(), drivable.mesh));
    Clutter clutter = buildClutter(scenario.clutter, false, *track, *ground);
    std::vector<SurfaceLabel> labels(terrain.mesh().mesh().triangles.size());
    labels.insert(labels.end(), drivable.labels.begin(), drivable.labels.end());
    World world{scenario, track, ground, {}, drivable.boxes, Path(track, scenario.ego.waypoints), {}};
    world.structures.push_back({ground->mesh(), std::move(labels)});
    if (!clutter.mesh.empty())
        world.structures.push_back({RayMesh(std::move(clutter.mesh)), std::move(clutter.labels)});
    world.boxes.insert(world.boxes.end(), clutter.boxes.begin(), clutter.boxes.end());
    requireGround(world, world.ego, egoStance(scenario));
    addObjects(world);
    return world;
}

PoseTrack::PoseTrack(double start, double step, std::vector<Pose6> nodes)
    : start_(start), step_(step), nodes_(std::move(nodes)) {}

Pose6 PoseTrack::at(double t) const {
    if (nodes_.size() == 1) return nodes_.front();
    const double place = std::clamp((t - start_) / step_, 0.0, static_cast<double>(nodes_.size() - 1));
    const std::size_t i = std::min(static_cast<std::size_t>(place), nodes_.size() - 2);
    const Pose6 &a = nodes_[i], &b = nodes_[i + 1];
    const double u = place - static_cast<double>(i);
    const auto between = [u](double x, double y) { return x + u * (y - x); };
    return {a.position + u * (b.position - a.position), between(a.yaw, b.yaw), between(a.pitch, b.pitch),
            between(a.roll, b.roll)};
}

PoseTrack egoPoses(const World& world, const TimeSpan& span) {
    return sampled(*world.ground, egoStance(world.scenario), span, world.ego);
}

PoseTrack objectPoses(const World& world, const WorldObject& object, const TimeSpan& span, std::size_t scan) {
    if (const auto* path = std::get_if<Path>(&object.motion))
        return sampled(*world.ground, object.stance(), span, *path);
    return {span.from, 1.0, {standOn(*world.ground, poseOf(object.motion, span.from, scan), object.stance())}};
}

std::size_t postureAt(const WorldObject& object, double t) {
    constexpr double kWalkCycle = 1.1;  // two steps [s]
    const std::size_t n = object.postures.size();
    const auto* path = std::get_if<Path>(&object.motion);
    if (n == 1 || !path || !path->isMoving(t)) return 0;
    const double phase = t / kWalkCycle + 0.37 * object.id;
    return std::min(n - 1, static_cast<std::size_t>((phase - std::floor(phase)) * static_cast<double>(n)));
}

}  // namespace lidar_obstacles::simulation
