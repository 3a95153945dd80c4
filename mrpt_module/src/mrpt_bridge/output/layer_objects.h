// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The MRPT objects of SceneLayers, and how each layer's are filled.
#pragma once

#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfTexturedTriangles.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CText.h>

#include <array>
#include <utility>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/scene_layers.h"

namespace lidar_obstacles {

/// Texts that face the screen: as many as were ever needed at once, those not needed now are hidden.
class TextPool {
  public:
    /// @param scene   null: texts are only listed.
    /// @param weight  of its texts (SceneText).
    TextPool(mrpt::opengl::COpenGLScene::Ptr scene, int height, int weight)
        : scene_(std::move(scene)), font_height_(height), weight_(weight) {}

    void clear();
    /// @param lighter  by how much its weight is less than the others'.
    void add(const std::string& text, const Eigen::Vector3d& at, const mrpt::img::TColor& color, int lighter = 0);
    std::size_t size() const { return used_.size(); }
    const std::vector<SceneText>& texts() const { return used_; }

  private:
    void draw(std::size_t place, const SceneText& text);

    mrpt::opengl::COpenGLScene::Ptr scene_;
    int font_height_;
    int weight_;
    std::vector<mrpt::opengl::CText::Ptr> texts_;
    std::vector<SceneText> used_;
};

/// Coloured points that are filled at once: MRPT's own functions take a lock for each. The buffers of the shader are
/// all there is, no octree is built.
class PointLayer : public mrpt::opengl::CPointCloudColoured {
  public:
    /// Takes over points and their colours, as many of the one as of the other.
    void assign(std::vector<mrpt::math::TPoint3Df> points, std::vector<mrpt::img::TColor> colors);
    void onUpdateBuffers_Points() override {}
    auto internalBoundingBoxLocal() const -> mrpt::math::TBoundingBoxf override { return verticesBoundingBox(); }
};

/// Everything that is drawn, made once.
struct SceneLayers::Objects {
    explicit Objects(bool draw_texts);

    /// Fills one layer's objects with what it shows of `data`, empties them where `data` is null. Layers that share
    /// objects are filled together: fillPoints, fillCarpet.
    void fillLayer(Layer layer, const LayerData* data);
    /// Draws each return in the most telling of the visible point layers that it belongs to.
    void fillPoints(const LayerData* data, const LayerSet& visible, PointColor color);
    /// Lays grid and morphology, as far as visible, on the ground as one texture.
    void fillCarpet(const LayerData* data, const LayerSet& visible);
    /// Lays the circles and the axes on the ground; draws the vehicle's body.
    void fillMarker(const GroundModel& ground, const OwnBody& own_body);
    /// Lines at once; points and triangles when they are filled. @return false if nothing changes.
    bool setLight(bool light);
    /// Of arrows, when they are filled: their width and head, and how far those of headings reach out of the box.
    void setArrowScale(double scale) { arrow_scale_ = scale; }
    std::size_t count(Layer layer) const;
    std::vector<SceneText> texts() const;

    mrpt::opengl::COpenGLScene::Ptr scene;

  private:
    mrpt::img::TColor ink(const mrpt::img::TColor& color) const;
    void fillRejected(const LayerData* data);
    void fillFit(const LayerData* data);
    void fillBoxes(const LayerData* data);
    void fillTracks(const LayerData* data);
    void fillLabels(const LayerData* data);
    void fillTruth(const LayerData* data);
    void fillVoxels(const LayerData* data);
    void fillMerges(const LayerData* data);
    void fillZones(const LayerData* data);
    void fillRegion(const LayerData* data);

    std::array<std::shared_ptr<PointLayer>, kLayers> clouds_;  ///< of the point layers and voxels; null for others
    mrpt::opengl::CSetOfTexturedTriangles::Ptr carpet_;
    /// By class.
    std::array<mrpt::opengl::CSetOfLines::Ptr, std::tuple_size_v<ClassProbabilities>> boxes_;
    mrpt::opengl::CSetOfTriangles::Ptr arrows_;
    mrpt::opengl::CSetOfLines::Ptr tails_;
    mrpt::opengl::CSetOfTriangles::Ptr speeds_;
    mrpt::opengl::CSetOfLines::Ptr hulls_;
    mrpt::opengl::CSetOfLines::Ptr marks_;
    mrpt::opengl::CSetOfLines::Ptr truth_;
    mrpt::opengl::CSetOfLines::Ptr rings_;
    mrpt::opengl::CSetOfLines::Ptr own_body_;
    mrpt::opengl::CRenderizable::Ptr axes_;
    std::array<mrpt::opengl::CSetOfLines::Ptr, 2> merges_;  ///< refused, taken
    std::array<mrpt::opengl::CSetOfLines::Ptr, 4> zones_;   ///< by state; the vehicle's outline
    mrpt::opengl::CSetOfLines::Ptr region_;
    mrpt::opengl::CSetOfLines::Ptr excluded_;
    TextPool labels_;
    TextPool letters_;
    TextPool reasons_;
    TextPool truth_labels_;
    TextPool zone_labels_;
    TextPool distances_;
    std::array<std::size_t, kLayers> counts_{};
    bool light_ = false;
    double arrow_scale_ = 1.0;
    std::vector<std::pair<mrpt::opengl::CSetOfLines::Ptr, mrpt::img::TColor>> lines_;  ///< all, as on a dark background
};

/// True for the layers that fillPoints fills.
bool isPointLayer(Layer layer);
/// True for the layers that fillCarpet fills.
inline bool isCarpetLayer(Layer layer) { return layer == Layer::Grid || layer == Layer::Morphology; }

}  // namespace lidar_obstacles
