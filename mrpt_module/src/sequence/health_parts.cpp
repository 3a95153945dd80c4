// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/health_parts.h"
#include "scan/median.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lidar_obstacles {
namespace {

constexpr int kSectors = 72;
constexpr double kSector = 2.0 * M_PI / kSectors;  ///< [rad]
constexpr double kMemory = 5.0;                    ///< what was usual fades so slowly [s]
constexpr double kLearning = 1.5;                  ///< nothing is missed before [s]
constexpr double kWindow = 1.0;                    ///< what is late [s]

int sectorOf(const Eigen::Vector3f& way) {
    const double azimuth = std::atan2(static_cast<double>(way.y()), static_cast<double>(way.x()));
    return std::clamp(static_cast<int>(std::floor((azimuth + M_PI) / kSector)), 0, kSectors - 1);
}

/// Goes on to what is usual: quickly at first, not at all while it is missing.
void learn(Share& share, double watched, double dt, bool is_missing) {
    if (is_missing) return;
    const double weight = dt <= 0.0 ? 1.0 : std::min(1.0, dt / std::min(kMemory, watched + dt));
    share.usual += weight * (share.now - share.usual);
}

double middleOf(std::vector<double> values) { return values.empty() ? 0.0 : medianOf(values); }

/// How much of what is usual comes, in the middle of all parts.
double middleRatio(const std::vector<Share>& shares, double least) {
    std::vector<double> ratios;
    ratios.reserve(shares.size());
    for (const Share& s : shares)
        if (s.usual >= least) ratios.push_back(s.ratio());
    return middleOf(ratios);
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

using TimedNormals = std::deque<std::pair<double, Eigen::Vector3d>>;

Eigen::Vector3d meanOf(const TimedNormals::const_iterator& from, const TimedNormals::const_iterator& to) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (auto normal = from; normal != to; ++normal) sum += normal->second;
    return sum.normalized();
}

}  // namespace

void ReturnsWatch::count(const PointCloud& cloud) {
    for (Share& s : sectors_) s.now = 0.0;
    for (Share& s : rings_) s.now = 0.0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const Eigen::Vector3f way = cloud.xyz[i] - cloud.sensor_origin;
        if (way.z() < 0.0f) sectors_[sectorOf(way)].now += 1.0;
        if (i < cloud.ring.size() && cloud.ring[i] < rings_.size()) rings_[cloud.ring[i]].now += 1.0;
    }
}

void ReturnsWatch::update(const PointCloud& cloud, double dt, HealthReport& report) {
    const auto rings = static_cast<std::size_t>(cloud.ring.empty() ? 0 : cloud.view.rings);
    if (sectors_.empty() || rings != rings_.size()) {
        sectors_.assign(kSectors, {});
        rings_.assign(rings, {});
        watched_ = dt = 0.0;
    }
    count(cloud);
    judgeSectors(cloud.timestamp, report);
    judgeRings(cloud, report);
    for (Share& s : sectors_) learn(s, watched_, dt, watched_ > kLearning && s.ratio() < 0.3);
    for (Share& s : rings_) learn(s, watched_, dt, watched_ > kLearning && s.ratio() < 0.1);
    watched_ += dt;
}

/// The ground sends something back from every sector that is not blocked; the sky does not.
void ReturnsWatch::judgeSectors(double time, HealthReport& report) {
    constexpr double kLeast = 10.0;                            // returns, to miss any
    const bool goes_on = middleRatio(sectors_, kLeast) > 0.5;  // not the whole turn is gone
    for (int s = 0; s < kSectors; ++s) {
        Share& share = sectors_[s];
        const bool is_missing = watched_ > kLearning && goes_on && share.usual >= kLeast && share.ratio() < 0.1;
        if (!share.missing.update(is_missing, time)) continue;
        const double from = s * kSector - M_PI;
        if (!report.blocked.empty() && std::abs(report.blocked.back().to - from) < 1e-9)
            report.blocked.back().to = from + kSector;
        else
            report.blocked.push_back({from, from + kSector});
    }
    const bool wraps = report.blocked.size() > 1 && report.blocked.front().from < -M_PI + 1e-9 &&
                       report.blocked.back().to > M_PI - 1e-9;
    if (!wraps) return;
    report.blocked.back().to = report.blocked.front().to + 2.0 * M_PI;
    report.blocked.erase(report.blocked.begin());
}

