// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a tracker remembers, and the steps of one scan.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "sequence/track.h"
#include "sequence/track_assignment.h"
#include "sequence/track_cost.h"
#include "sequence/track_rays.h"

namespace lidar_obstacles {

/// The vehicle's pose when the laser saw what it saw at `time` [s]: the frame of these returns.
inline Eigen::Isometry3d frameAt(const TrackingScan& scan, double time) {
    return scan.pose_at ? scan.pose_at(time) : scan.T_world_vehicle;
}

struct Tracker::Memory {
    explicit Memory(const TrackingParams& p) : params(p) {}

    void forget() { tracks.clear(); }
    void breakIfNeeded(const TrackingScan& scan);
    void place(const TrackingScan& scan);
    void associate(const TrackingScan& scan);
    void takeIn(const TrackingScan& scan);
    std::array<bool, 2> endsOf(const FlatBox& body, const PlacedBox& box, const Track& track) const;
    void absorb();
    void absorbTracks(const FlatBox& body, bool is_person);
    void doubtUnseen(const TrackingScan& scan);
    void doubt(Track& track, const TrackingScan& scan);
    void beginNew(const TrackingScan& scan);
    void bury(const TrackingScan& scan);
    void report(const TrackingScan& scan);
    bool goesOn(double time, bool with_poses) const;
    void lookAhead(double time, const PoseAtTime& T_world_vehicle);

    TrackingParams params;
    std::vector<Track> tracks;
    std::vector<PlacedBox> boxes;
    std::vector<Expectation> expected;  ///< one per track
    std::vector<double> costs;
    std::vector<int> track_of_box;    ///< -1: none
    std::vector<unsigned char> part;  ///< boxes that lie within a larger track's
    Assignment assignment;
    BeamMap beams;
    std::vector<TrackedBox> rows;
    std::vector<ExpectedObject> ahead;
    int next_id = 0;
    std::optional<double> last_time;
    bool poses_known = true;
};

}  // namespace lidar_obstacles
