// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/output/layer_objects.h"

#include <mrpt/opengl/stock_objects.h>

#include <cmath>

#include "mrpt_bridge/output/flat_arrow.h"
#include "mrpt_bridge/output/merge_lines.h"
#include "mrpt_bridge/output/own_body_lines.h"
#include "mrpt_bridge/output/region_lines.h"
#include "mrpt_bridge/output/scene_carpet.h"
#include "mrpt_bridge/output/scene_style.h"
#include "mrpt_bridge/output/zone_lines.h"

namespace lidar_obstacles {
namespace {

using mrpt::img::TColor;
using mrpt::math::TPoint3D;

constexpr int kMaxTexels = 1024;
constexpr double kGridDepth = 0.15;  ///< or the grid would cover the points on it [m]
constexpr TColor kGreen{0, 230, 64};
constexpr TColor kYellow{255, 230, 0};
constexpr TColor kMagenta{255, 60, 255};

float sizeOf(Layer points) {
    if (points == Layer::Voxels) return 7.F;
    return points == Layer::Clusters || points == Layer::Rejected ? 4.F : 2.F;
}

template <class Object>
typename Object::Ptr addTo(mrpt::opengl::COpenGLScene& scene, const std::string& name) {
    auto object = Object::Create();
    object->setName(name);
    scene.insert(object);
    return object;
}

mrpt::opengl::CSetOfLines::Ptr addLines(mrpt::opengl::COpenGLScene& scene, const std::string& name, const TColor& color,
                                        float width) {
    auto lines = addTo<mrpt::opengl::CSetOfLines>(scene, name);
    lines->setColor_u8(color);
    lines->setLineWidth(width);
    return lines;
}

/// The box's corners: bottom 0 .. 3 from the rear right counter-clockwise, top 4 .. 7.
std::array<TPoint3D, 8> cornersOf(const OrientedBox& b) {
    std::array<TPoint3D, 8> corners;
    const double c = std::cos(b.yaw);
    const double s = std::sin(b.yaw);
    for (int k = 0; k < 8; ++k) {
        const double along = b.size.x() / 2 * (k % 4 == 1 || k % 4 == 2 ? 1 : -1);
        const double across = b.size.y() / 2 * (k % 4 >= 2 ? 1 : -1);
        const double up = b.size.z() / 2 * (k >= 4 ? 1 : -1);
        corners[static_cast<std::size_t>(k)] = {b.center.x() + c * along - s * across,
                                                b.center.y() + s * along + c * across, b.center.z() + up};
    }
    return corners;
}

void drawBox(const OrientedBox& box, mrpt::opengl::CSetOfLines& lines) {
    const auto p = cornersOf(box);
    for (std::size_t k = 0; k < 4; ++k) {
        lines.appendLine(p[k], p[(k + 1) % 4]);
        lines.appendLine(p[4 + k], p[4 + (k + 1) % 4]);
        lines.appendLine(p[k], p[4 + k]);
    }
}

/// The vertical planes of a box: those of its faces that have returns on them, as far as they are seen.
void drawFaces(const Obstacle& o, mrpt::opengl::CSetOfLines& lines) {
    static constexpr std::array<std::array<std::size_t, 3>, 4> kEdges = {
        {{kFront, 1, 2}, {kBack, 3, 0}, {kLeft, 2, 3}, {kRight, 0, 1}}};
    const auto p = cornersOf(o.seen_box);
    for (const auto& [face, a, b] : kEdges) {
        if ((o.faces & face) == 0) continue;
        lines.appendLine(p[a], p[b]);
        lines.appendLine(p[4 + a], p[4 + b]);
        lines.appendLine(p[a], p[4 + a]);
        lines.appendLine(p[b], p[4 + b]);
    }
}

/// A flat arrow at half height, out of the front.
FlatArrow headingArrow(const OrientedBox& b, double scale) {
    constexpr double kReach = 1.4;  // [m]
    return {b.center, b.yaw, b.size.x() / 2 + kReach * scale, 0.14, scale};
}

/// Points of the ground plane a little above the ground.
std::vector<Eigen::Vector3d> raised(const std::vector<Eigen::Vector2d>& points, const GroundModel& ground,
                                    bool closed) {
    std::vector<Eigen::Vector3d> out;
    for (const Eigen::Vector2d& p : points) out.emplace_back(p.x(), p.y(), ground.heightAt(p.x(), p.y()) + 0.05);
    if (closed && !out.empty()) out.push_back(out.front());
    return out;
}

void drawPath(const std::vector<Eigen::Vector3d>& points, mrpt::opengl::CSetOfLines& lines) {
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Eigen::Vector3d& a = points[k];
        const Eigen::Vector3d& b = points[k + 1];
        lines.appendLine(TPoint3D(a.x(), a.y(), a.z()), TPoint3D(b.x(), b.y(), b.z()));
    }
}

Eigen::Vector3d above(const OrientedBox& box, double distance) {
    return box.center + Eigen::Vector3d(0, 0, box.size.z() / 2 + distance);
}

std::string reasonText(const RejectedCluster& rejected) {
    char text[96];
    std::snprintf(text, sizeof text, "%s %.3g/%.3g", toString(rejected.reason), rejected.measured, rejected.limit);
    return text;
}

}  // namespace

