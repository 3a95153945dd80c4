// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The files obstacle-simulate writes.
#pragma once

#include <vector>

#include "common/text_file.h"
#include "lidar_obstacles/mrpt_bridge/rawlog_writer.h"
#include "lidar_obstacles/simulation/recording.h"
#include "options.h"

namespace lidar_obstacles::apps {

/// Rawlog and truth of one run. All functions throw std::runtime_error that names the file if something cannot be
/// written.
class Outputs {
  public:
    /// Makes the folder and the files; writes what does not depend on the scans.
    Outputs(const Options& options, const simulation::World& world);
    /// Takes the files away again unless finish() was reached.
    ~Outputs();
    Outputs(const Outputs&) = delete;
    Outputs& operator=(const Outputs&) = delete;

    /// One scan, after what the vehicle's own sensors told before it.
    void add(const simulation::RecordedScan& scan);
    /// What came after the last scan until `end` [s]; completes the files.
    void finish(double end);

  private:
    void addEgoSensors(double until);

    const Options& options_;
    const simulation::World& world_;
    simulation::WheelOdometry odometry_;
    double told_;  ///< the vehicle's sensors are written up to there [s]
    RawlogWriter rawlog_;
    TextFile truth_, ego_, statics_, labels_;
    bool finished_ = false;
};

}  // namespace lidar_obstacles::apps
