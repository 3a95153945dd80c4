// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "lidar_obstacles/grid_image.h"

#include <mrpt/opengl/CArrow.h>
#include <mrpt/opengl/CBox.h>
#include <mrpt/opengl/CPointCloudColoured.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CText.h>
#include <mrpt/opengl/stock_objects.h>
#include <mrpt/poses/CPose3D.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "mrpt_bridge/output/merge_lines.h"
#include "mrpt_bridge/output/own_body_lines.h"
#include "mrpt_bridge/output/region_lines.h"
#include "mrpt_bridge/output/scene_carpet.h"
#include "mrpt_bridge/output/scene_style.h"
#include "mrpt_bridge/output/zone_lines.h"

namespace lidar_obstacles {
namespace {

using mrpt::img::TColor;
using mrpt::opengl::COpenGLScene;

/// What a return is drawn as.
enum class Kind : std::uint8_t { Other, Ground, Candidate, Clustered, Rejected };

constexpr std::array<const char*, 5> kCloudNames = {"other", "ground", "candidates", "clustered", "rejected"};

/// Kind and colour of every return of a scan.
struct Painting {
    std::vector<Kind> kind;
    std::vector<TColor> color;

    void set(std::int32_t index, Kind k, const TColor& c) {
        kind.at(static_cast<std::size_t>(index)) = k;
        color.at(static_cast<std::size_t>(index)) = c;
    }
};

Painting paint(const PointCloud& cloud, const DetectionResult& result, const SceneOptions& options) {
    const std::size_t labelled = result.ground.is_ground.size();
    if ((labelled != 0 && labelled != cloud.size()) || result.ground.height.size() != labelled) {
        throw std::invalid_argument("toScene: the result has ground labels for another cloud");
    }
    Painting painting;
    painting.kind.assign(cloud.size(), Kind::Other);
    painting.color.assign(cloud.size(), TColor(95, 95, 100));
    for (std::size_t i = 0; i < labelled; ++i) {
        if (result.ground.is_ground[i]) painting.set(static_cast<std::int32_t>(i), Kind::Ground, {150, 118, 84});
    }
    for (const std::int32_t i : result.candidates) {
        const float height = labelled ? result.ground.height.at(static_cast<std::size_t>(i)) : 0.F;
        painting.set(i, Kind::Candidate, heightColor(height));
    }
    if (options.rejected) {
        for (const auto& rejected : result.clusters.rejected) {
            for (const std::int32_t i : rejected.cluster.points) painting.set(i, Kind::Rejected, {255, 0, 255});
        }
    }
    for (const Obstacle& o : result.obstacles) {
        for (const std::int32_t i : o.points) painting.set(i, Kind::Clustered, clusterColor(o.id));
    }
    return painting;
}

void addPoints(COpenGLScene& scene, const PointCloud& cloud, const Painting& painting) {
    std::array<mrpt::opengl::CPointCloudColoured::Ptr, kCloudNames.size()> clouds;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const auto kind = static_cast<std::size_t>(painting.kind[i]);
        auto& target = clouds[kind];
        if (!target) {
            target = mrpt::opengl::CPointCloudColoured::Create();
            target->setName(kCloudNames[kind]);
            target->setPointSize(painting.kind[i] == Kind::Clustered ? 4.F : 2.F);
            scene.insert(target);
        }
        const Eigen::Vector3f& p = cloud.xyz[i];
        const TColor& c = painting.color[i];
        target->insertPoint({p.x(), p.y(), p.z(), c.R, c.G, c.B, 255});
    }
}

/// The grid's cells laid on the ground, `depth` below it.
void addGrid(COpenGLScene& scene, const DetectionResult& result, double depth) {
    if (result.grid.empty()) return;
    auto cells = mrpt::opengl::CSetOfTriangles::Create();
    layCells({result.grid, result.ground, depth, 1}, stateImage(result.grid), *cells);
    cells->setName("grid");
    scene.insert(cells);
}

void addObstacle(COpenGLScene& scene, const Obstacle& o, const SceneOptions& options) {
    const OrientedBox& b = o.box;
    const TColor color = classColor(o.cls);
    const mrpt::math::TPoint3D half(b.size.x() / 2, b.size.y() / 2, b.size.z() / 2);
    auto box = mrpt::opengl::CBox::Create(mrpt::math::TPoint3D(-half.x, -half.y, -half.z), half, true);
    box->setBoxBorderColor(color);
    box->setLineWidth(3.F);
    box->setPose(mrpt::poses::CPose3D(b.center.x(), b.center.y(), b.center.z(), b.yaw, 0, 0));
    box->setName("box_" + std::to_string(o.id));
    scene.insert(box);
    if (o.heading_valid) {
        const auto front = static_cast<float>(half.x);
        auto arrow = mrpt::opengl::CArrow::Create(0.F, 0.F, 0.F, front + 1.2F, 0.F, 0.F, 0.2F, 0.06F, 0.18F);
        arrow->setPose(box->getPose());
        arrow->setColor_u8(color);
        arrow->setName("heading_" + std::to_string(o.id));
        scene.insert(arrow);
    }
    if (const auto arrow = speedArrow(o)) {
        auto speed = mrpt::opengl::CSetOfTriangles::Create();
        speed->enableLight(false);
        addArrow(*arrow, kSpeedColor, *speed);
        speed->setName("speed_" + std::to_string(o.id));
        scene.insert(speed);
    }
    if (!options.labels) return;
    auto label = mrpt::opengl::CText::Create(labelText(o, options.explain));
    label->setFont("sans", 18);
    label->setColor_u8(color);
    label->setLocation(b.center.x(), b.center.y(), b.center.z() + half.z + 0.5);
    label->setName("label_" + std::to_string(o.id));
    scene.insert(label);
}

/// A closed or open line through points a little above the ground.
void addLine(COpenGLScene& scene, const std::vector<Eigen::Vector3d>& points, const TColor& color,
             const std::string& name) {
    auto lines = mrpt::opengl::CSetOfLines::Create();
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
        const Eigen::Vector3d& a = points[k];
        const Eigen::Vector3d& b = points[k + 1];
        lines->appendLine(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    }
    lines->setColor_u8(color);
    lines->setLineWidth(4.F);
    lines->setName(name);
    scene.insert(lines);
}

/// What the box was fitted to: the hull, and the corners of its triangle (Fig. 5) or the line.
void addEvidence(COpenGLScene& scene, const Obstacle& o, const GroundModel& ground) {
    constexpr double kAbove = 0.05;
    const auto raised = [&](const std::vector<Eigen::Vector2d>& points, bool closed) {
        std::vector<Eigen::Vector3d> out;
        for (const Eigen::Vector2d& p : points) out.emplace_back(p.x(), p.y(), ground.heightAt(p.x(), p.y()) + kAbove);
        if (closed && !out.empty()) out.push_back(out.front());
        return out;
    };
    const std::string id = std::to_string(o.id);
    const bool corners = o.rule == HeadingRule::TwoSides;
    if (!o.hull.empty()) addLine(scene, raised(o.hull, true), {255, 230, 0}, "hull_" + id);
    if (o.marks.empty()) return;
    const auto marks = raised(o.marks, corners);
    addLine(scene, marks, {0, 230, 64}, "marks_" + id);
    if (!corners) return;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::string letter(1, static_cast<char>('A' + k));
        auto text = mrpt::opengl::CText::Create(letter);
        text->setFont("sans", 22);
        text->setColor_u8(k < 3 ? TColor(255, 230, 0) : TColor(230, 80, 255));  // as in the paper's figure
        text->setLocation(marks[k].x(), marks[k].y(), marks[k].z() + 0.1);
        text->setName("mark_" + id + "_" + letter);
        scene.insert(text);
    }
}

