// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The sides of a vehicle that the sensor does not see.
#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// What the stage needs: `region.max_height`, above which returns are no obstacles, and the sizes of vehicles.
struct CompletionParams {
    RegionParams region;
    BoxParams box;
};

/// Grows vehicles with a heading to the usual size of their class (`box.completion = prior`): the faces turned to the
/// sensor stay where they are, the opposite ones move away from it, but not into space that a beam crossed between the
/// vehicle's belly and its windows, nor onto returns of anything else below `region.max_height`. A face beside which
/// something nearer hides the rest moves as well, both by as much where they can. Where the lowest ring hit a roof and
/// no more, all four move alike: the sides stand nearer than the roof, below the field of view. Vehicles, also those
/// without a heading, are told no lower than vehicles are: raiseVehicles(). `seen_box` keeps what was measured.
///
/// Sizes and beams say which axis is the length. Where they leave it open (a face that something hides in part), the
/// box takes the axis of the nearest vehicle within 12 m that stands along one of its axes and whose length is known;
/// without such a vehicle it stays as it was fitted. Without returns, nothing is known to be free.
///
/// Departs from the paper, whose boxes enclose what is seen (`none`).
std::vector<Obstacle> completeBoxes(std::vector<Obstacle> obstacles, const PointCloud& cloud, const GroundModel& ground,
                                    const CompletionParams& params);

/// The box with another height [m], its lower end where it was.
OrientedBox withHeight(OrientedBox box, double height);

/// Makes what is called a vehicle as high as vehicles are at least, kLeastVehicleHeight: of one far away a single ring
/// meets no more than the sill. Its lower end stays; the recognizer asked whether beams leave room for that.
void raiseVehicles(std::vector<Obstacle>& obstacles);

}  // namespace lidar_obstacles
