// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/testing/scenario.h"

#include <stdexcept>
#include <utility>

#include "lidar_obstacles/detector.h"
#include "lidar_obstacles/mrpt_bridge/ego_motion.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"

namespace lidar_obstacles::testing {
namespace {

constexpr double kPosePeriod = 0.05;  ///< of the simulated vehicle's poses [s]
constexpr double kScanAhead = 0.3;    ///< poses that are there before a scan reach so far beyond its beginning [s]

}  // namespace

RawlogResult detectScenario(const std::string& yaml, const ScenarioOptions& options) {
    const simulation::Scenario scenario = simulation::parseScenario(yaml, "scenario");
    if (simulation::turnsOf(scenario, options.run).empty()) {
        throw std::invalid_argument("detectScenario: the options leave no turn of the sensor");
    }
    const simulation::World world = simulation::buildWorld(scenario);
    ObstacleDetector detector(options.params);
    double told = options.run.from;
    RawlogResult result;
    simulation::run(world, options.run, [&](const simulation::RecordedScan& scan) {
        for (const double time : simulation::ticks(told, scan.time + kScanAhead, kPosePeriod)) {
            const auto pose = simulation::rtkPose(world, time, options.run.seed);
            detector.addPose(toStampedPose(mrpt::Clock::toDouble(pose->timestamp), pose->pose.mean));
        }
        told = scan.time + kScanAhead;
        auto cloud = toPointCloud(*scan.observation, options.params.sensor);
        const double timestamp = cloud.timestamp;
        result.push_back({scan.index, timestamp, detector.process(std::move(cloud)).detection.obstacles});
    });
    return result;
}

}  // namespace lidar_obstacles::testing