/// The vehicle frame's axes on the ground, and circles every 10 m.
void addEgo(COpenGLScene& scene, const GroundModel& ground) {
    auto axes = mrpt::opengl::stock_objects::CornerXYZ(1.5F);
    axes->setLocation(0, 0, ground.heightAt(0, 0));
    axes->setName("ego");
    scene.insert(axes);
    auto rings = mrpt::opengl::CSetOfLines::Create();
    const auto at = [&](double radius, int k) {
        const double x = radius * std::cos(k * M_PI / 36);
        const double y = radius * std::sin(k * M_PI / 36);
        return mrpt::math::TPoint3D(x, y, ground.heightAt(x, y));
    };
    for (int radius = 10; radius <= 60; radius += 10) {
        for (int k = 0; k < 72; ++k) rings->appendLine(at(radius, k), at(radius, k + 1));
    }
    rings->setColor_u8(120, 120, 130);
    rings->setName("range_rings");
    scene.insert(rings);
}

/// What is cut out of the rectangle; nothing where it is all searched.
void addRegion(COpenGLScene& scene, const RegionParams& region, const GroundModel& ground) {
    const RegionParams whole;
    if (region.outline == whole.outline && region.excluded == whole.excluded) return;
    const auto searched = mrpt::opengl::CSetOfLines::Create(), excluded = mrpt::opengl::CSetOfLines::Create();
    searched->setName("region");
    searched->setColor_u8(kRegionColor);
    drawSearched(region, ground, *searched);
    excluded->setName("excluded");
    excluded->setColor_u8(kExcludedColor);
    drawExcluded(region, ground, *excluded);
    scene.insert(searched);
    scene.insert(excluded);
}

}  // namespace

double distanceTo(const OrientedBox& box) {
    const double c = std::cos(box.yaw);
    const double s = std::sin(box.yaw);
    const double along = std::abs(c * box.center.x() + s * box.center.y()) - box.size.x() / 2;
    const double across = std::abs(-s * box.center.x() + c * box.center.y()) - box.size.y() / 2;
    return std::hypot(std::max(along, 0.0), std::max(across, 0.0));
}

mrpt::opengl::COpenGLScene::Ptr toScene(const PointCloud& cloud, const DetectionResult& result,
                                        const SceneOptions& options) {
    const Painting painting = paint(cloud, result, options);
    auto scene = COpenGLScene::Create();
    scene->getViewport()->setCustomBackgroundColor({0.06F, 0.07F, 0.09F});
    addGrid(*scene, result, options.grid_depth);
    addEgo(*scene, result.ground);
    if (!options.own_body.empty()) {
        const auto lines = ownBodyLines();
        drawOwnBody(options.own_body, result.ground, *lines);
        scene->insert(lines);
    }
    addRegion(*scene, options.region, result.ground);
    addPoints(*scene, cloud, painting);
    if (options.explain) addMerges(*scene, cloud, result);
    for (const Obstacle& o : result.obstacles) {
        addObstacle(*scene, o, options);
        if (options.explain) addEvidence(*scene, o, result.ground);
    }
    return scene;
}

}  // namespace lidar_obstacles
