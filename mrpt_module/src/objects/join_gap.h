#pragma once

#include "lidar_obstacles/types.h"
#include "objects/footprint.h"

namespace lidar_obstacles {

/// The shortest way between the outlines of two components.
struct Gap {
    std::int32_t from = -1;  ///< return of the one component
    std::int32_t to = -1;    ///< of the other
    float length = 1e9f;     ///< [m]
};

Gap gapBetween(const Footprint& a, const Footprint& b);

/// A scan with a view, and its ground.
struct ScannedGround {
    const PointCloud& cloud;
    const GroundModel& ground;
};

/// Is nothing seen between two components that lie beside each other? ScannedGround that ended in the gap or never came
/// back do not part them; beams through it do, and so does something that stands before the most part of it.
///
/// @param may_be_hidden  what stands before the gap does not part them either.
bool nothingBetween(const ScannedGround& scan, const Gap& gap, bool may_be_hidden);

}  // namespace lidar_obstacles
