#include "lidar_obstacles/mrpt_bridge/zone_scene.h"

#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CText.h>

#include <array>
#include <cmath>

namespace lidar_obstacles {
namespace {

constexpr double kAbove = 0.05;  ///< over the ground, to be seen [m]

mrpt::img::TColor colorOf(ZoneState state) {
    constexpr std::array<std::array<std::uint8_t, 3>, 3> kColors{{{255, 210, 0}, {60, 230, 90}, {255, 50, 40}}};
    const auto& c = kColors[static_cast<std::size_t>(state)];
    return {c[0], c[1], c[2]};
}

/// The corners in the vehicle frame; empty where the pose that it takes is not known.
Outline placed(const Zone& zone, const SequenceResult& found, const Trajectory& trajectory) {
    if (zone.frame == ZoneFrame::Vehicle) return zone.polygon;
    const auto pose = trajectory.at(found.cloud.timestamp).T_world_vehicle;
    Outline corners;
    if (!pose) return corners;
    corners.reserve(zone.polygon.size());
    const double z = pose->translation().z();
    for (const Eigen::Vector2d& p : zone.polygon)
        corners.emplace_back((pose->inverse() * Eigen::Vector3d(p.x(), p.y(), z)).head<2>());
    return corners;
}

/// A line around, on the ground; long sides follow it.
mrpt::opengl::CSetOfLines::Ptr linesOf(const Outline& corners, const GroundModel& ground,
                                       const mrpt::img::TColor& color) {
    auto lines = mrpt::opengl::CSetOfLines::Create();
    lines->setColor_u8(color);
    lines->setLineWidth(3.F);
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Eigen::Vector2d& a = corners[k];
        const Eigen::Vector2d way = corners[(k + 1) % corners.size()] - a;
        const int pieces = std::max(1, static_cast<int>(std::ceil(way.norm())));
        for (int i = 0; i < pieces; ++i) {
            const Eigen::Vector2d p = a + way * i / pieces, q = a + way * (i + 1) / pieces;
            lines->appendLine(p.x(), p.y(), ground.heightAt(p.x(), p.y()) + kAbove, q.x(), q.y(),
                              ground.heightAt(q.x(), q.y()) + kAbove);
        }
    }
    return lines;
}

Eigen::Vector2d middleOf(const Outline& corners) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : corners) sum += p;
    return sum / static_cast<double>(corners.size());
}

}  // namespace

void addZones(mrpt::opengl::COpenGLScene& scene, const SequenceResult& found, const Trajectory& trajectory,
              const ZoneMonitor& zones) {
    auto all = mrpt::opengl::CSetOfObjects::Create();
    all->setName("zones");
    const GroundModel& ground = found.detection.ground;
    for (std::size_t k = 0; k < zones.reports().size(); ++k) {
        const Zone& zone = zones.set().zones[k];
        const ZoneReport& report = zones.reports()[k];
        const Outline corners = placed(zone, found, trajectory);
        if (corners.empty()) continue;
        const mrpt::img::TColor color = colorOf(report.state);
        all->insert(linesOf(corners, ground, color));
        std::string text = zone.name + ": " + toString(report.state);
        if (report.reason != ZoneReason::None) text += std::string(" (") + toString(report.reason) + ")";
        auto label = mrpt::opengl::CText::Create(text);
        label->setColor_u8(color);
        const Eigen::Vector2d at = middleOf(corners);
        label->setLocation(at.x(), at.y(), ground.heightAt(at.x(), at.y()) + kAbove);
        all->insert(label);
    }
    if (!zones.set().vehicle.empty())
        all->insert(linesOf(zones.set().vehicle, ground, mrpt::img::TColor(120, 170, 255)));
    scene.insert(all);
}

}  // namespace lidar_obstacles
