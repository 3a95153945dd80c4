// SPDX-License-Identifier: BSD-3-Clause
// Texts, and what the layers draw around the vehicle: circles, merges, zones, the region.
#include "mrpt_bridge/output/layer_objects.h"

#include <cmath>

#include "mrpt_bridge/output/merge_lines.h"
#include "mrpt_bridge/output/own_body_lines.h"
#include "mrpt_bridge/output/region_lines.h"
#include "mrpt_bridge/output/scene_style.h"
#include "mrpt_bridge/output/zone_lines.h"

namespace lidar_obstacles {
namespace {

using mrpt::math::TPoint3D;

}  // namespace

void TextPool::clear() {
    for (const auto& text : texts_) text->setVisibility(false);
    used_.clear();
}

void TextPool::add(const std::string& text, const Eigen::Vector3d& at, const mrpt::img::TColor& color, int lighter) {
    used_.push_back({text, at, color, weight_ - lighter});
    if (scene_) draw(used_.size() - 1, used_.back());
}

void TextPool::draw(std::size_t place, const SceneText& text) {
    if (place == texts_.size()) {
        texts_.push_back(mrpt::opengl::CText::Create());
        texts_.back()->setFont("sans", font_height_);
        scene_->insert(texts_.back());
    }
    mrpt::opengl::CText& label = *texts_[place];
    label.setString(text.text);
    label.setColor_u8(text.color);
    label.setLocation(text.at.x(), text.at.y(), text.at.z());
    label.setVisibility(true);
}

mrpt::img::TColor SceneLayers::Objects::ink(const mrpt::img::TColor& color) const {
    return light_ ? onLight(color) : color;
}

bool SceneLayers::Objects::setLight(bool light) {
    if (lines_.empty())
        for (const auto& object : *scene->getViewport())
            if (const auto lines = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(object))
                lines_.emplace_back(lines, lines->getColor_u8());
    if (light == light_) return false;
    light_ = light;
    for (const auto& [lines, color] : lines_) lines->setColor_u8(ink(color));
    const float paper = light ? 0.93F : 0.07F;
    scene->getViewport()->setCustomBackgroundColor({paper - 0.01F, paper, paper + 0.02F});
    return true;
}

std::vector<SceneText> SceneLayers::Objects::texts() const {
    std::vector<SceneText> all;
    for (const TextPool* pool : {&labels_, &letters_, &reasons_, &truth_labels_, &zone_labels_, &distances_})
        all.insert(all.end(), pool->texts().begin(), pool->texts().end());
    return all;
}

void SceneLayers::Objects::fillMarker(const GroundModel& ground, const OwnBody& own_body) {
    drawOwnBody(own_body, ground, *own_body_);
    axes_->setLocation(0, 0, ground.heightAt(0, 0));
    rings_->clear();
    const auto at = [&](double radius, int k) {
        const double x = radius * std::cos(k * M_PI / 36);
        const double y = radius * std::sin(k * M_PI / 36);
        return TPoint3D(x, y, ground.heightAt(x, y));
    };
    for (int radius = 10; radius <= 60; radius += 10)
        for (int k = 0; k < 72; ++k) rings_->appendLine(at(radius, k), at(radius, k + 1));
    distances_.clear();
    for (int radius = 10; radius <= 60; radius += 10) {
        const TPoint3D p = at(radius, 3);
        distances_.add(std::to_string(radius) + " m", {p.x, p.y, p.z}, {150, 150, 160});
    }
}

void SceneLayers::Objects::fillMerges(const LayerData* data) {
    for (const auto& lines : merges_) lines->clear();
    auto& count = counts_[static_cast<std::size_t>(Layer::Merges)] = 0;
    if (data) count = drawMerges(data->cloud, data->result, {merges_[0].get(), merges_[1].get()});
}

void SceneLayers::Objects::fillZones(const LayerData* data) {
    for (const auto& lines : zones_) lines->clear();
    zone_labels_.clear();
    if (data) {
        const GroundModel& ground = data->result.ground;
        for (const ZoneOutline& zone : data->zones) {
            const std::size_t place = zone.name.empty() ? 3 : static_cast<std::size_t>(zone.state);
            drawOutline(zone.corners, ground, *zones_[place]);
            if (!zone.name.empty()) zone_labels_.add(textOf(zone), labelPlace(zone, ground), zoneColor(zone.state));
        }
    }
    counts_[static_cast<std::size_t>(Layer::Zones)] = data ? data->zones.size() : 0;
}

void SceneLayers::Objects::fillRegion(const LayerData* data) {
    region_->clear();
    excluded_->clear();
    counts_[static_cast<std::size_t>(Layer::Region)] = data && data->cloud.size() > 0 ? 1 : 0;
    if (!data) return;
    drawSearched(data->region, data->result.ground, *region_);
    drawExcluded(data->region, data->result.ground, *excluded_);
}

}  // namespace lidar_obstacles
