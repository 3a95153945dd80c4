#pragma once

#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

/// Follows surfaces upwards from their returns, plane by plane, as long as the next return of the same azimuth lies
/// right above; also beyond the height up to which returns are candidates. Each return is passed once, however many
/// start below it.
class SurfaceTops {
  public:
    SurfaceTops(const PointCloud& scan, const GroundModel& g) : cloud(scan), ground(g) {}

    /// Height above the ground that the surface at a return reaches [m]. Of a cloud with a view.
    float operator()(std::int32_t i);

    const PointCloud& cloud;
    const GroundModel& ground;

  private:
    std::vector<float> top_;  ///< of each return, as far as known; made when first asked
};

/// The stages of clustering.h that ask for it, with one memory, so that each surface is followed once.
std::vector<Cluster> splitFromTall(std::vector<Cluster> components, SurfaceTops& topOf, const DetectorParams& params);
Clusters gateClusters(std::vector<Cluster> components, SurfaceTops& topOf, const GateParams& params);

/// The pieces without those that hang in the air above `gates.max_bottom` with beams seen to pass below them.
std::vector<Cluster> withoutOverhangs(std::vector<Cluster> pieces, SurfaceTops& topOf, const GateParams& params,
                                      std::vector<RejectedCluster>& rejected);

/// The groups of the best cut by what they are; too few returns and what is no higher than the ground is rejected.
Clusters sortGroups(std::vector<Hypothesis>& tree, SurfaceTops& topOf, const GateParams& params);

/// The paper's gates by themselves (Sec. III.A): what is considerably smaller or larger than a vehicle goes.
Clusters gateBySize(std::vector<Cluster> components, SurfaceTops& topOf, const GateParams& params);

}  // namespace lidar_obstacles
