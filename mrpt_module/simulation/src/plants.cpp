// SPDX-License-Identifier: BSD-3-Clause
#include "plants.h"

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/simulation/random.h"

namespace lidar_obstacles::simulation {
namespace {

using Eigen::Vector3d;

/// Names of the streams of numbers of a plant.
enum Stream : std::uint64_t { kSurface = 201, kForm = 202, kLobe = 203, kStem = 204 };

/// sign(x) |x|^e: the power of a superellipse.
double power(double x, double e) { return std::copysign(std::pow(std::abs(x), e), x); }

/// A point of a superellipsoid of half axes 1.
Vector3d onUnitBody(const LeafBody& body, double polar, double azimuth) {
    const double e = 1.0 - 0.75 * body.squareness;
    const double ring = power(std::sin(polar), e), z = power(std::cos(polar), e);
    const double narrow = 1.0 - 0.5 * body.taper * (1.0 + z);
    return {narrow * ring * power(std::cos(azimuth), e), narrow * ring * power(std::sin(azimuth), e), z};
}

/// As large as the plant.
LeafBody bodyOf(const ClutterSpec& spec) {
    LeafBody body;
    // A quarter of it is in the ground, or it would stand on a point.
    constexpr double kSunk = 0.25;
    body.half = {0.5 * (spec.length > 0.0 ? spec.length : spec.width), 0.5 * spec.width,
                 0.5 * (1.0 + kSunk) * spec.height};
    body.center = {0.0, 0.0, 0.5 * (1.0 - kSunk) * spec.height};
    body.roughness = spec.roughness;
    body.variant = spec.variant;
    return body;
}

/// Lobes of about `share` of the size of `whole`, strewn within it, each of them reaching its underside if `standing`.
Mesh lobes(const LeafBody& whole, int count, bool standing, Material m) {
    Mesh mesh;
    for (int k = 0; k < count; ++k) {
        Random random(whole.variant, kLobe, static_cast<std::uint64_t>(k));
        const double share = random.uniform(0.5, 0.75), angle = 2.0 * M_PI * (k + random.uniform(0.0, 0.6)) / count;
        LeafBody lobe = whole;
        lobe.half = whole.half * share;
        const double away = (1.0 - share) * random.uniform(0.7, 1.0);
        lobe.center.x() += whole.half.x() * away * std::cos(angle);
        lobe.center.y() += whole.half.y() * away * std::sin(angle);
        const double low = whole.center.z() - whole.half.z(), room = 2.0 * (whole.half.z() - lobe.half.z());
        if (standing) lobe.half.z() = whole.half.z() * random.uniform(0.6, 1.0);
        lobe.center.z() = low + lobe.half.z() + (standing ? 0.0 : room * random.uniform(0.0, 1.0));
        lobe.variant = whole.variant * 31 + static_cast<std::uint64_t>(k);
        append(mesh, leafMesh(lobe, m));
    }
    return mesh;
}

Mesh stem(const ClutterSpec& spec, double height) {
    Random random(spec.variant, kStem);
    const double radius = (0.012 * spec.height + 0.03) * random.uniform(0.7, 1.6);
    const Vector3d top(random.uniform(-0.03, 0.03) * height, random.uniform(-0.03, 0.03) * height, height);
    Mesh mesh = rodMesh({{0.0, 0.0, -0.3}, top, 1.3 * radius, 0.8 * radius}, Material::Wood, 8);
    return mesh;
}

/// A tree in winter, or a dead one: boughs without leaves.
Mesh bareCrown(const ClutterSpec& spec, double bottom) {
    Mesh mesh;
    Random random(spec.variant, kForm, 1);
    const Vector3d top(0.0, 0.0, spec.height);
    append(mesh, rodMesh({{0.0, 0.0, bottom - 0.1}, top, 0.06, 0.02}, Material::Wood, 6));
    for (int k = 0; k < 14; ++k) {
        const double angle = 2.4 * k, z = bottom + (spec.height - bottom) * random.uniform(0.0, 0.8);
        const double reach = 0.5 * spec.width * random.uniform(0.6, 1.0);
        const Vector3d end(reach * std::cos(angle), reach * std::sin(angle), std::min(z + 0.6 * reach, spec.height));
        append(mesh, rodMesh({{0.0, 0.0, z}, end, 0.035, 0.012}, Material::Wood, 5));
    }
    return mesh;
}

struct TreeForm {
    int lobes;     ///< of the crown; 0: a bare tree
    double bole;   ///< height of the crown's lower end [m]
    double taper;  ///< of the crown
};

TreeForm treeForm(const ClutterSpec& spec) {
    Random random(spec.variant, kForm);
    const double form = random.uniform(), h = spec.height;
    if (form < 0.2) return {1, random.uniform(0.02, 0.12) * h, 0.9};  // a conifer
    const double bole = std::max(0.2 * h, std::min(random.uniform(1.7, 2.6), 0.5 * h)),
                 taper = random.uniform(0.0, 0.3);
    return {form > 0.93 ? 0 : form < 0.5 ? 1 : form < 0.7 ? 4 : 7, bole, taper};
}

}  // namespace

Mesh leafMesh(const LeafBody& body, Material m) {
    using Index = std::uint32_t;
    const double around = 2.0 * M_PI * std::max(body.half.x(), body.half.y());
    const auto columns = static_cast<Index>(std::clamp(around / 0.25, 12.0, 28.0));
    const auto rows = static_cast<Index>(std::clamp(2.0 * body.half.z() / 0.2, 6.0, 14.0));
    const double size = std::max(0.05, body.half.minCoeff());
    Mesh mesh;
    for (Index r = 0; r <= rows; ++r)
        for (Index c = 0; c < columns; ++c) {
            const Vector3d unit = onUnitBody(body, M_PI * r / rows, 2.0 * M_PI * c / columns);
            const bool pole = r == 0 || r == rows;  // one place: all of its vertices move alike
            const double bump = body.roughness * Random(body.variant, kSurface, r, pole ? 0 : c).gaussian();
            const double scale = 1.0 + std::clamp(bump / size, -0.4, 0.1);
            mesh.addVertex(body.center + scale * body.half.cwiseProduct(unit));
        }
    for (Index r = 0; r < rows; ++r)
        for (Index c = 0; c < columns; ++c) {
            const Index a = r * columns + c, b = r * columns + (c + 1) % columns;
            mesh.addTriangle({a, b + columns, b}, m);
            mesh.addTriangle({a, a + columns, b + columns}, m);
        }
    return mesh;
}

double crownBottom(const ClutterSpec& spec) { return treeForm(spec).bole; }

TreeMeshes treeMeshes(const ClutterSpec& spec) {
    const TreeForm form = treeForm(spec);
    LeafBody crown = bodyOf(spec);
    crown.half.z() = 0.5 * (spec.height - form.bole);
    crown.center.z() = form.bole + crown.half.z();
    crown.taper = form.taper;
    const Material m = leaves(spec.leaves);
    TreeMeshes tree{stem(spec, form.bole + crown.half.z()), {}};
    if (form.lobes == 0)
        tree.crown = bareCrown(spec, form.bole);
    else
        tree.crown = form.lobes == 1 ? leafMesh(crown, m) : lobes(crown, form.lobes, false, m);
    return tree;
}

Mesh bushMesh(const ClutterSpec& spec) {
    Random random(spec.variant, kForm);
    const int count = static_cast<int>(random.uniform(1.0, 6.999));
    LeafBody whole = bodyOf(spec);
    whole.squareness = random.uniform(0.0, 0.4);
    if (count == 1) return leafMesh(whole, leaves(spec.leaves));
    return lobes(whole, count, true, leaves(spec.leaves));
}

Mesh shrubMesh(const ClutterSpec& spec) {
    Random random(spec.variant, kForm);
    const double form = random.uniform();
    LeafBody body = bodyOf(spec);
    if (form < 0.5) body.squareness = random.uniform(0.75, 1.0);
    if (form > 0.8) body.taper = random.uniform(0.5, 0.9);
    return leafMesh(body, leaves(spec.leaves));
}

Mesh reedMesh(const ClutterSpec& spec) {
    Mesh mesh = lobes(bodyOf(spec), 3, true, leaves(spec.leaves));
    for (int k = 0; k < 12; ++k) {
        Random random(spec.variant, kStem, static_cast<std::uint64_t>(k));
        const double reach = 0.4 * spec.width * std::sqrt(random.uniform()), angle = random.uniform(0.0, 2.0 * M_PI);
        const Vector3d foot(reach * std::cos(angle), reach * std::sin(angle), -0.1);
        const Vector3d tip = foot + Vector3d(random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1),
                                             spec.height * random.uniform(0.8, 1.0));
        append(mesh, rodMesh({foot, tip, 0.008, 0.005}, Material::Wood, 4));
    }
    return mesh;
}

Mesh hedgePiece(const ClutterSpec& spec, double length, std::uint64_t piece) {
    LeafBody body = bodyOf(spec);
    body.half.x() = 0.5 * length;
    body.squareness = 1.0;
    body.variant = spec.variant * 131 + piece;
    return leafMesh(body, leaves(spec.leaves));
}

}  // namespace lidar_obstacles::simulation
