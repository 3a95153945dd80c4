// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/output/own_body_lines.h"

#include <cmath>

namespace lidar_obstacles {

mrpt::opengl::CSetOfLines::Ptr ownBodyLines() {
    auto lines = mrpt::opengl::CSetOfLines::Create();
    lines->setColor_u8(mrpt::img::TColor(120, 170, 255));
    lines->setLineWidth(2.F);
    lines->setName("own_body");
    return lines;
}

void drawOwnBody(const OwnBody& body, const GroundModel& ground, mrpt::opengl::CSetOfLines& lines) {
    constexpr double kDrawnHeight = 1.5;  // where the part says none [m]
    lines.clear();
    for (const OwnPart& part : body.parts()) {
        const double floor = ground.heightAt(part.outline.front().x(), part.outline.front().y());
        const double low = std::isfinite(part.z_min) ? part.z_min : floor;
        const double high = std::isfinite(part.z_max) ? part.z_max : floor + kDrawnHeight;
        for (std::size_t k = 0; k < part.outline.size(); ++k) {
            const Eigen::Vector2d& a = part.outline[k];
            const Eigen::Vector2d& b = part.outline[(k + 1) % part.outline.size()];
            lines.appendLine(a.x(), a.y(), low, b.x(), b.y(), low);
            lines.appendLine(a.x(), a.y(), high, b.x(), b.y(), high);
            lines.appendLine(a.x(), a.y(), low, a.x(), a.y(), high);
        }
    }
}

}  // namespace lidar_obstacles
