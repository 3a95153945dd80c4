// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A small robot crosses simulated streets: it waits for a gap, goes, and lets people pass.
///
///     scan -> toPointCloud -> ObstacleDetector (tracks) -> ZoneMonitor -> planSpeed -> wheels
#include <mrpt/kinematics/CVehicleSimul_DiffDriven.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <vector>

#include "crossing_planner.h"
#include "crossing_scene.h"
#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/simulation/truth.h"
#include "simulated_lidar.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::examples;

struct Options {
    int scenes = 1;
    std::uint64_t first = 1;
    bool steps = false;  ///< prints each step
};

struct Outcome {
    bool reached = false;
    double time = 0.0;                                         ///< [s]
    double nearest = std::numeric_limits<double>::infinity();  ///< while it moved [m]
    double nearest_standing = nearest;                         ///< while it stood [m]: others come as near as they like
};

class Crossing {
  public:
    explicit Crossing(std::uint64_t seed)
        : lidar_(crossingScene(seed), wheels_), detector_(params()), zones_(crossingZones(body_), params().region) {
        addPose();
    }

    Outcome run(bool print) {
        Outcome outcome;
        while (wheels_.getTime() < kDuration - 1.0 && !outcome.reached) {
            const SequenceResult found = detector_.process(toPointCloud(*lidar_.turn(), params().sensor));
            addPose();
            zones_.update({found, detector_.trajectory(), nullptr, std::nullopt});
            const PlannedSpeed planned = planSpeed(body_, state(), found.detection.obstacles, zones_);
            drive(planned.speed);
            note(outcome);
            outcome.reached = state().to_goal < 0.2;
            if (print) this->print(planned, outcome);
        }
        outcome.time = wheels_.getTime();
        return outcome;
    }

  private:
    static DetectorParams params() {
        DetectorParams params;
        params.low.enabled = true;
        params.region.lateral = 60.0;
        params.region.own_body = "box(-0.45, 0.45, -0.3, 0.3)";
        params.tracking.stamp = TrackStamp::Scan;
        return params;
    }

    void addPose() {
        const Eigen::Isometry3d T = simulation::toIsometry(lidar_.pose());
        StampedPose pose;
        pose.time = simulation::kEpoch + wheels_.getTime();
        pose.position = T.translation();
        pose.orientation = Eigen::Quaterniond(T.linear());
        detector_.addPose(pose);
    }

    WayState state() const {
        const double y = lidar_.pose().position.y(), half = 0.5 * body_.length;
        return {speed_, -kRoadEdge - (y + half), kRoadEdge - (y - half), kGoal - y};
    }

    /// Along the way, at its middle.
    void drive(double aim) {
        const double change = 0.1 * body_.acceleration;
        speed_ += std::clamp(aim - speed_, -change, change);
        const simulation::Pose6& pose = lidar_.pose();
        const double off = pose.position.x() - kMiddle, turned = std::remainder(pose.yaw - M_PI_2, 2.0 * M_PI);
        wheels_.movementCommand(speed_, std::abs(speed_) < 0.05 ? 0.0 : std::clamp(0.5 * off - turned, -0.5, 0.5));
    }

    void note(Outcome& outcome) const {
        const simulation::Pose6& pose = lidar_.pose();
        const OrientedBox self{pose.position + Eigen::Vector3d(0, 0, 0.3), {body_.length, body_.width, 0.6}, pose.yaw};
        double& nearest = std::abs(speed_) < 0.05 ? outcome.nearest_standing : outcome.nearest;
        for (const OrientedBox& box : lidar_.boxesAt(wheels_.getTime()))
            nearest = std::min(nearest, clearance(self, box));
    }

    void print(const PlannedSpeed& planned, const Outcome& outcome) const {
        constexpr const char* kNames[] = {"go", "wait", "evade"};
        std::printf("%5.1f s  y %5.2f  %4.1f m/s  %-5s aims at %4.1f  zones", wheels_.getTime(),
                    lidar_.pose().position.y(), speed_, kNames[static_cast<int>(planned.choice)], planned.speed);
        for (std::size_t k = 0; k < zones_.reports().size(); ++k)
            std::printf(" %s:%s(%s)", zones_.set().zones[k].name.c_str(), toString(zones_.reports()[k].state),
                        toString(zones_.reports()[k].reason));
        std::printf("  nearest %.2f %.2f\n", outcome.nearest, outcome.nearest_standing);
    }

    RobotBody body_;
    mrpt::kinematics::CVehicleSimul_DiffDriven wheels_;
    SimulatedLidar lidar_;
    ObstacleDetector detector_;
    ZoneMonitor zones_;
    double speed_ = 0.0;
};

int run(const Options& options) {
    int reached = 0, touched = 0, touched_standing = 0;
    std::vector<double> nearest;
    for (int k = 0; k < options.scenes; ++k) {
        const std::uint64_t seed = options.first + static_cast<std::uint64_t>(k);
        const Outcome o = Crossing(seed).run(options.steps);
        std::printf("street %d: %s after %.1f s, nearest %.2f m, standing %.2f m\n", static_cast<int>(seed),
                    o.reached ? "crossed" : "NOT CROSSED", o.time, o.nearest, o.nearest_standing);
        std::fflush(stdout);
        reached += o.reached;
        touched += o.nearest <= 0.0;
        touched_standing += o.nearest_standing <= 0.0;
        nearest.push_back(o.nearest);
    }
    std::sort(nearest.begin(), nearest.end());
    std::printf(
        "%d of %d streets crossed; touched something while moving %d, was walked into while standing %d times; "
        "nearest %.2f m, median %.2f m\n",
        reached, options.scenes, touched, touched_standing, nearest.front(), nearest[nearest.size() / 2]);
    return reached == options.scenes && touched + touched_standing == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("A simulated robot crosses streets with moving cars and people by tracks and zones.",
                 "example-crossing");
    app.add_option("--scenes", options.scenes, "number of streets")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    app.add_option("--first", options.first, "seed of the first")->capture_default_str();
    app.add_flag("--steps", options.steps, "prints each step");
    CLI11_PARSE(app, argc, argv);
    try {
        return run(options);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "example-crossing: error: %s\n", e.what());
        return 1;
    }
}