SceneLayers::Objects::Objects(bool draw_texts)
    : scene(mrpt::opengl::COpenGLScene::Create()),
      labels_(draw_texts ? scene : nullptr, 16, 4),
      letters_(draw_texts ? scene : nullptr, 20, 5),
      reasons_(draw_texts ? scene : nullptr, 11, 1),
      truth_labels_(draw_texts ? scene : nullptr, 13, 2),
      zone_labels_(draw_texts ? scene : nullptr, 14, 3),
      distances_(draw_texts ? scene : nullptr, 12, 6) {
    scene->getViewport()->setCustomBackgroundColor({0.06F, 0.07F, 0.09F});
    carpet_ = addTo<mrpt::opengl::CSetOfTexturedTriangles>(*scene, "grid");
    carpet_->setVisibility(false);
    axes_ = mrpt::opengl::stock_objects::CornerXYZ(1.5F);
    scene->insert(axes_);
    rings_ = addLines(*scene, "range_rings", {120, 120, 130}, 1.F);
    own_body_ = ownBodyLines();
    scene->insert(own_body_);
    for (std::size_t k = 0; k < kLayers; ++k) {
        const auto layer = static_cast<Layer>(k);
        if (!isPointLayer(layer) && layer != Layer::Voxels) continue;
        clouds_[k] = std::make_shared<PointLayer>();
        clouds_[k]->setName(lidar_obstacles::toString(layer));
        scene->insert(clouds_[k]);
        clouds_[k]->setPointSize(sizeOf(layer));
    }
    for (std::size_t k = 0; k < boxes_.size(); ++k) {
        const auto cls = static_cast<ObstacleClass>(k);
        boxes_[k] = addLines(*scene, std::string("boxes_") + lidar_obstacles::toString(cls), classColor(cls), 3.F);
    }
    arrows_ = addTo<mrpt::opengl::CSetOfTriangles>(*scene, "headings");
    arrows_->enableLight(false);
    tails_ = addLines(*scene, "tails", {170, 175, 190}, 2.F);
    speeds_ = addTo<mrpt::opengl::CSetOfTriangles>(*scene, "speeds");
    speeds_->enableLight(false);
    hulls_ = addLines(*scene, "hulls", kYellow, 3.F);
    marks_ = addLines(*scene, "marks", kGreen, 4.F);
    truth_ = addLines(*scene, "truth", {90, 255, 90}, 2.F);
    merges_ = {addLines(*scene, "merges_refused", kMergeColors[0], 2.F),
               addLines(*scene, "merges_taken", kMergeColors[1], 2.F)};
    for (std::size_t k = 0; k < zones_.size(); ++k)
        zones_[k] = addLines(*scene, "zones_" + std::to_string(k),
                             k < 3 ? zoneColor(static_cast<ZoneState>(k)) : kRegionColor, 3.F);
    region_ = addLines(*scene, "region", kRegionColor, 1.F);
    excluded_ = addLines(*scene, "excluded", kExcludedColor, 2.F);
}

void SceneLayers::Objects::fillLayer(Layer layer, const LayerData* data) {
    switch (layer) {
        case Layer::Voxels:
            return fillVoxels(data);
        case Layer::Rejected:
            return fillRejected(data);
        case Layer::Fit:
            return fillFit(data);
        case Layer::Boxes:
            return fillBoxes(data);
        case Layer::Tracks:
            return fillTracks(data);
        case Layer::Labels:
            return fillLabels(data);
        case Layer::Truth:
            return fillTruth(data);
        case Layer::Merges:
            return fillMerges(data);
        case Layer::Zones:
            return fillZones(data);
        case Layer::Region:
            return fillRegion(data);
        default:
            return;
    }
}

