// SPDX-License-Identifier: BSD-3-Clause
// A recording played in a loop through the detector with tracks, hour after hour, as fast as it goes: does memory grow?
// usage: lidar_obstacles_soak RECORDING HOURS
// Each round begins where the one before ended: stamps and poses go on. Prints a row for each tenth of the way; exit
// code 1 if the program grew after the first tenth.
#include <malloc.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/ego_motion.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"

namespace lidar_obstacles::bench {
namespace {

constexpr double kMayGrow = 1024.0;  // what the allocator may still take or give back [kB]

struct Round {
    std::vector<PointCloud> scans;
    std::vector<StampedPose> poses;
    double duration = 0.0;  ///< from its first scan to the first one of the next round [s]
};

Round load(const std::string& file) {
    Round round;
    const auto source = openScanSource(file);
    PoseFeed feed(*source, chooseEgoSource(file, EgoParams{}.source),
                  [&](const StampedPose& pose) { round.poses.push_back(pose); });
    while (const auto item = feed.next())
        if (item->observation && isLidarScan(*item->observation))
            round.scans.push_back(*toPointCloud(*item->observation, SensorParams{}));
    if (round.scans.size() < 2) throw std::runtime_error(file + ": fewer than two scans");
    const double span = round.scans.back().timestamp - round.scans.front().timestamp;
    round.duration = span * static_cast<double>(round.scans.size()) / static_cast<double>(round.scans.size() - 1);
    return round;
}

/// World of a round -> world of the next one: turned about z and moved, not tilted.
Eigen::Isometry3d stepOf(const Round& round) {
    Trajectory way;
    for (const StampedPose& pose : round.poses) way.add(pose);
    const double begin = round.scans.front().timestamp;
    const auto first = way.at(begin).T_world_vehicle, last = way.at(begin + round.duration).T_world_vehicle;
    if (!first || !last) return Eigen::Isometry3d::Identity();  // no poses, or one place
    const auto upright = [](const Eigen::Isometry3d& pose) {
        const Eigen::Vector3d ahead = pose.linear().col(0);
        return Eigen::Isometry3d(Eigen::Translation3d(pose.translation()) *
                                 Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ()));
    };
    return upright(*last) * upright(*first).inverse();
}

/// What the program holds at the moment [kB].
double residentKb() {
    malloc_trim(0);
    std::ifstream status("/proc/self/statm");
    double pages = 0.0;
    double resident = 0.0;
    status >> pages >> resident;
    return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1024.0;
}

/// The highest number of a track, and how many obstacles there are.
struct Seen {
    int highest = 0;
    std::size_t obstacles = 0;
};

class Soak {
  public:
    explicit Soak(const Round& round) : round_(round), step_(stepOf(round)), detector_(params()) {}

    void playOnce() {
        const auto moved = [&](StampedPose pose) {
            pose.time += offset_;
            pose.position = T_world_round_ * pose.position;
            pose.orientation = Eigen::Quaterniond(T_world_round_.linear()) * pose.orientation;
            return pose;
        };
        std::size_t next = 0;
        for (const PointCloud& scan : round_.scans) {
            while (next < round_.poses.size() && round_.poses[next].time < scan.timestamp + kLongestScan)
                detector_.addPose(moved(round_.poses[next++]));
            PointCloud cloud = scan;
            cloud.timestamp += offset_;
            count(detector_.process(std::move(cloud)));
        }
        offset_ += round_.duration;
        T_world_round_ = T_world_round_ * step_;
    }

    double seconds() const { return offset_; }
    const Seen& seen() const { return seen_; }

  private:
    static DetectorParams params() {
        DetectorParams p;
        p.tracking.enabled = true;
        return p;
    }
    void count(const SequenceResult& result) {
        seen_.obstacles = result.detection.obstacles.size();
        for (const Obstacle& o : result.detection.obstacles)
            if (o.track) seen_.highest = std::max(seen_.highest, o.id);
    }

    const Round& round_;
    Eigen::Isometry3d step_;
    ObstacleDetector detector_;
    double offset_ = 0.0;
    Eigen::Isometry3d T_world_round_ = Eigen::Isometry3d::Identity();
    Seen seen_;
};

int run(const std::string& file, double hours) {
    using Clock = std::chrono::steady_clock;
    const Round round = load(file);
    std::printf("%s: %zu scans, %zu poses, %.1f s a round\n", file.c_str(), round.scans.size(), round.poses.size(),
                round.duration);
    std::printf("%10s %12s %14s %10s %12s\n", "hours", "memory [MB]", "highest track", "obstacles", "times faster");
    Soak soak(round);
    const Clock::time_point start = Clock::now();
    double early = 0.0;
    double late = 0.0;
    for (int tenth = 1; tenth <= 10; ++tenth) {
        while (soak.seconds() < 360.0 * hours * tenth) soak.playOnce();
        late = residentKb();
        if (tenth == 1) early = late;
        const double passed = std::chrono::duration<double>(Clock::now() - start).count();
        std::printf("%10.2f %12.1f %14d %10zu %12.1f\n", soak.seconds() / 3600.0, late / 1024.0, soak.seen().highest,
                    soak.seen().obstacles, soak.seconds() / passed);
        std::fflush(stdout);
    }
    const bool grew = late > early + kMayGrow;
    std::printf("%s: %+.1f MB since the first tenth\n", grew ? "memory grows" : "memory is flat",
                (late - early) / 1024.0);
    return grew ? 1 : 0;
}

}  // namespace
}  // namespace lidar_obstacles::bench

int main(int argc, char** argv) {
    char* end = nullptr;
    const double hours = argc == 3 ? std::strtod(argv[2], &end) : 0.0;
    if (argc != 3 || *end != '\0' || !(hours > 0.0)) {
        std::fprintf(stderr, "usage: lidar_obstacles_soak RECORDING HOURS\n");
        return 2;
    }
    try {
        return lidar_obstacles::bench::run(argv[1], hours);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "lidar_obstacles_soak: error: %s\n", e.what());
        return 1;
    }
}
