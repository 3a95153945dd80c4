// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "lidar_obstacles/completion.h"
#include "sequence/tracker_memory.h"

namespace lidar_obstacles {
namespace {

constexpr double kMostExistence = 4.0;  ///< log-odds are kept below
constexpr double kHit = 1.5;            ///< log of how much likelier a box there is if the track is real
constexpr double kGivenUp = -1.0;
constexpr double kBelieved = 0.0;

/// Log-odds that a box is something: of what is said of it, within limits, as one look is no proof.
double birthOf(const SeenBox& box) {
    const double none = box.classes[static_cast<std::size_t>(ObstacleClass::Unknown)];
    return std::clamp(std::log((1.0 - none) / std::max(1e-3, none)), -0.5, 2.0);
}

/// Is it a place or size in this world? False of numbers that are not finite.
bool isOnEarth(const Eigen::Vector3d& metres) {
    constexpr double kFarthest = 1e8;
    return metres.cwiseAbs().maxCoeff() <= kFarthest && metres.allFinite();
}

void requireUsable(const TrackingScan& scan) {
    constexpr double kLongestTurn = 10.0;
    const auto fail = [](const std::string& what) { throw std::invalid_argument("tracking: " + what); };
    if (!std::isfinite(scan.time)) fail("the time of the scan is not finite");
    if (!scan.T_world_vehicle.matrix().allFinite()) fail("the pose of the vehicle is not finite");
    if (!isOnEarth(scan.T_world_vehicle.translation())) fail("the vehicle is farther away than 1e8 m");
    if (!scan.is_structure.empty() && (scan.cloud == nullptr || scan.is_structure.size() != scan.cloud->size()))
        fail("is_structure has not one label per return of the cloud");
    for (std::size_t k = 0; k < scan.boxes.size(); ++k) {
        const SeenBox& b = scan.boxes[k];
        const std::string name = "box " + std::to_string(k);
        const bool finite = b.box.center.allFinite() && b.box.size.allFinite() && std::isfinite(b.box.yaw) &&
                            b.seen_box.center.allFinite() && b.seen_box.size.allFinite() &&
                            std::isfinite(b.seen_box.yaw) && std::isfinite(b.time) && std::isfinite(b.heading_std) &&
                            b.T_world_vehicle.matrix().allFinite();
        if (!finite) fail(name + " holds a number that is not finite");
        if (!isOnEarth(b.box.center) || !isOnEarth(b.box.size) || !isOnEarth(b.seen_box.center) ||
            !isOnEarth(b.seen_box.size) || !isOnEarth(b.T_world_vehicle.translation()))
            fail(name + " is larger or farther away than 1e8 m");
        if (std::abs(b.time - scan.time) > kLongestTurn)
            fail(name + " was seen more than 10 s from the time of the scan");
        if (b.box.size.minCoeff() <= 0.0 || b.seen_box.size.minCoeff() < 0.0)
            fail(name + " has a size that is not above 0");
    }
}

}  // namespace

ClassProbabilities classesOfLabel(ObstacleClass label, double probability) {
    ClassProbabilities classes{};
    const bool named = label != ObstacleClass::Unknown;
    const double others = static_cast<double>(classes.size()) - (named ? 2.0 : 1.0);
    const double rest = 1.0 - probability;
    classes.fill(static_cast<float>(named ? 0.5 * rest / others : rest / others));
    if (named) classes[static_cast<std::size_t>(ObstacleClass::Unknown)] = static_cast<float>(0.5 * rest);
    classes[static_cast<std::size_t>(label)] = static_cast<float>(probability);
    return classes;
}

SeenBox seenBox(const Obstacle& o, double time, const Eigen::Isometry3d& T_world_vehicle) {
    constexpr double kLabelAlone = 0.6;
    constexpr double kMinSize = 0.05;  // a box of one ring has no height, one of a line no width [m]
    SeenBox b;
    b.box = o.box;
    b.seen_box = o.seen_box.size.x() > 0.0 ? o.seen_box : o.box;
    b.box = withHeight(b.box, b.seen_box.size.z());  // of its returns: beams that pass above them prove nothing
    b.box.size = b.box.size.cwiseMax(kMinSize);
    b.faces = o.faces;
    b.heading_valid = o.heading_valid;
    b.heading_std = o.heading_std;
    b.num_points = o.num_points;
    b.num_rings = o.num_rings;
    b.time = time;
    b.T_world_vehicle = T_world_vehicle;
    const bool told = *std::max_element(o.probability.begin(), o.probability.end()) > 0.0f;
    b.classes = told ? o.probability : classesOfLabel(o.cls, kLabelAlone);
    return b;
}

void Tracker::Memory::breakIfNeeded(const TrackingScan& scan) {
    if (!goesOn(scan.time, scan.poses_known)) forget();
    last_time = scan.time;
    poses_known = scan.poses_known;
}

bool Tracker::Memory::goesOn(double time, bool with_poses) const {
    return !last_time || (with_poses == poses_known && time > *last_time && time - *last_time <= params.max_gap);
}

void Tracker::Memory::lookAhead(double time, const PoseAtTime& T_world_vehicle) {
    for (const Track& t : tracks) {
        if (!t.confirmed() || t.existence < kBelieved || !isRoadUser(t.cls.best())) continue;
        const double at = time + t.time_offset;
        const double std = std::sqrt(t.predicted(at).covariance().topLeftCorner<2, 2>().trace());
        ahead.push_back({rowOf(t, at, T_world_vehicle(at)).box, std, t.cls.probabilities()});
    }
}

void Tracker::Memory::place(const TrackingScan& scan) {
    boxes.clear();
    for (const SeenBox& b : scan.boxes) boxes.push_back(placeBox(b, b.sensor.value_or(scan.sensor), params));
    expected.clear();
    const Eigen::Vector3d sensor(scan.sensor.x(), scan.sensor.y(), 0.0);
    for (const Track& t : tracks) {
        const double at = scan.time + t.time_offset;
        expected.push_back(expect(t, at, (frameAt(scan, at) * sensor).head<2>()));
    }
}

void Tracker::Memory::associate(const TrackingScan& scan) {
    costs.assign(tracks.size() * boxes.size(), kCostLimit);
    for (std::size_t i = 0; i < tracks.size(); ++i)
        for (std::size_t j = 0; j < boxes.size(); ++j)
            costs[i * boxes.size() + j] = costOf(tracks[i], expected[i], boxes[j], params);
    const std::vector<int>& box_of = assignment.solve(costs, tracks.size(), boxes.size(), kCostLimit);
    track_of_box.assign(boxes.size(), -1);
    part.assign(boxes.size(), 0);
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        tracks[i].source = box_of[i];
        tracks[i].absorbed = false;
        if (box_of[i] >= 0) track_of_box[static_cast<std::size_t>(box_of[i])] = static_cast<int>(i);
    }
    takeIn(scan);
}

