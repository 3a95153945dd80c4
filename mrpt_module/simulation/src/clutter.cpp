// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/clutter.h"

#include <cmath>

#include "clutter_builder.h"
#include "lidar_obstacles/simulation/random.h"
#include "plants.h"

namespace lidar_obstacles::simulation {
namespace {

using Profile = std::vector<Eigen::Vector2d>;

constexpr double kPiece = 4.0;  ///< length of the boxes that tell the truth about a line [m]
constexpr double kDepth = 0.3;  ///< how far lines go into the ground: it is not level between their poses [m]

/// How a kind of line looks.
struct LineShape {
    ObjectKind kind;
    Material material;
    double step;        ///< between cross-sections [m]
    double jitter;      ///< of the cross-sections, sideways [m]
    double post_every;  ///< 0: no posts [m]
};

LineShape shapeOf(ClutterKind kind) {
    switch (kind) {
        case ClutterKind::Fence:
            return {ObjectKind::Fence, Material::WireMesh, 2.0, 0.0, 2.5};
        case ClutterKind::Hedge:
            return {ObjectKind::Hedge, Material::Foliage, 0.4, 0.12, 0.0};
        case ClutterKind::Rail:
            return {ObjectKind::Rail, Material::Metal, 2.0, 0.0, 4.0};
        case ClutterKind::Kerb:
        case ClutterKind::Sidewalk:
            return {ObjectKind::Kerb, Material::Concrete, 1.0, 0.0, 0.0};
        default:
            return {ObjectKind::Wall, Material::Concrete, 2.0, 0.0, 0.0};
    }
}

/// Cross-section over (to the left, up). A rail is the two-wave beam that stands clear of the ground.
Profile profileOf(const ClutterSpec& spec) {
    const double w = 0.5 * spec.width, h = spec.height;
    if (spec.kind == ClutterKind::Rail)
        return {{-w, h}, {w, h - 0.06}, {w, h - 0.10}, {-w, h - 0.155}, {w, h - 0.21}, {w, h - 0.25}, {-w, h - 0.31}};
    return {{-w, -kDepth}, {-w, h}, {w, h}, {w, -kDepth}};
}

}  // namespace

bool isDrivable(ClutterKind kind) {
    return kind == ClutterKind::Kerb || kind == ClutterKind::Sidewalk || kind == ClutterKind::Ramp;
}

Clutter buildClutter(const std::vector<ClutterSpec>& specs, bool drivable, const Track& track, const Ground& ground) {
    ClutterBuilder builder(track, ground);
    for (std::size_t i = 0; i < specs.size(); ++i)
        if (isDrivable(specs[i].kind) == drivable) builder.add(specs[i], -1 - static_cast<std::int32_t>(i));
    return builder.take();
}

double ClutterBuilder::heightAt(const ClutterSpec& spec, const Eigen::Vector2d& place) const {
    if (const auto z = ground_.heightAt(place)) return *z;
    throw ScenarioError("clutter at s = " + std::to_string(spec.from) + ", d = " + std::to_string(spec.d) +
                        " lies beside the terrain; enlarge terrain.reach");
}

Eigen::Isometry3d ClutterBuilder::poseAlong(const ClutterSpec& spec, double s, double d) const {
    const Eigen::Vector2d place = track_.place(s, d);
    return uprightPose({place.x(), place.y(), heightAt(spec, place)}, track_.at(s).heading);
}

Eigen::Isometry3d ClutterBuilder::poseAt(const ClutterSpec& spec) const {
    return poseAlong(spec, spec.from, spec.d) * Eigen::AngleAxisd(spec.yaw, Eigen::Vector3d::UnitZ());
}

std::vector<Eigen::Isometry3d> ClutterBuilder::posesAlong(const ClutterSpec& spec, double step) const {
    const int n = std::max(1, static_cast<int>(std::lround((spec.to - spec.from) / step)));
    const double jitter = shapeOf(spec.kind).jitter;
    std::vector<Eigen::Isometry3d> poses;
    for (int i = 0; i <= n; ++i) {
        Random random(spec.variant, static_cast<std::uint64_t>(i));
        const double d = spec.d + random.uniform(-jitter, jitter);
        poses.push_back(poseAlong(spec, spec.from + (spec.to - spec.from) * i / n, d));
    }
    return poses;
}

void ClutterBuilder::place(const Eigen::Isometry3d& pose, const Part& part) {
    const Eigen::AlignedBox3d bounds = boundsOf(part.mesh);
    const Eigen::Vector3d ahead = pose.linear().col(0);
    const char* type = part.type ? part.type : nameOf(part.kind);
    clutter_.boxes.push_back({type, pose * bounds.center(), bounds.sizes(), std::atan2(ahead.y(), ahead.x())});
    append(clutter_.mesh, part.mesh, pose);
    label(part.kind);
}

/// Labels the triangles added since the last call. The level part of a kerb or sidewalk is ground.
void ClutterBuilder::label(ObjectKind kind) {
    constexpr float kLevel = 0.8f;
    const Mesh& mesh = clutter_.mesh;
    for (std::size_t t = clutter_.labels.size(); t < mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const Eigen::Vector3f normal =
            (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]).normalized();
        const bool level = kind == ObjectKind::Kerb && std::abs(normal.z()) > kLevel;
        clutter_.labels.push_back({id_, level ? ObjectKind::Ground : kind});
    }
}

