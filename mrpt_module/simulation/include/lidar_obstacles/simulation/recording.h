// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A run of a scenario, told as a recording tells it: MRPT's observations, and the truth beside them.
#pragma once

#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CObservationRobotPose.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "lidar_obstacles/simulation/labels.h"
#include "lidar_obstacles/simulation/truth.h"

namespace lidar_obstacles::simulation {

struct RunOptions {
    double from = 0.0;                                    ///< first turn that begins then or later [s]
    double to = std::numeric_limits<double>::infinity();  ///< last turn that ends then or earlier [s]
    int stride = 1;                                       ///< every k-th turn of those
    std::uint64_t seed = 1;                               ///< of all noise; the scene does not depend on it
    int threads = 0;                                      ///< 0: as many as there are cores
};

/// A scan and what is true about it: of several sensors, what all of them saw. `index` counts what is recorded, 0, 1, 2
/// ...
struct RecordedScan {
    std::size_t index = 0;
    mrpt::obs::CObservationVelodyneScan::Ptr observation;
    std::vector<mrpt::obs::CObservationVelodyneScan::Ptr> beside;  ///< of the scenario's further sensors
    std::string truth_rows, ego_row;
    ScanLabels labels;        ///< of the first sensor
    std::size_t objects = 0;  ///< with at least one return
    std::size_t returns = 0;
    double time = 0.0;  ///< of the first firing, since the start of the scenario [s]
};

/// The turns that a run records, in order; empty if the options leave none.
std::vector<Turn> turnsOf(const Scenario& scenario, const RunOptions& options);

/// Casts the turns on several threads and hands the scans over in order, on the caller's thread. What is handed over
/// does not depend on the number of threads.
void run(const World& world, const RunOptions& options, const std::function<void(const RecordedScan&)>& record);

/// The scan as 1206-byte packets of a VLP-16, strongest return; the calibration tells other elevations of the lasers.
/// @throws std::invalid_argument unless the sensor has 16 lasers.
mrpt::obs::CObservationVelodyneScan::Ptr toObservation(const LidarScan& scan, const SensorSpec& sensor);

/// Times of a clock of `period` that tick in [from, to) [s].
std::vector<double> ticks(double from, double to, double period);

/// The vehicle's pose as an RTK receiver with an inertial unit tells it, label "ego_rtk"; world frame.
mrpt::obs::CObservationRobotPose::Ptr rtkPose(const World& world, double time, std::uint64_t seed);

/// What wheel encoders make of a drive that begins at `start`: metres are a little too long, turns too, and both are
/// noisy, so the pose drifts. To be asked for rising times.
/// An object is for one thread at a time.
class WheelOdometry {
  public:
    WheelOdometry(const World& world, double start, std::uint64_t seed);

    /// Label "odometry"; the pose counts from where the drive began.
    mrpt::obs::CObservationOdometry::Ptr at(double time);

  private:
    const World& world_;
    double time_;
    std::uint64_t seed_;
    std::uint64_t steps_ = 0;
    mrpt::poses::CPose2D pose_;
};

}  // namespace lidar_obstacles::simulation
