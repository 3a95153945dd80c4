// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/scene_layers.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "mrpt_bridge/output/layer_objects.h"

namespace lidar_obstacles {
namespace {

constexpr std::array<const char*, kLayers> kNames = {
    "raw", "ground", "candidates", "filtered", "voxels", "grid",   "morphology", "clusters", "rejected",
    "fit", "boxes",  "tracks",     "labels",   "truth",  "merges", "zones",      "region"};

}  // namespace

const char* toString(Layer layer) { return kNames.at(static_cast<std::size_t>(layer)); }

std::optional<Layer> layerOf(const std::string& name) {
    for (std::size_t k = 0; k < kLayers; ++k)
        if (name == kNames[k]) return static_cast<Layer>(k);
    return std::nullopt;
}

LayerSet usualLayers() {
    LayerSet layers;
    for (const Layer l :
         {Layer::Ground, Layer::Candidates, Layer::Grid, Layer::Clusters, Layer::Boxes, Layer::Tracks, Layer::Labels})
        layers.set(static_cast<std::size_t>(l));
    return layers;
}

const char* toString(PointColor color) {
    switch (color) {
        case PointColor::Intensity:
            return "intensity";
        case PointColor::Ring:
            return "ring";
        case PointColor::Height:
            break;
    }
    return "height";
}

SceneLayers::SceneLayers(bool draw_texts) : objects_(std::make_unique<Objects>(draw_texts)) {
    objects_->fillMarker({}, {});
}
SceneLayers::~SceneLayers() = default;
SceneLayers::SceneLayers(SceneLayers&&) noexcept = default;
SceneLayers& SceneLayers::operator=(SceneLayers&&) noexcept = default;

mrpt::opengl::COpenGLScene::Ptr SceneLayers::scene() const { return objects_->scene; }

void SceneLayers::setScan(std::shared_ptr<const LayerData> data) {
    const GroundModel& ground = data->result.ground;
    const std::size_t labelled = ground.is_ground.size();
    if ((labelled != 0 && labelled != data->cloud.size()) || ground.height.size() != labelled)
        throw std::invalid_argument("SceneLayers: the result has ground labels for another cloud");
    data_ = std::move(data);
    filled_.reset();
    objects_->fillMarker(ground, data_->own_body);
    fill();
}

void SceneLayers::setVisible(const LayerSet& layers) {
    const LayerSet changed = visible_ ^ layers;
    visible_ = layers;
    filled_ &= ~changed;
    fill();
}

void SceneLayers::setPointColor(PointColor color) {
    if (color == color_) return;
    color_ = color;
    filled_[static_cast<std::size_t>(Layer::Raw)] = false;
    fill();
}

void SceneLayers::setLight(bool light) {
    if (!objects_->setLight(light)) return;
    filled_.reset();
    fill();
}

void SceneLayers::setViewDistance(double distance) {
    constexpr double kSame = 1.25;  // as the arrows are filled again for
    constexpr double kSmallest = 0.25, kLargest = 12.0;
    const double scale = std::clamp(distance / CameraView{}.distance, kSmallest, kLargest);
    if (!(scale > kSame * arrow_scale_ || scale < arrow_scale_ / kSame)) return;
    arrow_scale_ = scale;
    objects_->setArrowScale(scale);
    for (const Layer layer : {Layer::Boxes, Layer::Tracks}) filled_[static_cast<std::size_t>(layer)] = false;
    fill();
}

std::vector<SceneText> SceneLayers::texts() const { return objects_->texts(); }

std::size_t SceneLayers::count(Layer layer) const { return has(visible_, layer) ? objects_->count(layer) : 0; }

void SceneLayers::fill() {
    bool points = false;
    bool carpet = false;
    for (std::size_t k = 0; k < kLayers; ++k) {
        if (filled_[k]) continue;
        const auto layer = static_cast<Layer>(k);
        points = points || isPointLayer(layer);
        carpet = carpet || isCarpetLayer(layer);
        objects_->fillLayer(layer, visible_[k] ? data_.get() : nullptr);
    }
    if (points) objects_->fillPoints(data_.get(), visible_, color_);
    if (carpet) objects_->fillCarpet(data_.get(), visible_);
    filled_.set();
}

}  // namespace lidar_obstacles
