// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A lidar on a robot that goes where it likes, in a simulated world.
#pragma once

#include <mrpt/kinematics/CVehicleSimul_DiffDriven.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <deque>
#include <string>
#include <vector>

#include "lidar_obstacles/simulation/recording.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles::examples {

/// Moves the robot while the sensor turns, as both do in reality: the scan is taken from wherever the robot is at the
/// instant of each shot.
class SimulatedLidar {
  public:
    /// @param scenario  the robot is put where its vehicle starts.
    /// @throws simulation::ScenarioError
    SimulatedLidar(const simulation::Scenario& scenario, mrpt::kinematics::CVehicleSimul_DiffDriven& robot);

    /// The next turn, 0.1 s later.
    mrpt::obs::CObservationVelodyneScan::Ptr turn();
    /// Road users of the world as they are at a time of the robot's clock [s], as boxes in the world.
    std::vector<OrientedBox> boxesAt(double time) const;
    /// Of the robot, now: in the world, standing on its ground.
    const simulation::Pose6& pose() const { return poses_.back(); }

  private:
    void moveTo(double time);
    void note();

    simulation::World world_;
    mrpt::kinematics::CVehicleSimul_DiffDriven& robot_;
    std::deque<simulation::Pose6> poses_;  ///< of the robot, one every kStep, the last at its present time
    std::size_t turn_ = 0;
};

/// Distance between two boxes seen from above [m]; 0 if they touch.
double clearance(const OrientedBox& a, const OrientedBox& b);

}  // namespace lidar_obstacles::examples