/// The next rings of the same sensor that are not silent go on. Where they fall off too, the rings saw something that
/// is gone.
bool ReturnsWatch::neighboursGoOn(const PointCloud& cloud, int ring) const {
    const int first = cloud.firstRing(ring), end = cloud.endRing(ring);
    int found = 0;
    for (const int step : {-1, 1}) {
        int r = ring + step;
        while (r >= first && r < end && rings_[r].ratio() < 0.02) r += step;
        if (r < first || r >= end) continue;
        if (rings_[r].ratio() < 0.5) return false;
        ++found;
    }
    return found > 0;
}

void ReturnsWatch::judgeRings(const PointCloud& cloud, HealthReport& report) {
    constexpr double kLeast = 30.0;
    const bool goes_on = middleRatio(rings_, kLeast) > 0.5;
    for (std::size_t r = 0; r < rings_.size(); ++r) {
        Share& share = rings_[r];
        const bool is_silent = watched_ > kLearning && goes_on && share.usual >= kLeast && share.ratio() < 0.02 &&
                               neighboursGoOn(cloud, static_cast<int>(r));
        if (share.missing.update(is_silent, cloud.timestamp)) report.silent_rings.push_back(static_cast<int>(r));
    }
}

/// A mount that was hit turns at once and stays turned: a steady second, and just before it another normal. A ramp
/// comes slowly, a braking vehicle comes back.
void MountWatch::update(const GroundModel& ground, double time, HealthReport& report) {
    constexpr double kMost = 3.0 * M_PI / 180.0;    // not turned by less
    constexpr double kSteady = 0.8 * M_PI / 180.0;  // about the mean of a second
    constexpr double kBefore = 0.35;                // [s]
    if (ground.evidence != GroundEvidence::Good) return;
    normals_.emplace_back(time, ground.normal);
    while (time - normals_.front().first > kWindow + kBefore) normals_.pop_front();
    const auto first =
        std::find_if(normals_.begin(), normals_.end(), [&](const auto& n) { return time - n.first < kWindow; });
    const auto late = normals_.end() - first, earlier = first - normals_.begin();
    if (late < 4 || (earlier < 2 && !report.turned)) return;
    const Eigen::Vector3d mean = meanOf(first, normals_.end());
    if (!report.turned) before_ = meanOf(normals_.begin(), first);
    const double angle = angleBetween(mean, before_);
    const bool steady =
        std::all_of(first, normals_.end(), [&](const auto& n) { return angleBetween(n.second, mean) < kSteady; });
    report.turned = report.turned ? angle > 0.5 * kMost : angle > kMost && steady;
    report.turned_by = report.turned ? angle : 0.0;
}

void RateWatch::update(double dt, HealthReport& report) {
    constexpr std::size_t kFirst = 20;
    constexpr double kOff = 0.2;  // share
    if (dt <= 0.0) return;
    late_.push_back(dt);
    double sum = std::accumulate(late_.begin(), late_.end(), 0.0);
    while (late_.size() > 3 && sum - late_.front() >= kWindow) {
        sum -= late_.front();
        late_.pop_front();
    }
    const double middle = middleOf({late_.begin(), late_.end()});
    report.rate = 1.0 / middle;
    if (first_.size() < kFirst) {
        first_.push_back(dt);
        if (first_.size() < kFirst) return;
        const double usual = middleOf(first_);
        const auto off =
            std::count_if(first_.begin(), first_.end(), [&](double t) { return std::abs(t - usual) > kOff * usual; });
        if (off <= 2) report.usual_rate = 1.0 / usual;
    }
    report.wrong_rate = report.usual_rate > 0.0 && std::abs(report.rate / report.usual_rate - 1.0) > kOff;
}

void PoseWatch::update(const SequenceResult& found, double dt, HealthReport& report) {
    const bool matched = !found.match || found.match->state != MatchState::Lost;
    const bool is_known = matched && (found.pose == PoseFound::At || found.pose == PoseFound::Extrapolated);
    known_ += is_known ? dt : 0.0;
    report.poses_lost = lost_.update(known_ > kWindow && !is_known, found.cloud.timestamp);
}

}  // namespace lidar_obstacles
