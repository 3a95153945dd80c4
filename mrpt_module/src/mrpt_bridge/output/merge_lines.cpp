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

void addMerges(mrpt::opengl::COpenGLScene& scene, const PointCloud& cloud, const DetectionResult& result) {
    const auto taken = linesOf("merges_taken", {0, 230, 64});
    const auto refused = linesOf("merges_refused", {255, 60, 60});
    for (const Merge& m : mergesOf(result.hypotheses)) {
        const auto part = [&](std::size_t k) {
            return middleOf(result.hypotheses[static_cast<std::size_t>(m.part[k])].points, cloud);
        };
        const Eigen::Vector3f a = part(0), b = part(1);
        (m.taken ? taken : refused)->appendLine(a.x(), a.y(), a.z(), b.x(), b.y(), b.z());
    }
    scene.insert(taken);
    scene.insert(refused);
}

}  // namespace lidar_obstacles
