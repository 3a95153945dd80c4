// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "furniture.h"
#include "lidar_obstacles/simulation/random.h"

namespace lidar_obstacles::simulation {
namespace {

using Eigen::Vector3d;

/// A wall with openings for doors and windows: pieces that go up, and lintels over what is open.
Mesh openWall(const ClutterSpec& spec) {
    Assembly a(spec);
    Random random(spec.variant, 311);
    for (double x = -a.l; x < a.l;) {
        const double end = std::min(a.l, x + random.uniform(0.8, 3.0));
        a.box({x, -a.w, -0.3}, {end, a.w, a.h}, Material::Concrete);
        const double gap = std::min(a.l, end + random.uniform(0.8, 2.5));
        const bool door = random.uniform() < 0.4;
        if (!door) a.box({end, -a.w, -0.3}, {gap, a.w, random.uniform(0.3, 0.6) * a.h}, Material::Concrete);
        if (a.h > 2.3) a.box({end, -a.w, 2.1}, {gap, a.w, a.h}, Material::Concrete);
        x = gap;
    }
    return a.take();
}

/// A fence of wire, upright slats, boards or level bars between posts.
Mesh panel(const ClutterSpec& spec) {
    Assembly a(spec);
    const auto form = spec.variant % 4;
    for (double x = -a.l; x <= a.l + 1e-6; x += std::max(1.0, 2.0 * a.l / std::ceil(a.l)))
        a.rod({x, 0.0, -0.3}, {x, 0.0, a.h}, 0.04, form == 2 ? Material::Wood : Material::Metal);
    if (form == 0) a.box({-a.l, -0.01, 0.05}, {a.l, 0.01, a.h}, Material::WireMesh);
    if (form == 1)
        for (double x = -a.l; x < a.l; x += 0.14) a.box({x, -0.015, 0.1}, {x + 0.05, 0.015, a.h}, Material::Metal);
    if (form == 2) a.box({-a.l, -0.015, 0.05}, {a.l, 0.015, a.h}, Material::Wood);
    if (form == 3)
        for (double z = 0.25 * a.h; z < a.h; z += 0.3 * a.h)
            a.box({-a.l, -0.03, z}, {a.l, 0.03, z + 0.1}, Material::Wood);
    return a.take();
}

/// Before a house: standards, ledgers, boards on every floor; some hung with netting.
Mesh scaffold(const ClutterSpec& spec) {
    Assembly a(spec);
    constexpr double kBay = 2.5, kFloor = 2.0;
    for (double x = -a.l; x <= a.l + 1e-6; x += kBay)
        for (double y : {-a.w, a.w}) a.rod({x, y, 0.0}, {x, y, a.h}, 0.025, Material::Metal);
    for (double z = kFloor; z <= a.h; z += kFloor) {
        a.box({-a.l, -a.w, z - 0.05}, {a.l, a.w, z}, Material::Wood);
        for (double rail : {0.5, 1.0}) a.rod({-a.l, a.w, z + rail}, {a.l, a.w, z + rail}, 0.025, Material::Metal);
    }
    for (double x = -a.l; x + kBay <= a.l + 1e-6; x += 2.0 * kBay)
        a.rod({x, a.w, 0.0}, {x + kBay, a.w, kFloor}, 0.025, Material::Metal);
    if (spec.variant % 3 == 0) a.box({-a.l, a.w + 0.05, 1.5}, {a.l, a.w + 0.06, a.h}, Material::WireMesh);
    return a.take();
}

Mesh stairs(const ClutterSpec& spec) {
    Assembly a(spec);
    const int steps = std::max(1, static_cast<int>(std::lround(a.h / 0.17)));
    for (int k = 0; k < steps; ++k) {
        const double x = -a.l + 2.0 * a.l * k / steps;
        a.box({x, -a.w, -0.3}, {a.l, a.w, a.h * (k + 1) / steps}, Material::Concrete);
    }
    if (spec.variant % 2 == 0)
        for (double y : {-a.w, a.w}) a.rod({-a.l, y, 0.9}, {a.l, y, a.h + 0.9}, 0.025, Material::Metal);
    return a.take();
}

/// Of concrete, wider below.
Mesh roadBarrier(const ClutterSpec& spec) {
    const double w = 0.5 * spec.width, h = spec.height;
    const std::vector<Eigen::Vector2d> profile{{-w, 0.0},    {w, 0.0},      {w, 0.1 * h},         {0.4 * w, 0.45 * h},
                                               {0.3 * w, h}, {-0.3 * w, h}, {-0.4 * w, 0.45 * h}, {-w, 0.1 * h}};
    const std::vector<Material> edges(profile.size(), Material::Concrete);
    return loftMesh({{-0.5 * spec.length, profile, edges}, {0.5 * spec.length, profile, edges}}, Material::Concrete);
}

}  // namespace

std::vector<Part> barrierParts(const ClutterSpec& spec) {
    switch (spec.kind) {
        case ClutterKind::OpenWall:
            return {{ObjectKind::Wall, openWall(spec)}};
        case ClutterKind::Panel:
            return {{ObjectKind::Fence, panel(spec)}};
        case ClutterKind::Scaffold:
            return {{ObjectKind::Scaffold, scaffold(spec)}};
        case ClutterKind::Stairs:
            return {{ObjectKind::Step, stairs(spec)}};
        case ClutterKind::Barrier:
            return {{ObjectKind::Rail, roadBarrier(spec)}};
        default:
            return {};
    }
}

}  // namespace lidar_obstacles::simulation
