// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "lidar_obstacles/beams.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"
#include "objects/follow_up.h"

namespace lidar_obstacles {

/// Did a beam pass below return i and go on behind it? The nearest ring below that brought something back tells: it
/// ended well behind the return, and not in front of it; and it passed where no belly of a vehicle could have been.
/// @param scan  with a view.
bool passedBelow(const SurfaceTops& scan, std::int32_t i);

/// Did beams pass below these returns in most of their columns? False without a view.
bool floats(const std::vector<std::int32_t>& points, const SurfaceTops& scan);

/// The lowest of these returns above the ground [m]; 1e9 of none.
float bottomOf(const std::vector<std::int32_t>& points, const GroundModel& ground);

/// Marks pieces that hang in the air above `gates.max_bottom`: beams were seen to pass below them. That no ring looked
/// lower, or that something nearer stopped the beams, proves nothing. Sets `bottom`, too.
void markHanging(std::vector<Cluster>& pieces, const SurfaceTops& scan, const GateParams& params);

/// The pieces that do not hang (markHanging).
/// @param rejected  gets what hangs, as Floating.
std::vector<Cluster> withoutOverhangs(std::vector<Cluster> pieces, const SurfaceTops& scan, const GateParams& params,
                                      std::vector<RejectedCluster>& rejected);

/// The chosen hypotheses by what they are, with their heights. Of fewer than `gates.min_points` returns it is not told
/// what they are: they are Unknown, and one or two alone are rejected, as is what no ring shows to be higher than the
/// ground, and what hangs, all of it.
/// @param beams  of the same scan.
Clusters sortGroups(const std::vector<Hypothesis>& tree, SurfaceTops& topOf, const Beams& beams,
                    const GateParams& params);

/// The paper's gates by themselves (Sec. III.A): what is considerably smaller or larger than a vehicle goes. What is no
/// larger than `person` is called a pedestrian, the rest vehicles.
Clusters gateBySize(std::vector<Cluster> components, SurfaceTops& topOf, const GateParams& params, double person);

}  // namespace lidar_obstacles
