// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The one place that knows Embree 3 (Debian 12) from Embree 4 (Debian 13); the build says which of them was found.
#pragma once

#if LIDAR_OBSTACLES_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace lidar_obstacles::simulation {

/// Looks for the nearest surface on the ray of `query` and writes it there; geomID stays invalid where there is none.
inline void intersect(RTCScene scene, RTCRayHit& query) {
#if LIDAR_OBSTACLES_EMBREE >= 4
    rtcIntersect1(scene, &query);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &query);
#endif
}

}  // namespace lidar_obstacles::simulation
