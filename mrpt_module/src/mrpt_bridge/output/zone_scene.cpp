// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/zone_scene.h"

#include <mrpt/opengl/CSetOfObjects.h>
#include <mrpt/opengl/CText.h>

#include <array>
#include <cmath>

#include "mrpt_bridge/output/zone_lines.h"

namespace lidar_obstacles {
namespace {

constexpr double kAbove = 0.05;  ///< over the ground, to be seen [m]

/// The corners in the vehicle frame; empty where the pose that it takes is not known.
Outline placed(const Zone& zone, const SequenceResult& found, const Trajectory& trajectory) {
    if (zone.frame == ZoneFrame::Vehicle) return zone.polygon;
    const auto pose = trajectory.at(found.cloud.timestamp).T_world_vehicle;
    return pose ? seenFromVehicle(zone.polygon, *pose) : Outline{};
}

mrpt::opengl::CSetOfLines::Ptr linesOf(const ZoneOutline& zone, const GroundModel& ground) {
    auto lines = mrpt::opengl::CSetOfLines::Create();
    lines->setColor_u8(zone.name.empty() ? kRegionColor : zoneColor(zone.state));
    lines->setLineWidth(3.F);
    drawOutline(zone.corners, ground, *lines);
    return lines;
}

}  // namespace

Outline seenFromVehicle(const Outline& map, const Eigen::Isometry3d& T_map_vehicle) {
    const Eigen::Isometry3d T_vehicle_map = T_map_vehicle.inverse();
    Outline corners;
    corners.reserve(map.size());
    for (const Eigen::Vector2d& p : map)
        corners.emplace_back(
            (T_vehicle_map * Eigen::Vector3d(p.x(), p.y(), T_map_vehicle.translation().z())).head<2>());
    return corners;
}

mrpt::img::TColor zoneColor(ZoneState state) {
    constexpr std::array<std::array<std::uint8_t, 3>, 3> kColors{{{255, 210, 0}, {60, 230, 90}, {255, 50, 40}}};
    const auto& c = kColors[static_cast<std::size_t>(state)];
    return {c[0], c[1], c[2]};
}

void drawOutline(const Outline& corners, const GroundModel& ground, mrpt::opengl::CSetOfLines& lines) {
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Eigen::Vector2d& a = corners[k];
        const Eigen::Vector2d way = corners[(k + 1) % corners.size()] - a;
        const int pieces = std::max(1, static_cast<int>(std::ceil(way.norm())));
        for (int i = 0; i < pieces; ++i) {
            const Eigen::Vector2d p = a + way * i / pieces, q = a + way * (i + 1) / pieces;
            lines.appendLine(p.x(), p.y(), ground.heightAt(p.x(), p.y()) + kAbove, q.x(), q.y(),
                             ground.heightAt(q.x(), q.y()) + kAbove);
        }
    }
}

std::string textOf(const ZoneOutline& zone) {
    std::string text = zone.name + ": " + toString(zone.state);
    if (zone.reason != ZoneReason::None) text += std::string(" (") + toString(zone.reason) + ")";
    return text;
}

Eigen::Vector3d labelPlace(const ZoneOutline& zone, const GroundModel& ground) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& p : zone.corners) sum += p;
    const Eigen::Vector2d at = sum / static_cast<double>(std::max<std::size_t>(1, zone.corners.size()));
    return {at.x(), at.y(), ground.heightAt(at.x(), at.y()) + kAbove};
}

std::vector<ZoneOutline> outlinesOf(const ZoneMonitor& zones, const SequenceResult& found,
                                    const Trajectory& trajectory) {
    std::vector<ZoneOutline> outlines;
    outlines.reserve(zones.reports().size() + 1);
    for (std::size_t k = 0; k < zones.reports().size(); ++k) {
        const Zone& zone = zones.set().zones[k];
        Outline corners = placed(zone, found, trajectory);
        if (corners.empty()) continue;
        outlines.push_back({zone.name, zones.reports()[k].state, zones.reports()[k].reason, std::move(corners)});
    }
    if (!zones.set().vehicle.empty())
        outlines.push_back({"", ZoneState::Unknown, ZoneReason::None, zones.set().vehicle});
    return outlines;
}

void addZones(mrpt::opengl::COpenGLScene& scene, const SequenceResult& found, const Trajectory& trajectory,
              const ZoneMonitor& zones) {
    auto all = mrpt::opengl::CSetOfObjects::Create();
    all->setName("zones");
    const GroundModel& ground = found.detection.ground;
    for (const ZoneOutline& zone : outlinesOf(zones, found, trajectory)) {
        all->insert(linesOf(zone, ground));
        if (zone.name.empty()) continue;
        auto label = mrpt::opengl::CText::Create(textOf(zone));
        label->setColor_u8(zoneColor(zone.state));
        const Eigen::Vector3d at = labelPlace(zone, ground);
        label->setLocation(at.x(), at.y(), at.z());
        all->insert(label);
    }
    scene.insert(all);
}

}  // namespace lidar_obstacles