void Tracker::Memory::takeIn(const TrackingScan& scan) {
    for (std::size_t i = 0; i < tracks.size(); ++i) {
        Track& t = tracks[i];
        if (t.source < 0) {
            t.goOn(expected[i].at);
            continue;
        }
        PlacedBox& box = boxes[static_cast<std::size_t>(t.source)];
        if (!beams.empty()) box.ends = endsOf(bodyAt(expected[i], box.source->time), box, t);
        t.take(box, params, scan.poses_known);
        t.time_offset = std::max(0.0, box.source->time - scan.time);
        t.existence = std::min(kMostExistence, t.existence + kHit);
    }
}

void Tracker::Memory::beginNew(const TrackingScan& scan) {
    for (std::size_t j = 0; j < boxes.size(); ++j) {
        if (track_of_box[j] >= 0 || part[j] != 0) continue;
        track_of_box[j] = static_cast<int>(tracks.size());
        tracks.emplace_back();
        Track& t = tracks.back();
        t.begin(next_id++, boxes[j]);
        t.existence = birthOf(scan.boxes[j]);
        t.source = static_cast<int>(j);
        t.time_offset = std::max(0.0, boxes[j].source->time - scan.time);
    }
}

void Tracker::Memory::bury(const TrackingScan& scan) {
    constexpr double kLost = 3.0;  // a place known no better is none [m]
    const auto dead = [&](const Track& t) {
        if (t.source >= 0) return false;
        // what was seen but once or twice is not waited for as long as what is known well
        const double patience = std::min(params.max_hidden, 1.0 + t.last_seen - t.born);
        const double std = std::sqrt(t.motion.covariance().topLeftCorner<2, 2>().trace());
        return t.existence < kGivenUp || scan.time - t.last_seen > patience || std > kLost;
    };
    tracks.erase(std::remove_if(tracks.begin(), tracks.end(), dead), tracks.end());
}

void Tracker::Memory::report(const TrackingScan& scan) {
    rows.clear();
    for (std::size_t j = 0; j < boxes.size(); ++j) {
        if (track_of_box[j] < 0) continue;
        const auto found =
            std::find_if(tracks.begin(), tracks.end(), [&](const Track& t) { return t.source == static_cast<int>(j); });
        const Track& t = *found;
        const SeenBox& seen = *boxes[j].source;
        TrackedBox row =
            scan.told_for ? rowOf(t, *scan.told_for, scan.T_world_told) : rowOf(t, seen.time, seen.T_world_vehicle);
        // what was seen is told where it was seen, whatever the filter makes of it
        if (t.hits == 1 || standApart(boxes[j].seen, t.flat(t.motion.position(), t.motion.yaw()))) {
            row.box = scan.told_for ? movedBox(seen.box, scan.T_world_told.inverse() * seen.T_world_vehicle) : seen.box;
            row.heading_valid = seen.heading_valid;
        }
        rows.push_back(row);
    }
    for (const Track& t : tracks) {
        if (t.source >= 0 || !t.confirmed() || t.absorbed || t.existence < kBelieved) continue;
        rows.push_back(scan.told_for ? rowOf(t, *scan.told_for, scan.T_world_told)
                                     : rowOf(t, scan.time, scan.T_world_vehicle));
    }
    for (TrackedBox& row : rows) {
        row.state.time_offset -= scan.time;
        if (scan.poses_known) continue;
        row.state.velocity.reset();
        row.state.moving = false;
    }
}

Tracker::Tracker(const TrackingParams& params) : memory_(std::make_unique<Memory>(params)) {}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

void Tracker::forget() {
    memory_->forget();
    memory_->last_time.reset();
}

std::size_t Tracker::size() const { return memory_->tracks.size(); }

const std::vector<TrackedBox>& Tracker::update(const TrackingScan& scan) {
    requireUsable(scan);
    Memory& m = *memory_;
    m.breakIfNeeded(scan);
    m.place(scan);
    m.beams.look(scan.cloud, scan.is_structure.empty() ? nullptr : scan.is_structure.data());
    m.associate(scan);
    m.absorb();
    m.doubtUnseen(scan);
    m.beginNew(scan);
    m.bury(scan);
    m.report(scan);
    return m.rows;
}

const std::vector<ExpectedObject>& Tracker::expected(double time, bool poses_known, const PoseAtTime& T_world_vehicle) {
    memory_->ahead.clear();
    if (memory_->goesOn(time, poses_known)) memory_->lookAhead(time, T_world_vehicle);
    return memory_->ahead;
}

}  // namespace lidar_obstacles
