// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/output/flat_arrow.h"
#include "mrpt_bridge/output/layer_objects.h"
#include "mrpt_bridge/output/scene_style.h"

namespace lidar_obstacles {
namespace {

void drawTail(const TrackTail& tail, mrpt::opengl::CSetOfLines& lines) {
    for (std::size_t k = 0; k + 1 < tail.points.size(); ++k) {
        const Eigen::Vector3d& a = tail.points[k];
        const Eigen::Vector3d& b = tail.points[k + 1];
        lines.appendLine(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    }
}

}  // namespace

void SceneLayers::Objects::fillTracks(const LayerData* data) {
    tails_->clear();
    speeds_->clearTriangles();
    auto& count = counts_[static_cast<std::size_t>(Layer::Tracks)] = 0;
    if (!data) return;
    for (const TrackTail& tail : data->tails) drawTail(tail, *tails_);
    for (const Obstacle& o : data->result.obstacles) {
        if (o.track) ++count;
        auto arrow = speedArrow(o);
        if (!arrow) continue;
        arrow->scale = arrow_scale_;
        addArrow(*arrow, ink(kSpeedColor), *speeds_);
    }
}

}  // namespace lidar_obstacles
