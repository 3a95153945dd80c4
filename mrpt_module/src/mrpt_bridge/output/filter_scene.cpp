// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/filter_scene.h"

#include <mrpt/opengl/COctoMapVoxels.h>
#include <mrpt/opengl/CPointCloud.h>

namespace lidar_obstacles {

void addFilter(mrpt::opengl::COpenGLScene& scene, const SequenceResult& found, const ObstacleDetector& detector) {
    const auto centres = detector.filterVoxels();
    if (!centres.empty()) {
        auto voxels = mrpt::opengl::COctoMapVoxels::Create();
        voxels->setName("filter_voxels");
        voxels->resizeVoxelSets(1);
        voxels->reserveVoxels(0, centres.size());
        voxels->showGridLines(false);
        voxels->showVoxels(0, true);
        voxels->enableLights(false);
        const mrpt::img::TColor green(80, 180, 80, 90);
        for (const Eigen::Vector3f& c : centres) {
            voxels->push_back_Voxel(0, {mrpt::math::TPoint3Df(c.x(), c.y(), c.z()),
                                        static_cast<float>(detector.filterResolution()), green});
        }
        scene.insert(voxels);
    }
    if (found.detection.filtered.empty()) return;
    auto points = mrpt::opengl::CPointCloud::Create();
    points->setName("filtered");
    points->setPointSize(4.0f);
    points->setColor_u8(255, 60, 60, 255);
    for (const std::int32_t i : found.detection.filtered) {
        const Eigen::Vector3f& p = found.cloud.xyz[i];
        points->insertPoint(p.x(), p.y(), p.z());
    }
    scene.insert(points);
}

}  // namespace lidar_obstacles
