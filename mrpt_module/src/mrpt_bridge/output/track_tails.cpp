// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/track_tails.h"

#include <utility>

namespace lidar_obstacles {
namespace {

/// The frame that a track's box is in: the vehicle's when the laser saw it, unless that was undone.
Eigen::Isometry3d frameOf(const Obstacle& o, const SequenceResult& found, const Trajectory& trajectory) {
    const bool straightened = found.deskewing == Deskewing::Done;
    const double time = found.cloud.timestamp + (straightened ? 0.0 : o.track->time_offset);
    const auto pose = trajectory.rotationOnly() ? std::nullopt : trajectory.at(time).T_world_vehicle;
    return pose.value_or(Eigen::Isometry3d::Identity());
}

}  // namespace

void TrackTails::add(const SequenceResult& found, const Trajectory& trajectory) {
    const double time = found.cloud.timestamp;
    if (time <= last_time_ || found.restarted) ways_.clear();
    last_time_ = time;
    tails_.clear();
    std::map<int, std::deque<Place>> ways;  // of the tracks that are still there
    for (const Obstacle& o : found.detection.obstacles) {
        if (!o.track) continue;
        const Eigen::Isometry3d T_world_vehicle = frameOf(o, found, trajectory);
        std::deque<Place> way = std::move(ways_[o.id]);
        way.push_back({time, T_world_vehicle * o.box.center});
        while (way.front().time < time - seconds_) way.pop_front();
        if (way.size() > 1) {
            TrackTail tail{o.id, {}};
            const Eigen::Isometry3d T_vehicle_world = T_world_vehicle.inverse();
            for (const Place& p : way) tail.points.emplace_back(T_vehicle_world * p.at);
            tails_.push_back(std::move(tail));
        }
        ways[o.id] = std::move(way);
    }
    ways_ = std::move(ways);
}

}  // namespace lidar_obstacles
