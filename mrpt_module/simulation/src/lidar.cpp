// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/lidar.h"

#include <cmath>

#include "beam.h"
#include "firings.h"
#include "lidar_obstacles/simulation/lasers.h"

namespace lidar_obstacles::simulation {
namespace {

constexpr double kMargin = 0.1;          ///< of the poses before and after a turn [s]
constexpr double kDistanceUnit = 0.002;  ///< of a packet [m]
constexpr std::uint64_t kBias = 601;     ///< name of the stream of the lasers' errors

/// The bodies of a turn in the order of the ray scene.
struct TurnScene {
    RayScene rays;
    std::vector<Body> bodies;
    std::vector<std::int32_t> object_of_body;  ///< index in World::objects or kOnStructure
};

void addBody(TurnScene& scene, const RayMesh& mesh, const PoseTrack* poses, std::int32_t object) {
    std::vector<Eigen::Isometry3d> nodes;
    if (!poses) nodes.push_back(Eigen::Isometry3d::Identity());
    if (poses)
        for (const Pose6& node : poses->nodes()) nodes.push_back(toIsometry(node));
    scene.rays.add(mesh, nodes);
    scene.bodies.push_back({&mesh.mesh(), poses});
    scene.object_of_body.push_back(object);
}

void fillScene(TurnScene& scene, const World& world, const Turn& turn, const TurnPoses& poses) {
    for (const Structure& structure : world.structures) addBody(scene, structure.mesh, nullptr, kOnStructure);
    for (std::size_t i = 0; i < world.objects.size(); ++i) {
        if (!poses.objects[i]) continue;
        const WorldObject& object = world.objects[i];
        addBody(scene, object.postures[postureAt(object, turn.middle())], &*poses.objects[i],
                static_cast<std::int32_t>(i));
    }
    scene.rays.commit();
}

/// The shots of a turn, one after the other.
class ScanCaster {
  public:
    ScanCaster(const World& world, const Turn& turn, const TurnPoses& poses, std::uint64_t seed)
        : world_(world),
          sensor_(world.scenario.sensor),
          poses_(poses),
          seed_(seed),
          lasers_(lasersOf(sensor_)),
          mounted_(mountedPose(sensor_)) {
        fillScene(scene_, world, turn, poses);
        scan_.turn = turn;
        scan_.sights.resize(world.objects.size());
        for (std::size_t laser = 0; laser < lasers_.size(); ++laser)
            biases_.push_back(sensor_.laser_bias * Random(seed, kBias, laser).gaussian());
    }

    LidarScan cast() {
        const std::vector<Firing> firings = firingsOf(world_, scan_.turn, poses_.ego);
        const BeamCaster beams(scene_.rays, scene_.bodies, sensor_);
        scan_.returns.reserve(firings.size() * lasers_.size());
        for (std::size_t f = 0; f < firings.size(); ++f)
            for (std::size_t laser = 0; laser < lasers_.size(); ++laser)
                if (lasers_[laser].active) castShot(beams, firings[f], static_cast<std::int32_t>(f), laser);
        for (std::size_t i = 0; i < world_.objects.size(); ++i)
            if (poses_.objects[i])
                scan_.sights[i].alone = countAlone(world_, firings, world_.objects[i], *poses_.objects[i]);
        return std::move(scan_);
    }

  private:
    void castShot(const BeamCaster& beams, const Firing& firing, std::int32_t number, std::size_t laser) {
        const double time = firing.time + lasers_[laser].delay;
        const Eigen::Vector3d direction = directionOf(lasers_[laser].elevation, time, sensor_.rate);
        Shot shot;
        shot.time = time;
        shot.ray.origin = firing.T_world_sensor.translation().cast<float>();
        shot.ray.direction = (firing.T_world_sensor.linear() * direction).cast<float>();
        shot.ray.time = static_cast<float>((time - poses_.ego.start()) / (poses_.ego.end() - poses_.ego.start()));
        shot.ray.far = static_cast<float>(sensor_.max_range + 1.0);
        Random random(seed_, scan_.turn.index, static_cast<std::uint64_t>(number) * lasers_.size() + laser);
        std::uint32_t first = kNoBody;
        const auto echo = beams.shoot(shot, random, first);
        if (first != kNoBody && scene_.object_of_body[first] >= 0)
            ++scan_.sights[static_cast<std::size_t>(scene_.object_of_body[first])].first;
        if (!echo) return;
        const double range = echo->range + biases_[laser];
        if (range < sensor_.min_range || range > sensor_.max_range) return;
        LidarReturn r;
        r.point = (mounted_ * (range * direction)).cast<float>();
        r.time = static_cast<float>(time - scan_.turn.start());
        r.firing = number;
        r.laser = static_cast<std::uint8_t>(laser);
        r.intensity = static_cast<std::uint8_t>(std::lround(echo->brightness));
        r.raw = static_cast<std::uint16_t>(std::lround(range / kDistanceUnit));
        r.object = echo->body == kNoBody ? kOnNothing : scene_.object_of_body[echo->body];
        r.normal = echo->normal;
        label(r, *echo);
        scan_.returns.push_back(r);
    }

    void label(LidarReturn& r, const Echo& echo) const {
        if (r.object == kOnNothing) return;
        if (r.object == kOnStructure) {
            const SurfaceLabel& surface = world_.structures[echo.body].labels[echo.triangle];
            r.id = surface.id;
            r.kind = surface.kind;
            return;
        }
        const WorldObject& object = world_.objects[static_cast<std::size_t>(r.object)];
        r.id = object.id;
        r.kind = object.model->kind;
    }

    const World& world_;
    const SensorSpec& sensor_;
    const TurnPoses& poses_;
    std::uint64_t seed_;
    std::vector<Laser> lasers_;
    std::vector<double> biases_;  ///< of each laser [m]
    Eigen::Isometry3d mounted_;
    TurnScene scene_;
    LidarScan scan_;
};

}  // namespace

int ringOf(int laser) { return laser % 2 == 0 ? laser / 2 : 8 + laser / 2; }

double turnsAt(double t, double rate) { return t * rate; }

Turn turnNumber(std::size_t index, double rate) {
    const auto firstOf = [rate](std::size_t turn) {
        return static_cast<std::size_t>(std::ceil(static_cast<double>(turn) / (rate * kPacketPeriod) - 1e-9));
    };
    return {index, firstOf(index), static_cast<int>(firstOf(index + 1) - firstOf(index))};
}

TurnPoses posesDuring(const World& world, const Turn& turn) {
    const TimeSpan span{turn.start() - kMargin, turn.end() + kMargin};
    TurnPoses poses{egoPoses(world, span), {}};
    const Eigen::Vector3d ego = poses.ego.at(turn.middle()).position;
    for (const WorldObject& object : world.objects) {
        const PlanarPose pose = poseOf(object.motion, turn.middle(), turn.index);
        const double reach = world.scenario.sensor.max_range + object.model->size.norm();
        poses.objects.emplace_back();
        if ((pose.position - ego.head<2>()).norm() < reach)
            poses.objects.back() = objectPoses(world, object, span, turn.index);
    }
    return poses;
}

LidarScan castScan(const World& world, const Turn& turn, const TurnPoses& poses, std::uint64_t seed) {
    return ScanCaster(world, turn, poses, seed).cast();
}

}  // namespace lidar_obstacles::simulation
