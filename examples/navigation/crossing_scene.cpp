// SPDX-License-Identifier: BSD-3-Clause
#include "crossing_scene.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lidar_obstacles/simulation/random.h"

namespace lidar_obstacles::examples {
namespace {

using namespace simulation;

/// Straight from a place at time 0 with a speed along the street and one across.
struct Course {
    Eigen::Vector2d from, velocity;  ///< s, d
    double radius;                   ///< of a circle around it [m]

    Eigen::Vector2d at(double t) const { return from + t * velocity; }
};

bool keepsClear(const Course& course, const std::vector<Course>& others) {
    constexpr double kApart = 0.6;  // [m]
    return std::all_of(others.begin(), others.end(), [&](const Course& other) {
        for (double t = 0.0; t < kDuration; t += 0.1)
            if ((course.at(t) - other.at(t)).norm() < course.radius + other.radius + kApart) return false;
        return true;
    });
}

/// Somebody who moves on; false where there is no room.
class Traffic {
  public:
    Traffic(Scenario& scenario, std::uint64_t seed) : scenario_(scenario), random_(seed, 901), seed_(seed) {}

    double uniform(double low, double high) { return random_.uniform(low, high); }
    bool chance(double share) { return random_.uniform() < share; }

    bool add(const char* model, const Course& course) {
        if (!keepsClear(course, courses_)) return false;
        courses_.push_back(course);
        double until = kDuration;  // where it leaves the street it stays, far away
        while (until > 1.0 && std::abs(course.at(until).x() - kMiddle) > kMiddle - 5.0) until -= 0.5;
        const Eigen::Vector2d end = course.at(until);
        ObjectSpec object;
        object.model = model;
        object.variant = 1 + 1000 * seed_ + courses_.size();
        object.motion = Moving{{{0.0, course.from.x(), course.from.y()}, {until, end.x(), end.y()}}};
        scenario_.objects.push_back(std::move(object));
        return true;
    }

  private:
    Scenario& scenario_;
    Random random_;
    std::uint64_t seed_;
    std::vector<Course> courses_;
};

/// Those of one lane are equally fast, 3 to 14 s apart: there are gaps that are long enough and others that are not.
void fillLane(Traffic& traffic, double sign) {
    constexpr const char* kModels[] = {"sedan", "hatchback", "suv", "van", "cyclist"};
    const double speed = traffic.uniform(4.0, 8.0), d = -sign * traffic.uniform(1.5, 1.9);
    for (double ahead = traffic.uniform(-2.0, 6.0); ahead * speed < 180.0; ahead += traffic.uniform(3.0, 14.0)) {
        const char* model = kModels[static_cast<std::size_t>(traffic.uniform(0.0, 5.0 - 1e-9))];
        traffic.add(model, {{kMiddle - sign * ahead * speed, d}, {sign * speed, 0.0}, 2.4});
    }
}

void addPeople(Traffic& traffic) {
    for (int k = 0; k < 4; ++k) {  // along the sidewalks, not over the place where the robot waits
        const double sign = traffic.chance(0.5) ? 1.0 : -1.0, speed = traffic.uniform(0.7, 1.6);
        const double d = traffic.chance(0.7) ? traffic.uniform(4.2, 5.6) : -traffic.uniform(7.2, 7.8);
        traffic.add("pedestrian", {{kMiddle - sign * traffic.uniform(3.0, 40.0), d}, {sign * speed, 0.0}, 0.35});
    }
    for (int k = 0; k < 4; ++k) {  // across the street, straight or at an angle, at some time during the first minute
        const double sign = traffic.chance(0.5) ? 1.0 : -1.0, speed = traffic.uniform(0.8, 1.6);
        const double slant = traffic.uniform(-0.5, 0.5), start = traffic.uniform(0.0, 25.0);
        const Eigen::Vector2d velocity(speed * slant, sign * speed);
        Eigen::Vector2d kerb(kMiddle + traffic.uniform(-9.0, 9.0), -sign * 3.6);
        if (sign > 0.0 && std::abs(kerb.x() - kMiddle) < 2.0) kerb.x() += 4.0;  // where the robot waits
        const Eigen::Vector2d from = kerb - start * velocity;
        const double end = from.y() + kDuration * velocity.y();
        if (std::abs(from.y()) > 45.0 || std::abs(end) > 95.0) continue;
        traffic.add(k % 2 == 0 ? "pedestrian" : "tall_pedestrian", {from, velocity, 0.35});
    }
}

void furnish(Scenario& scenario, Traffic& traffic) {
    for (const double side : {-1.0, 1.0}) {
        for (double s = kMiddle - 60.0; s < kMiddle + 60.0; s += traffic.uniform(6.0, 14.0)) {
            if (std::abs(s - kMiddle) < 4.0) continue;
            ClutterSpec thing;
            thing.kind = traffic.chance(0.5) ? ClutterKind::Tree : ClutterKind::Pole;
            thing.from = s, thing.d = side * traffic.uniform(8.2, 9.0);
            thing.width = thing.kind == ClutterKind::Tree ? 3.0 : 0.15;
            thing.height = traffic.uniform(4.0, 7.0);
            thing.variant = static_cast<std::uint64_t>(traffic.uniform(1.0, 1e6));
            scenario.clutter.push_back(thing);
        }
    }
}

}  // namespace

Scenario crossingScene(std::uint64_t seed) {
    Scenario scenario;
    scenario.duration = kDuration;
    scenario.track.width = 2.0 * kRoadEdge;
    scenario.track.segments = {{2.0 * kMiddle, 0.0}};
    scenario.terrain.reach = 110.0;
    scenario.terrain.cell = 5.0;
    scenario.terrain.beside = Material::Concrete;
    scenario.sensor.pose.position.z() = 1.0;
    scenario.ego.waypoints = {{0.0, kMiddle, kStart}, {kDuration, kMiddle, kStart + 0.5}};  // it looks across
    Traffic traffic(scenario, seed);
    for (const double sign : {-1.0, 1.0}) fillLane(traffic, sign);
    addPeople(traffic);
    furnish(scenario, traffic);
    return scenario;
}

}  // namespace lidar_obstacles::examples
