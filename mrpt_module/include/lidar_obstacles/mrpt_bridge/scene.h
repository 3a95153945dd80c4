// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// DetectionResult -> mrpt::opengl objects, and off-screen pictures of them. No window, no display needed.
#pragma once

#include <mrpt/img/CImage.h>
#include <mrpt/opengl/COpenGLScene.h>

#include <memory>

#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"

namespace mrpt::opengl {
class CFBORender;
}

namespace lidar_obstacles {

/// What a scene shows beside points, grid, boxes and headings.
struct SceneOptions {
    bool labels = true;        ///< class, id and distance above each box; of a track its speed and age
    bool explain = false;      ///< hull, corners, line or plane of each box, in its label what gave the heading; merges
    OwnBody own_body{};        ///< of the vehicle, drawn as `own_body`
    RegionParams region{};     ///< its outline and excluded places are drawn where it has any
    bool rejected = false;     ///< the returns of clusters that were sorted out, in magenta
    double grid_depth = 0.15;  ///< the grid lies this far below the ground, or it would cover the points on it [m]
};

/// A scene of one scan in the vehicle frame [m], with these objects (`getByName`):
///
/// * `ground`, `candidates`, `clustered`, `other`, `rejected`: points; ground brown, candidates by height from blue
///   to yellow, clustered ones in their obstacle's colour, others (too high, outside the region) grey.
/// * `grid`: the occupancy grid laid on the ground, occupied red, free dark green, unknown left out.
/// * `box_<id>`: a wireframe CBox per obstacle, posed at its centre, in the colour of its class: vehicle orange,
///   pedestrian cyan, cyclist violet, unknown white, structure grey.
/// * `heading_<id>`: an arrow out of the front, only where the heading is valid. `label_<id>`: its text.
/// * `speed_<id>`: an arrow on top of the box of a track that moves, to where it will be in a second.
/// * `hull_<id>`, `marks_<id>`, `mark_<id>_<letter>`: with `explain`, the hull of its cells (yellow), the triangle's
///   corners A, B, C and the extrapolated D, or the fitted line or plane (green).
/// * `merges_taken`, `merges_refused`: with `explain`, lines between the parts of each merge that the grouping weighed.
/// * `own_body`: edges of the parts of the vehicle's own body in light blue, where it has any.
/// * `region`, `excluded`: the outline that is searched, light blue, and what is not, orange; only where one of them is
///   set (`region.outline`, `region.excluded`).
/// * `ego`, `range_rings`: the vehicle frame's axes on the ground; circles every 10 m.
///
/// An empty result gives the marker and the rings only. The saved file opens in SceneViewer3D.
///
/// @throws std::invalid_argument if the result is not one of this cloud (labels or indices do not fit).
mrpt::opengl::COpenGLScene::Ptr toScene(const PointCloud& cloud, const DetectionResult& result,
                                        const SceneOptions& options = {});

/// Distance from the vehicle's origin to the nearest point of the box, seen from above [m]; 0 inside.
double distanceTo(const OrientedBox& box);

/// Where a picture is taken from: a camera that looks at `target` from `distance` away.
struct CameraView {
    Eigen::Vector3d target{8.0, 0.0, 0.0};  ///< vehicle frame [m]
    double distance = 38.0;                 ///< [m]
    double azimuth_deg = 180.0;             ///< where the camera is, seen from the target; 180: behind the vehicle
    double elevation_deg = 32.0;            ///< 90: from above
};

/// Sets the clip planes for a camera `distance` away from what it looks at [m]. MRPT's own ones leave so few steps of
/// depth that the grid covers what lies on it.
void setClipDistances(mrpt::opengl::COpenGLScene& scene, double distance);

/// Takes pictures of scenes off screen (EGL; in software where there is no GPU). The first picture takes up to a
/// second, later ones some tens of milliseconds: keep one renderer for all. To be used from one thread.
class SceneRenderer {
  public:
    /// @param width,height  of the pictures [pixels].
    /// @throws std::invalid_argument if they are not positive; std::runtime_error if off-screen rendering is not
    ///     available.
    SceneRenderer(int width, int height);
    ~SceneRenderer();
    SceneRenderer(SceneRenderer&&) noexcept;
    SceneRenderer& operator=(SceneRenderer&&) noexcept;

    /// A picture of the scene. A scene belongs to the first renderer that draws it: MRPT throws in a second one.
    mrpt::img::CImage render(mrpt::opengl::COpenGLScene& scene, const CameraView& view = {});

  private:
    int width_;
    int height_;
    std::unique_ptr<mrpt::opengl::CFBORender> renderer_;
};

}  // namespace lidar_obstacles
