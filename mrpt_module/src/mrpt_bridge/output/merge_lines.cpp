// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/output/merge_lines.h"

#include <mrpt/opengl/CSetOfLines.h>

#include "lidar_obstacles/grouping.h"

namespace lidar_obstacles {
namespace {

Eigen::Vector3f middleOf(const std::vector<std::int32_t>& points, const PointCloud& cloud) {
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const std::int32_t i : points) sum += cloud.xyz[i];
    return sum / static_cast<float>(std::max<std::size_t>(1, points.size()));
}

mrpt::opengl::CSetOfLines::Ptr linesOf(const char* name, const mrpt::img::TColor& color) {
    auto lines = mrpt::opengl::CSetOfLines::Create();
    lines->setColor_u8(color);
    lines->setLineWidth(2.F);
    lines->setName(name);
    return lines;
}

}  // namespace

std::size_t drawMerges(const PointCloud& cloud, const DetectionResult& result,
                       const std::array<mrpt::opengl::CSetOfLines*, 2>& lines) {
    const std::vector<Merge> merges = mergesOf(result.hypotheses);
    for (const Merge& m : merges) {
        const auto part = [&](std::size_t k) {
            return middleOf(result.hypotheses[static_cast<std::size_t>(m.part[k])].points, cloud);
        };
        const Eigen::Vector3f a = part(0), b = part(1);
        lines[m.taken ? 1 : 0]->appendLine(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    }
    return merges.size();
}

void addMerges(mrpt::opengl::COpenGLScene& scene, const PointCloud& cloud, const DetectionResult& result) {
    const auto refused = linesOf("merges_refused", kMergeColors[0]);
    const auto taken = linesOf("merges_taken", kMergeColors[1]);
    drawMerges(cloud, result, {refused.get(), taken.get()});
    scene.insert(taken);
    scene.insert(refused);
}

}  // namespace lidar_obstacles
