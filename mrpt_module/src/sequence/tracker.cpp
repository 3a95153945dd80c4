#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sequence/track.h"
#include "sequence/track_assignment.h"
#include "sequence/track_cost.h"
#include "sequence/track_rays.h"

namespace lidar_obstacles {
namespace {

constexpr double kMostExistence = 4.0;  ///< log-odds are kept below
constexpr double kHit = 1.5;            ///< log of how much likelier a box there is if the track is real
constexpr double kMiss = 1.2;           ///< ... and no box where beams should have hit it, if it is not
constexpr double kGivenUp = -1.0;
constexpr double kBelieved = 0.0;

/// Log-odds that a box is something: of what is said of it, within limits, as one look is no proof.
double birthOf(const SeenBox& box) {
    const double none = box.classes[static_cast<std::size_t>(ObstacleClass::Unknown)];
    return std::clamp(std::log((1.0 - none) / std::max(1e-3, none)), -0.5, 2.0);
}

void requireFinite(const TrackingScan& scan) {
    const auto fail = [](const std::string& what) { throw std::invalid_argument("tracking: " + what); };
    if (!std::isfinite(scan.time)) fail("the time of the scan is not finite");
    if (!scan.T_world_vehicle.matrix().allFinite()) fail("the pose of the vehicle is not finite");
    for (std::size_t k = 0; k < scan.boxes.size(); ++k) {
        const SeenBox& b = scan.boxes[k];
        const std::string name = "box " + std::to_string(k);
        const bool finite = b.box.center.allFinite() && b.box.size.allFinite() && std::isfinite(b.box.yaw) &&
                            b.seen_box.center.allFinite() && b.seen_box.size.allFinite() &&
                            std::isfinite(b.seen_box.yaw) && std::isfinite(b.time) && std::isfinite(b.heading_std) &&
                            b.T_world_vehicle.matrix().allFinite();
        if (!finite) fail(name + " holds a number that is not finite");
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
    constexpr double kMinSize = 0.05;  // a box of one plane has no height, one of a line no width [m]
    SeenBox b;
    b.box = o.box;
    b.box.size = b.box.size.cwiseMax(kMinSize);
    b.seen_box = o.seen_box.size.x() > 0.0 ? o.seen_box : o.box;
    b.faces = o.faces;
    b.heading_valid = o.heading_valid;
    b.heading_std = o.heading_std;
    b.num_points = o.num_points;
    b.time = time;
    b.T_world_vehicle = T_world_vehicle;
    const bool told = *std::max_element(o.probability.begin(), o.probability.end()) > 0.0f;
    b.classes = told ? o.probability : classesOfLabel(o.cls, kLabelAlone);
    return b;
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
    double openTo(const Track& track, const TrackingScan& scan) const;
    void beginNew(const TrackingScan& scan);
    void bury(const TrackingScan& scan);
    void report(const TrackingScan& scan);

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
    int next_id = 0;
    std::optional<double> last_time;
    bool poses_known = true;
};

void Tracker::Memory::breakIfNeeded(const TrackingScan& scan) {
    const bool other_frame = last_time && scan.poses_known != poses_known;
    if (other_frame || (last_time && (scan.time <= *last_time || scan.time - *last_time > params.max_gap))) forget();
    last_time = scan.time;
    poses_known = scan.poses_known;
}

void Tracker::Memory::place(const TrackingScan& scan) {
    boxes.clear();
    for (const SeenBox& b : scan.boxes) boxes.push_back(placeBox(b, scan.sensor, params));
    expected.clear();
    const Eigen::Vector2d sensor =
        (scan.T_world_vehicle * Eigen::Vector3d(scan.sensor.x(), scan.sensor.y(), 0.0)).head<2>();
    for (const Track& t : tracks) expected.push_back(expect(t, scan.time + t.time_offset, sensor));
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
        if (!beams.empty()) box.ends = endsOf(expected[i].box.whole, box, t);
        t.take(box, box.source->time, params);
        t.time_offset = std::max(0.0, box.source->time - scan.time);
        t.existence = std::min(kMostExistence, t.existence + kHit);
    }
}

/// The axes of a body along which beams went through what goes on beyond the box that was seen.
std::array<bool, 2> Tracker::Memory::endsOf(const FlatBox& body, const PlacedBox& box, const Track& track) const {
    constexpr double kMuch = 0.4;    // [m]
    constexpr double kMargin = 0.1;  // [m]
    constexpr int kFewBeams = 3;
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
        const BeamCount c = beams.through(uprightOf(rest, track, box.source->T_world_vehicle));
        ends[face % 2] = c.passed >= kFewBeams && c.passed > 2 * c.hit;
    }
    return ends;
}

/// Boxes that no track took and that lie within a track's box are parts of it; tracks that no box fits and that lie
/// within one that was seen are as well. Not people: who stands close to something is not a part of it.
void Tracker::Memory::absorb() {
    for (const Track& whole : tracks) {
        if (whole.source < 0 || !whole.confirmed()) continue;
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
        if (mostlyWithin(t.flat(t.motion.position(), t.motion.yaw()), body)) t.absorbed = true;
    }
}

/// Share of a track that the laser must have seen if it were there: 1 nothing in the way, 0 nothing proven.
double Tracker::Memory::openTo(const Track& track, const TrackingScan& scan) const {
    if (track.absorbed) return 1.0;
    if (!beams.empty()) {
        constexpr int kFewBeams = 3;
        const BeamCount n = beams.through(rowOf(track, track.time, scan.T_world_vehicle).box);
        if (n.passed < kFewBeams) return 0.0;
        return static_cast<double>(n.passed) / n.all();
    }
    // without beams only other boxes tell what may hide it, and a detector may fail for reasons of its own
    constexpr double kOwnReasons = 0.25;
    return kOwnReasons * openShare(expected[static_cast<std::size_t>(&track - tracks.data())].box, boxes);
}

void Tracker::Memory::doubtUnseen(const TrackingScan& scan) {
    for (Track& t : tracks)
        if (t.source < 0) t.existence -= kMiss * openTo(t, scan);
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
            row.box = seen.box;
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
    requireFinite(scan);
    Memory& m = *memory_;
    m.breakIfNeeded(scan);
    m.place(scan);
    m.beams.look(scan.cloud);
    m.associate(scan);
    m.absorb();
    m.doubtUnseen(scan);
    m.beginNew(scan);
    m.bury(scan);
    m.report(scan);
    return m.rows;
}

int Tracker::takeNumber() { return memory_->next_id++; }

}  // namespace lidar_obstacles
