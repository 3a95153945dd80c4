// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/scan_matching.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "sequence/match_points.h"
#include "sequence/scan_alignment.h"
#include "sequence/surface_map.h"

namespace lidar_obstacles {

const char* toString(MatchState state) {
    switch (state) {
        case MatchState::First:
            return "first";
        case MatchState::Matched:
            return "matched";
        case MatchState::Bridged:
            return "bridged";
        case MatchState::Lost:
            break;
    }
    return "lost";
}

namespace {

enum class Use : std::uint8_t { Nothing, Ground, Standing };

/// Of what a scan says across the road, how much it must say along it: else one car that drives ahead between two walls
/// would be enough to say that the vehicle stands.
constexpr double kLeastShare = 0.05;
constexpr double kLeastShareAtStart = 0.2;             ///< the same where no earlier motion speaks against it
constexpr float kApart = 0.5f, kApartAtStart = 0.15f;  ///< of the points on a ring [m]: one scan is no dense map
constexpr double kLeastFit = 0.25;  ///< share of the returns that fit the map; a scan that fits worse is lost

StampedPose stamped(double time, const Eigen::Isometry3d& pose) {
    StampedPose p;
    p.time = time;
    p.position = pose.translation();
    p.orientation = Eigen::Quaterniond(pose.linear());
    return p;
}

void insert(SurfaceMap& map, const std::vector<Eigen::Vector3f>& straight, const std::vector<Use>& use,
            const Eigen::Isometry3d& pose) {
    map.begin();
    for (std::size_t k = 0; k < straight.size(); ++k) {
        const Eigen::Vector3d q = pose * straight[k].cast<double>();
        if (use[k] == Use::Ground) map.addGround(q);
        if (use[k] == Use::Standing) map.addStanding(q);
    }
    map.finish();
}

/// How well each of several places agrees. All directions around the vehicle have the same say: a car that drives ahead
/// may be all that is sharp and near, but it is in one direction only.
std::vector<double> votesFor(const std::vector<Alignment>& places) {
    std::vector<double> votes(places.size(), 0.0);
    for (std::size_t d = 0; d < places.front().agreement.size(); ++d) {
        double most = 1e-9;
        for (const Alignment& a : places) most = std::max(most, a.agreement[d]);
        for (std::size_t k = 0; k < places.size(); ++k) votes[k] += places[k].agreement[d] / most;
    }
    return votes;
}

/// What the scan says of the place along the direction that is known least.
struct Weakest {
    Weakest(const Alignment& a, double least_share) {
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(a.information);
        direction = axes.eigenvectors().col(0);
        std = 1.0 / std::sqrt(std::max(axes.eigenvalues()[0], 1e-6));
        is_blind = axes.eigenvalues()[0] < least_share * axes.eigenvalues()[1];
    }

    Eigen::Vector2d direction;
    double std = 0.0;  ///< [m]
    bool is_blind = false;
};

}  // namespace

class ScanMatcher::Memory {
  public:
    Memory(const EgoParams& ego, const std::string& own_body) : ego_(ego), own_body_(own_body) {}

    ScanMatch match(const PointCloud& cloud);
    void learn(const GroundModel& ground, const std::vector<std::int32_t>& left_out);
    void restart();

  private:
    bool isLost(const Alignment& a, const Twist& motion) const;
    void second(ScanMatch& result);
    void next(ScanMatch& result);
    Alignment layOnFirst(const Twist& motion);
    std::optional<Twist> bestStart();
    bool tellsTooLittle();

