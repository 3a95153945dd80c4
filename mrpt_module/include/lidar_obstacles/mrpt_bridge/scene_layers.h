/// @file
/// The stages of one scan as layers of a scene that lasts: for windows and videos, where one scan follows the other.
/// `toScene` (scene.h) makes a scene of its own for each scan instead, for files.
#pragma once

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
    Truth        ///< labelled objects, green
};
constexpr std::size_t kLayers = 14;
using LayerSet = std::bitset<kLayers>;

/// "raw", "ground", "candidates", "filtered", "voxels", "grid", "morphology", "clusters", "rejected", "fit", "boxes",
/// "tracks", "labels" or "truth".
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

/// What the layers show of one scan; vehicle frame [m].
struct LayerData {
    PointCloud cloud;
    DetectionResult result;
    ClusteringParams clustering;          ///< that the result was made with
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
    SceneLayers();
    ~SceneLayers();
    SceneLayers(SceneLayers&&) noexcept;
    SceneLayers& operator=(SceneLayers&&) noexcept;

    /// The scene: the layers, the vehicle's axes and body, and circles every 10 m on the ground.
    mrpt::opengl::COpenGLScene::Ptr scene() const;

    /// Shows another scan. @throws std::invalid_argument if the result is not one of the cloud.
    void setScan(std::shared_ptr<const LayerData> data);
    void setVisible(const LayerSet& layers);
    void setPointColor(PointColor color);

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
};

}  // namespace lidar_obstacles
