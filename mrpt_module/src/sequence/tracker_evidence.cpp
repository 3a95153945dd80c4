// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "lidar_obstacles/object_models.h"
#include "sequence/tracker_memory.h"

namespace lidar_obstacles {
namespace {

constexpr double kMiss = 1.2;  ///< log of how much likelier no box where beams should have hit is, if the track is none
constexpr double kStructure = 0.8;  ///< how sure it is that what was taken for structure is that
constexpr int kFewBeams = 3;

/// The part of a box through which no beam goes where a body fills it: above its belly, below its windows.
OrientedBox trunkOf(OrientedBox box) {
    const double bottom = box.center.z() - 0.5 * box.size.z();
    const double low = std::min(kVehicleBelly, 0.3 * box.size.z());
    const double high = std::min(kVehicleWindows, 0.7 * box.size.z());
    box.center.z() = bottom + 0.5 * (low + high);
    box.size.z() = high - low;
    return box;
}

}  // namespace

/// The axes of a body along which beams went through what goes on beyond the box that was seen.
std::array<bool, 2> Tracker::Memory::endsOf(const FlatBox& body, const PlacedBox& box, const Track& track) const {
    constexpr double kMuch = 0.4;    // [m]
    constexpr double kMargin = 0.1;  // [m]
    constexpr double kBeside = 0.2;  // bodies are rounded, and so far off may a side be [m]
    const bool person = isPerson(track.cls.best());
    std::array<bool, 2> ends{};
    for (std::size_t face = 0; face < kFaces; ++face) {
        const auto k = static_cast<int>(face % 2);
        const Eigen::Vector2d n = body.axis(face);
        const double along = std::abs(n.dot(box.seen.axis(0)));
        const double seen_half =
            along * box.seen.half.x() + std::sqrt(std::max(0.0, 1.0 - along * along)) * box.seen.half.y();
        const double beyond = body.half[k] - n.dot(box.seen.center - body.center) - seen_half;
        if (beyond < kMuch || ends[face % 2]) continue;
        FlatBox rest = body;
        rest.center += (body.half[k] - 0.5 * (beyond - kMargin)) * n;
        rest.half[k] = 0.5 * (beyond - kMargin);
        if (!person) rest.half[1 - k] -= kBeside;
        if (rest.half[1 - k] <= 0.0) continue;
        const OrientedBox upright = uprightOf(rest, track, box.source->T_world_vehicle);
        const BeamCount c = beams.through(person ? upright : trunkOf(upright));
        ends[face % 2] = c.passed >= kFewBeams && c.passed > 2 * c.hit;
    }
    return ends;
}

/// Boxes that no track took and that lie within a track's box are parts of it; tracks that no box fits and that lie
/// within one that was seen are as well. What is structure or not known has no parts. Not people: who stands close to
/// something is not a part of it.
void Tracker::Memory::absorb() {
    for (const Track& whole : tracks) {
        if (whole.source < 0 || !whole.confirmed() || !isRoadUser(whole.cls.best())) continue;
        const FlatBox body = whole.flat(whole.motion.position(), whole.motion.yaw());
        for (std::size_t j = 0; j < boxes.size(); ++j) {
            if (track_of_box[j] >= 0 || part[j] != 0 || isPerson(topClass(boxes[j].source->classes))) continue;
            if (mostlyWithin(boxes[j].seen, body)) part[j] = 1;
        }
        absorbTracks(body, isPerson(whole.cls.best()));
    }
}

void Tracker::Memory::absorbTracks(const FlatBox& body, bool is_person) {
    for (Track& t : tracks) {
        if (t.source >= 0 || t.absorbed || (isPerson(t.cls.best()) && !is_person)) continue;
        const FlatBox unseen = t.flat(t.motion.position(), t.motion.yaw());
        const bool blurred = !isRoadUser(t.cls.best()) && mostlyWithin(body, unseen);
        if (blurred || mostlyWithin(unseen, body)) t.absorbed = true;
    }
}

/// What the beams say of a track that no box fits: is it there, and is what is there something else?
void Tracker::Memory::doubt(Track& track, const TrackingScan& scan) {
    if (track.absorbed) {
        track.existence -= kMiss;
        return;
    }
    if (beams.empty()) {
        // only other boxes tell what may hide it, and a detector may fail for reasons of its own
        constexpr double kOwnReasons = 0.25;
        const std::size_t k = static_cast<std::size_t>(&track - tracks.data());
        track.existence -= kMiss * kOwnReasons * openShare(expected[k].box, boxes);
        return;
    }
    static const ClassProbabilities structure = classesOfLabel(ObstacleClass::Structure, kStructure);
    const BeamCount n = beams.through(rowOf(track, track.time, frameAt(scan, track.time)).box);
    if (n.passed >= kFewBeams) track.existence -= kMiss * n.passed / n.all();
    if (n.other >= kFewBeams) track.look(structure, track.time, static_cast<double>(n.other) / n.all());
}

void Tracker::Memory::doubtUnseen(const TrackingScan& scan) {
    for (Track& t : tracks)
        if (t.source < 0) doubt(t, scan);
}

}  // namespace lidar_obstacles
