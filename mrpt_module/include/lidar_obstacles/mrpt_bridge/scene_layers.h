// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The stages of one scan as layers of a scene that lasts: for windows and videos, where one scan follows the other.
/// `toScene` (scene.h) makes a scene of its own for each scan instead, for files.
#pragma once

#include <mrpt/img/TColor.h>
#include <mrpt/opengl/COpenGLScene.h>

#include <bitset>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/track_tails.h"
#include "lidar_obstacles/own_body.h"
#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"
#include "lidar_obstacles/zones.h"

namespace lidar_obstacles {

/// In the order of the stages that leave them.
enum class Layer : std::uint8_t {
    Raw,         ///< all returns, by PointColor
    Ground,      ///< returns on the ground, brown
    Candidates,  ///< returns that may be obstacles, by their height above the ground
    Filtered,    ///< returns that the 3D filter took out, red
    Voxels,      ///< voxels by which the 3D filter decides, where there is one
    Grid,        ///< the occupancy grid as a texture: occupied red, free dark green
    Morphology,  ///< occupied cells (orange) and what closing adds between them (yellow)
    Clusters,    ///< returns of each obstacle in a colour of its own
    Rejected,    ///< returns of what was sorted out in magenta, with the reason
    Fit,         ///< hull and its corners (yellow); line, or planes of the seen faces (green) of each box
    Boxes,       ///< box and heading in the colour of the class
    Tracks,      ///< where each track came from (grey), and where it will be in a second (arrow, if it moves)
    Labels,      ///< class, id and distance of each box; of a track its speed and age
    Truth,       ///< labelled objects, green
    Merges,      ///< lines between the parts of each merge that was weighed: taken green, refused red
    Zones,       ///< the line around each zone with its state: free green, occupied red, unknown yellow
    Region       ///< the line around what is searched, blue
};
constexpr std::size_t kLayers = 17;
using LayerSet = std::bitset<kLayers>;

/// "raw", "ground", "candidates", "filtered", "voxels", "grid", "morphology", "clusters", "rejected", "fit", "boxes",
/// "tracks", "labels", "truth", "merges", "zones" or "region".
const char* toString(Layer layer);
/// The layer of that name.
std::optional<Layer> layerOf(const std::string& name);
/// Ground, candidates, grid, clusters, boxes, tracks and labels.
LayerSet usualLayers();
inline bool has(const LayerSet& set, Layer layer) { return set[static_cast<std::size_t>(layer)]; }

enum class PointColor : std::uint8_t { Height, Intensity, Ring };
/// "height", "intensity" or "ring".
const char* toString(PointColor color);

/// A labelled object.
struct TruthBox {
    std::string label;
    OrientedBox box;
};

/// A zone as of one scan, to be drawn.
struct ZoneOutline {
    std::string name;  ///< "" for the vehicle's own outline
    ZoneState state = ZoneState::Unknown;
    ZoneReason reason = ZoneReason::None;
    Outline corners;  ///< vehicle frame [m]
};
/// The zones of a monitor after a scan, and the vehicle's outline where it is told. Zones of the map are left out where
/// the pose is not known.
std::vector<ZoneOutline> outlinesOf(const ZoneMonitor& zones, const SequenceResult& found,
                                    const Trajectory& trajectory);

/// A text in the scene.
struct SceneText {
    std::string text;
    Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< vehicle frame [m]
    mrpt::img::TColor color;
    int weight = 0;  ///< which to keep where two are in each other's way: the heavier one
};

/// What the layers show of one scan; vehicle frame [m].
struct LayerData {
    PointCloud cloud;
    DetectionResult result;
    ClusteringParams clustering;          ///< that the result was made with
    RegionParams region;                  ///< that was searched
    std::vector<ZoneOutline> zones;       ///< empty where none are watched
    OwnBody own_body;                     ///< of the vehicle, drawn with the marker
    std::vector<TrackTail> tails;         ///< of the result's tracks
    std::vector<TruthBox> truth;          ///< empty where none is known
    std::vector<Eigen::Vector3f> voxels;  ///< centres of those by which the 3D filter decides; empty without one
};

/// A scene whose layers follow scans and switches. Objects of MRPT's scenes hold memory of the graphics card that only
/// the drawing thread can free, so they are made once and filled again; a layer is filled only when it is shown and its
/// scan or colours have changed. To be used under the lock of the window that draws the scene.
class SceneLayers {
  public:
    /// @param draw_texts  false: the scene draws no texts, texts() are for the caller to draw.
    explicit SceneLayers(bool draw_texts = true);
    ~SceneLayers();
    SceneLayers(SceneLayers&&) noexcept;
    SceneLayers& operator=(SceneLayers&&) noexcept;

    /// The scene: the layers, the vehicle's axes and body, and circles every 10 m on the ground with their distances.
    mrpt::opengl::COpenGLScene::Ptr scene() const;

    /// Shows another scan. @throws std::invalid_argument if the result is not one of the cloud.
    void setScan(std::shared_ptr<const LayerData> data);
    void setVisible(const LayerSet& layers);
    void setPointColor(PointColor color);
    /// On a light background colours are as dark as it takes to be seen; texts() keep theirs.
    void setLight(bool light);
    /// How far the camera is from what it looks at [m]: shafts and heads of arrows are as wide in the picture as from
    /// where pictures are taken (CameraView), as long as this is not called. The length of a speed arrow stays one
    /// second's way. They are made anew only for a change by more than a quarter.
    void setViewDistance(double distance);
    /// All texts of the visible layers, and the distances of the circles.
    std::vector<SceneText> texts() const;

    /// How many things a layer shows: returns, cells, boxes, tracks, labels; 0 for hidden ones.
    std::size_t count(Layer layer) const;

  private:
    struct Objects;
    void fill();

    std::unique_ptr<Objects> objects_;
    std::shared_ptr<const LayerData> data_;
    LayerSet visible_;
    LayerSet filled_;
    PointColor color_ = PointColor::Height;
    double arrow_scale_ = 1.0;
};

}  // namespace lidar_obstacles
