// SPDX-License-Identifier: BSD-3-Clause
#include "exports/ply.h"

#include "exports/bytes.h"

namespace lidar_obstacles::apps {
namespace {

std::string header(std::size_t vertices, std::size_t edges, const ScanOutput& scan) {
    std::string text =
        "ply\nformat binary_little_endian 1.0\n"
        "comment obstacle-replay: scan " +
        std::to_string(scan.scan_index) + "; vehicle frame, x forward, y left, z up, metres\ncomment class:";
    for (std::size_t k = 0; k < kReturnKinds; ++k)
        text += ' ' + std::to_string(k) + '=' + toString(static_cast<ReturnKind>(k));
    return text +
           "\ncomment track: -1=of no obstacle; is_box: 1=a corner of a box, behind all returns\n"
           "element vertex " +
           std::to_string(vertices) +
           "\nproperty float x\nproperty float y\nproperty float z\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\n"
           "property uchar class\nproperty int track\nproperty float intensity\nproperty uchar is_box\n"
           "element edge " +
           std::to_string(edges) +
           "\nproperty int vertex1\nproperty int vertex2\n"
           "property uchar red\nproperty uchar green\nproperty uchar blue\n"
           "end_header\n";
}

void putColor(std::string& bytes, ReturnKind kind) {
    for (const std::uint8_t part : colorOf(kind)) putInteger(bytes, part);
}

struct Vertex {
    Eigen::Vector3f at;
    ReturnKind kind;
    std::int32_t track;
    float intensity;
    bool is_box;
};

void putVertex(std::string& bytes, const Vertex& v) {
    for (int axis = 0; axis < 3; ++axis) putFloat(bytes, v.at[axis]);
    putColor(bytes, v.kind);
    putInteger(bytes, static_cast<std::uint8_t>(v.kind));
    putInteger(bytes, v.track);
    putFloat(bytes, v.intensity);
    putInteger(bytes, static_cast<std::uint8_t>(v.is_box));
}

void putEdges(std::string& bytes, std::size_t first_corner, ReturnKind kind) {
    for (const auto& edge : boxEdges()) {
        for (const int corner : edge)
            putInteger(bytes, static_cast<std::int32_t>(first_corner + static_cast<std::size_t>(corner)));
        putColor(bytes, kind);
    }
}

}  // namespace

std::string plyText(const ScanOutput& scan) {
    const PointCloud& cloud = scan.found.cloud;
    const std::vector<Obstacle>& obstacles = scan.found.detection.obstacles;
    const ReturnLabels labels = labelReturns(scan.found);
    std::string bytes = header(cloud.size() + 8 * obstacles.size(), 12 * obstacles.size(), scan);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        const std::int32_t obstacle = labels.obstacle[i];
        const std::int32_t track = obstacle < 0 ? -1 : obstacles[static_cast<std::size_t>(obstacle)].id;
        const float intensity = cloud.intensity.empty() ? 0.0F : cloud.intensity[i];
        putVertex(bytes, {cloud.xyz[i], labels.kind[i], track, intensity, false});
    }
    for (const Obstacle& o : obstacles)
        for (const Eigen::Vector3d& corner : cornersOf(o.box))
            putVertex(bytes, {corner.cast<float>(), kindOf(o.cls), o.id, 0.0F, true});
    for (std::size_t k = 0; k < obstacles.size(); ++k) putEdges(bytes, cloud.size() + 8 * k, kindOf(obstacles[k].cls));
    return bytes;
}

}  // namespace lidar_obstacles::apps