std::size_t SceneLayers::Objects::count(Layer layer) const { return counts_[static_cast<std::size_t>(layer)]; }

void SceneLayers::Objects::fillCarpet(const LayerData* data, const LayerSet& visible) {
    const bool shown =
        data && !data->result.grid.empty() && (has(visible, Layer::Grid) || has(visible, Layer::Morphology));
    carpet_->setVisibility(shown);
    for (const Layer layer : {Layer::Grid, Layer::Morphology})
        counts_[static_cast<std::size_t>(layer)] = data ? data->result.grid.occupied.size() : 0;
    if (!shown) return;
    const OccupancyGrid& grid = data->result.grid;
    const int k = cellsPerTexel(grid, kMaxTexels);
    cv::Mat1b texels = emptyTexels(grid, k);
    if (has(visible, Layer::Grid)) markStates(grid, k, texels);
    const Closing closing{data->cloud.allSensors(), data->clustering};
    if (has(visible, Layer::Morphology)) markClosing(grid, closing, k, texels);
    layCarpet({grid, data->result.ground, kGridDepth, k}, texels, *carpet_);
}

void SceneLayers::Objects::fillRejected(const LayerData* data) {
    reasons_.clear();
    if (!data) return;
    for (const RejectedCluster& rejected : data->result.clusters.rejected) {
        Eigen::Vector3d top = Eigen::Vector3d::Zero();
        float highest = -1e9F;
        for (const std::int32_t i : rejected.cluster.points) {
            const Eigen::Vector3f& p = data->cloud.xyz[static_cast<std::size_t>(i)];
            top.head<2>() += p.head<2>().cast<double>() / static_cast<double>(rejected.cluster.points.size());
            highest = std::max(highest, p.z());
        }
        top.z() = highest + 0.2;
        reasons_.add(reasonText(rejected), top, kMagenta);
    }
}

void SceneLayers::Objects::fillFit(const LayerData* data) {
    hulls_->clear();
    marks_->clear();
    letters_.clear();
    auto& count = counts_[static_cast<std::size_t>(Layer::Fit)] = 0;
    if (!data) return;
    const GroundModel& ground = data->result.ground;
    for (const Obstacle& o : data->result.obstacles) {
        const bool corners = o.rule == HeadingRule::TwoSides;
        const auto marks = raised(o.marks, ground, corners);
        drawPath(raised(o.hull, ground, true), *hulls_);
        drawPath(marks, *marks_);
        if (o.rule == HeadingRule::Plane) drawFaces(o, *marks_);
        if (o.rule != HeadingRule::None || !o.hull.empty()) ++count;
        for (std::size_t k = 0; corners && k < std::min<std::size_t>(4, marks.size()); ++k) {
            const TColor color = k < 3 ? kYellow : TColor(230, 80, 255);  // D is extrapolated
            letters_.add(std::string(1, static_cast<char>('A' + k)), marks[k] + Eigen::Vector3d(0, 0, 0.1), color);
        }
    }
}

void SceneLayers::Objects::fillBoxes(const LayerData* data) {
    for (const auto& lines : boxes_) lines->clear();
    arrows_->clearTriangles();
    counts_[static_cast<std::size_t>(Layer::Boxes)] = data ? data->result.obstacles.size() : 0;
    if (!data) return;
    for (const Obstacle& o : data->result.obstacles) {
        drawBox(o.box, *boxes_[static_cast<std::size_t>(o.cls)]);
        if (o.heading_valid) addArrow(headingArrow(o.box, arrow_scale_), ink(classColor(o.cls)), *arrows_);
    }
}

void SceneLayers::Objects::fillLabels(const LayerData* data) {
    labels_.clear();
    if (data)
        for (const Obstacle& o : data->result.obstacles)
            labels_.add(labelText(o, false), above(o.box, 0.5), classColor(o.cls),
                        o.cls == ObstacleClass::Structure ? 4
                        : o.cls == ObstacleClass::Unknown ? 1
                                                          : 0);
    counts_[static_cast<std::size_t>(Layer::Labels)] = labels_.size();
}

void SceneLayers::Objects::fillTruth(const LayerData* data) {
    truth_->clear();
    truth_labels_.clear();
    if (data) {
        for (const TruthBox& t : data->truth) {
            drawBox(t.box, *truth_);
            truth_labels_.add(t.label, above(t.box, 0.2), {90, 255, 90});
        }
    }
    counts_[static_cast<std::size_t>(Layer::Truth)] = truth_labels_.size();
}

}  // namespace lidar_obstacles