    EgoParams ego_;
    OwnBody own_body_;
    SurfaceMap map_;
    MatchPoints scan_;                       ///< matched last
    std::vector<Eigen::Vector3f> straight_;  ///< its points
    std::vector<Use> use_;                   ///< of each of them
    MatchPoints first_;                      ///< of the start, until the second one is laid on it
    std::vector<Use> first_use_;
    bool has_first_ = false, has_map_ = false;
    double last_time_ = 0.0;  ///< of the scan learnt last [s]
    Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
    Twist twist_;
    double last_seen_ = 0.0;  ///< when all directions were told last [s]
};

ScanMatch ScanMatcher::Memory::match(const PointCloud& cloud) {
    scan_ = matchPoints(cloud, own_body_, has_map_ ? kApart : kApartAtStart);
    ScanMatch result;
    const double seconds = scan_.time - last_time_;
    if (has_first_ && (seconds <= 0.0 || seconds > ego_.max_gap)) {
        restart();
        result.restarted = true;
        scan_ = matchPoints(cloud, own_body_, kApartAtStart);
    }
    if (scan_.points.empty())
        result.state = MatchState::Lost;
    else if (has_map_)
        next(result);
    else if (has_first_)
        second(result);
    if (result.state == MatchState::Lost) {
        result.restarted = result.restarted || has_map_;
        if (has_map_) scan_ = matchPoints(cloud, own_body_, kApartAtStart);  // the next one is laid on it
        restart();
    }
    return result;
}

bool ScanMatcher::Memory::isLost(const Alignment& a, const Twist& motion) const {
    constexpr double kDegree = M_PI / 180.0;
    return a.fit < kLeastFit || motion.speed.norm() > ego_.max_speed ||
           motion.turn.norm() > ego_.max_turn_deg * kDegree;
}

/// Makes a map of the first scan alone, as it is if the vehicle moved like that, and lays this one onto it.
Alignment ScanMatcher::Memory::layOnFirst(const Twist& motion) {
    straighten(first_, motion, straight_);
    map_.clear();
    insert(map_, straight_, first_use_, Eigen::Isometry3d::Identity());
    straighten(scan_, motion, straight_);
    ExpectedMove expected;
    expected.T_world_vehicle = moved(motion, scan_.time - last_time_);
    expected.place_std = 1.0;
    expected.turn_std = 0.05;
    expected.reach = 0.3;
    expected.every = 3;
    return align(map_, scan_, straight_, expected);
}

/// Nothing is known of the speed: the one by which the two scans agree best, if no other one comes near to that.
std::optional<Twist> ScanMatcher::Memory::bestStart() {
    const double seconds = scan_.time - last_time_;
    constexpr double kStep = 0.4;     // from one guess to the next [m]
    constexpr double kBack = 10.0;    // as fast as that backwards [m/s]
    constexpr double kSame = 0.4;     // guesses that end so near to each other are one [m]
    constexpr double kClearly = 1.1;  // better than any other
    std::vector<Alignment> tried;
    for (double way = -kBack * seconds; way < ego_.max_speed * seconds; way += kStep) {
        Twist guess;
        guess.speed.x() = way / seconds;
        tried.push_back(layOnFirst(guess));
    }
    const std::vector<double> votes = votesFor(tried);
    const auto best = static_cast<std::size_t>(std::max_element(votes.begin(), votes.end()) - votes.begin());
    for (std::size_t k = 0; k < tried.size(); ++k) {
        const Eigen::Vector3d way = tried[k].T_world_vehicle.translation() - tried[best].T_world_vehicle.translation();
        if (way.norm() > kSame && kClearly * votes[k] > votes[best]) return std::nullopt;
    }
    return twistBetween(Eigen::Isometry3d::Identity(), tried[best].T_world_vehicle, seconds);
}

/// True where no search for the speed can end well. The first scan laid onto itself shows what its surfaces tell.
bool ScanMatcher::Memory::tellsTooLittle() {
    straighten(first_, {}, straight_);
    map_.clear();
    insert(map_, straight_, first_use_, Eigen::Isometry3d::Identity());
    return Weakest(align(map_, first_, straight_, {}), kLeastShareAtStart).is_blind;
}

void ScanMatcher::Memory::second(ScanMatch& result) {
    const double seconds = scan_.time - last_time_;
    result.state = MatchState::Lost;
    if (tellsTooLittle()) return;
    const std::optional<Twist> guess = bestStart();
    if (!guess) return;
    // once more, with both scans straightened by what was found
    const Twist better = twistBetween(Eigen::Isometry3d::Identity(), layOnFirst(*guess).T_world_vehicle, seconds);
    const Alignment a = layOnFirst(better);
    const Twist motion = twistBetween(Eigen::Isometry3d::Identity(), a.T_world_vehicle, seconds);
    const Weakest weakest(a, kLeastShareAtStart);
    if (isLost(a, motion) || weakest.is_blind) return;
    twist_ = motion;
    pose_ = a.T_world_vehicle;
    last_seen_ = scan_.time;
    result.state = MatchState::Matched;
    result.residual = a.residual;
    result.overlap = a.overlap;
    result.weakest = weakest.std;
    result.poses = {stamped(last_time_, Eigen::Isometry3d::Identity()), stamped(scan_.time, pose_)};
    has_map_ = true;
}

void ScanMatcher::Memory::next(ScanMatch& result) {
    const double seconds = scan_.time - last_time_;
    // wheels stay on the ground: nothing rises, and a pitch does not go on
    twist_.speed.z() = 0.0;
    twist_.turn.head<2>().setZero();
    straighten(scan_, twist_, straight_);
    constexpr double kAcceleration = 8.0, kTurning = 2.0;  // as hard as a car brakes [m/s^2] and swerves [rad/s^2]
    ExpectedMove expected;
    expected.T_world_vehicle = pose_ * moved(twist_, seconds);
    expected.place_std = kAcceleration * seconds * seconds;
    expected.turn_std = kTurning * seconds * seconds;
    expected.reach = expected.place_std;
    Alignment a = align(map_, scan_, straight_, expected);
    const Weakest weakest(a, kLeastShare);
    if (weakest.is_blind) {
        expected.held = weakest.direction;
        a = align(map_, scan_, straight_, expected);
    } else {
        last_seen_ = scan_.time;
    }
    const Twist motion = twistBetween(pose_, a.T_world_vehicle, seconds);
    const bool lost = isLost(a, motion) || scan_.time - last_seen_ > ego_.max_gap;
    result.state = lost ? MatchState::Lost : weakest.is_blind ? MatchState::Bridged : MatchState::Matched;
    result.residual = a.residual;
    result.overlap = a.overlap;
    result.weakest = weakest.std;
    if (lost) return;
    twist_ = motion;
    pose_ = a.T_world_vehicle;
    result.poses = {stamped(scan_.time, pose_)};
}

void ScanMatcher::Memory::learn(const GroundModel& ground, const std::vector<std::int32_t>& left_out) {
    if (scan_.points.empty()) return;
    constexpr float kStands = 0.3f;  // clearly above the ground [m]
    std::vector<char> out(ground.is_ground.size(), 0);
    for (const std::int32_t i : left_out) out[static_cast<std::size_t>(i)] = 1;
    use_.clear();
    for (const MatchPoint& m : scan_.points) {
        const auto i = static_cast<std::size_t>(m.index);
        const Use use = ground.is_ground[i] != 0     ? Use::Ground
                        : ground.height[i] > kStands ? Use::Standing
                                                     : Use::Nothing;
        use_.push_back(out[i] != 0 ? Use::Nothing : use);
    }
    if (has_map_) {
        straighten(scan_, twist_, straight_);
        insert(map_, straight_, use_, pose_);
    } else {
        std::swap(first_, scan_);
        std::swap(first_use_, use_);
        has_first_ = true;
    }
    last_time_ = has_map_ ? scan_.time : first_.time;
}

void ScanMatcher::Memory::restart() {
    has_first_ = has_map_ = false;
    map_.clear();
}

ScanMatcher::ScanMatcher(const EgoParams& ego, const std::string& own_body)
    : memory_(std::make_unique<Memory>(ego, own_body)) {}
ScanMatcher::~ScanMatcher() = default;
ScanMatcher::ScanMatcher(ScanMatcher&&) noexcept = default;
ScanMatcher& ScanMatcher::operator=(ScanMatcher&&) noexcept = default;
ScanMatch ScanMatcher::match(const PointCloud& cloud) { return memory_->match(cloud); }
void ScanMatcher::learn(const GroundModel& ground, const std::vector<std::int32_t>& left_out) {
    memory_->learn(ground, left_out);
}
void ScanMatcher::restart() { memory_->restart(); }

}  // namespace lidar_obstacles
