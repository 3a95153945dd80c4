// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A scene that is being drawn: dice, and things put where there is room for them.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lidar_obstacles/simulation/random.h"
#include "lidar_obstacles/simulation/scenario.h"
#include "lidar_obstacles/simulation/track.h"
#include "scene_site.h"

namespace lidar_obstacles::simulation {

/// A place along the track, and a yaw from its direction.
struct Spot {
    double s = 0.0, d = 0.0, yaw = 0.0;
};

/// A rectangle along the track.
struct Zone {
    double from, to;   ///< s
    double low, high;  ///< d
};

/// Names and how often each is drawn.
using Choices = std::vector<std::pair<std::string, double>>;

class SceneDraft {
  public:
    /// @param scenario  track, terrain, sensor, vehicle and duration; nothing else yet.
    SceneDraft(Scenario scenario, const Random& random);

    // Dice.
    double uniform(double low, double high) { return random_.uniform(low, high); }
    double logUniform(double low, double high);
    bool chance(double share) { return random_.uniform() < share; }
    int count(int low, int high);  ///< both included
    std::string choose(const Choices& choices);
    Spot spotIn(const Zone& zone);  ///< turned anyhow
    /// Beside something that was put there, close to one of its sides; nullopt-like default spot if there is nothing.
    Spot spotBeside();

    // Each puts a thing there unless it would come too near to another or leave the terrain; true if it did.
    bool stand(const std::string& model, const Spot& spot);
    bool move(const std::string& model, const std::vector<Waypoint>& path);
    /// At constant speed [m/s] straight in (s, d) from a place into the direction of its yaw.
    bool moveOn(const std::string& model, const Spot& from, double speed);
    bool put(ClutterSpec spec);

    double length() const { return track_->length(); }
    double halfWidth() const { return 0.5 * track_->width(); }
    double reach() const { return scenario_.terrain.reach - 6.0; }  ///< largest d of a thing
    double duration() const { return scenario_.duration; }
    const Waypoint& egoStart() const { return scenario_.ego.waypoints.front(); }
    double egoSpeed() const { return (scenario_.ego.waypoints.back().s - egoStart().s) / duration(); }  ///< [m/s]
    Scenario take() { return std::move(scenario_); }

  private:
    bool isInside(const std::vector<Room>& parts) const;
    bool claim(const std::vector<Room>& parts, double margin);
    bool addObject(ObjectSpec object, const Room& room);
    Room roomAlong(const std::vector<Waypoint>& path, const Eigen::Vector3d& size) const;
    Footprint footprintAt(const Spot& spot, const Eigen::Vector3d& size) const;
    std::vector<Room> roomOf(const ClutterSpec& spec) const;
    std::uint64_t newVariant();

    struct Edge {
        Spot spot;
        Eigen::Vector2d half;
    };

    Scenario scenario_;
    Random random_;
    std::shared_ptr<const Track> track_;
    Site site_;
    std::vector<Eigen::Vector2d> middle_line_;  ///< every other metre
    std::vector<Edge> edges_;                   ///< what one may stand beside
};

}  // namespace lidar_obstacles::simulation