void ClutterBuilder::addBoxesAlong(const ClutterSpec& spec, ObjectKind kind, double width) {
    const int n = std::max(1, static_cast<int>(std::lround((spec.to - spec.from) / kPiece)));
    const Eigen::Vector3d up(0.0, 0.0, 0.5 * spec.height);
    for (int i = 0; i < n; ++i) {
        const double length = (spec.to - spec.from) / n, s = spec.from + i * length;
        const Eigen::Vector3d begin = poseAlong(spec, s, spec.d) * up, end = poseAlong(spec, s + length, spec.d) * up;
        const Eigen::Vector3d chord = end - begin;
        clutter_.boxes.push_back({nameOf(kind),
                                  0.5 * (begin + end),
                                  {chord.head<2>().norm(), width, spec.height},
                                  std::atan2(chord.y(), chord.x())});
    }
}

void ClutterBuilder::addPosts(const ClutterSpec& spec, double every) {
    const double radius = 0.04, h = spec.height;
    const Eigen::Vector3d foot(0.0, 0.0, -kDepth), top(0.0, 0.0, h - 0.02);
    const Mesh post = rodMesh({foot, top, radius, radius}, Material::Metal, 6);
    for (double s = spec.from; s <= spec.to; s += every) append(clutter_.mesh, post, poseAlong(spec, s, spec.d));
}

/// Pieces that overlap a little.
void ClutterBuilder::addHedge(const ClutterSpec& spec) {
    constexpr double kLength = 2.0, kOverlap = 0.3;
    const int n = std::max(1, static_cast<int>(std::lround((spec.to - spec.from) / kLength)));
    const double length = (spec.to - spec.from) / n;
    for (int i = 0; i < n; ++i)
        append(clutter_.mesh, hedgePiece(spec, length + kOverlap, static_cast<std::uint64_t>(i)),
               poseAlong(spec, spec.from + (i + 0.5) * length, spec.d));
    addBoxesAlong(spec, ObjectKind::Hedge, spec.width);
    label(ObjectKind::Hedge);
}

void ClutterBuilder::addLine(const ClutterSpec& spec) {
    if (spec.kind == ClutterKind::Hedge && spec.leaves > 0.0) return addHedge(spec);
    const LineShape shape = shapeOf(spec.kind);
    append(clutter_.mesh, sweepMesh(posesAlong(spec, shape.step), profileOf(spec), shape.material));
    addBoxesAlong(spec, shape.kind, spec.width);
    if (shape.post_every > 0.0) addPosts(spec, shape.post_every);
    label(shape.kind);
}

void ClutterBuilder::add(const ClutterSpec& spec, std::int32_t id) {
    id_ = id;
    const std::vector<Part> parts = partsOf(spec);
    for (const Part& part : parts) place(poseAt(spec), part);
    if (parts.empty()) addLine(spec);
}

}  // namespace lidar_obstacles::simulation
