// SPDX-License-Identifier: BSD-3-Clause
#include "furniture.h"

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/simulation/random.h"
#include "plants.h"

namespace lidar_obstacles::simulation {
namespace {

using Eigen::Vector3d;

Mesh bench(const ClutterSpec& spec) {
    Assembly a(spec);
    const double seat = std::min(0.45, 0.6 * a.h);
    a.box({-a.l, -a.w, seat - 0.05}, {a.l, a.w, seat}, Material::Wood);
    if (spec.variant % 3 != 0) a.box({-a.l, -a.w, seat + 0.1}, {a.l, 0.05 - a.w, a.h}, Material::Wood);
    a.legs(0.0, seat, 0.15, 0.03);
    return a.take();
}

/// A chair at a table; `side` (-1 or 1): its back is there, away from the table.
void addChair(Assembly& a, double x, double y, double side) {
    a.box({x - 0.2, y - 0.2, 0.41}, {x + 0.2, y + 0.2, 0.45}, Material::Plastic);
    a.box({x - 0.2, y + 0.18 * side, 0.45}, {x + 0.2, y + 0.21 * side, 0.85}, Material::Plastic);
    a.rod({x, y, 0.0}, {x, y, 0.42}, 0.03, Material::Metal);
}

/// With two benches or with chairs around it.
Mesh table(const ClutterSpec& spec) {
    Assembly a(spec);
    const double top = std::min(0.75, a.h);
    a.box({-0.6 * a.l, -0.5 * a.w, top - 0.04}, {0.6 * a.l, 0.5 * a.w, top}, Material::Wood);
    a.rod({0.0, 0.0, 0.0}, {0.0, 0.0, top}, 0.05, Material::Metal);
    for (double side : {-1.0, 1.0}) {
        const double y = side * (a.w - 0.2);
        if (spec.variant % 2 == 0) {
            a.box({-a.l, y - 0.18, 0.4}, {a.l, y + 0.18, 0.45}, Material::Wood);
        } else {
            for (double x : {-0.5 * a.l, 0.5 * a.l}) addChair(a, x, y, side);
        }
    }
    if (spec.variant % 5 == 1) {  // a sunshade
        a.rod({0.0, 0.0, top}, {0.0, 0.0, 2.4}, 0.025, Material::Metal);
        Mesh mesh = a.take();
        append(mesh, rodMesh({{0.0, 0.0, 2.1}, {0.0, 0.0, 2.5}, std::max(a.l, a.w), 0.05}, Material::Cloth, 8));
        return mesh;
    }
    return a.take();
}

/// Closed, with a roof that stands out and a hatch.
Mesh kiosk(const ClutterSpec& spec) {
    Assembly a(spec);
    a.box({-a.l, -a.w, 0.0}, {a.l, a.w, a.h - 0.15}, spec.variant % 2 == 0 ? Material::PaintMiddle : Material::Wood);
    a.box({-a.l - 0.25, -a.w - 0.25, a.h - 0.15}, {a.l + 0.25, a.w + 0.25, a.h}, Material::PaintDark);
    a.box({-0.7 * a.l, a.w, 1.0}, {0.7 * a.l, a.w + 0.3, 1.06}, Material::Wood);
    return a.take();
}

/// Of a bus stop: glass at the back and the ends, a roof, a seat.
Mesh shelter(const ClutterSpec& spec) {
    Assembly a(spec);
    a.legs(0.0, a.h, 0.05, 0.04);
    a.box({-a.l, -a.w, a.h - 0.12}, {a.l, a.w, a.h}, Material::Metal);
    a.box({-a.l, -a.w, 0.15}, {a.l, 0.02 - a.w, a.h - 0.3}, Material::Glass);
    a.box({a.l - 0.06, -a.w, 0.15}, {a.l, 0.6 * a.w, a.h - 0.3},
          spec.variant % 2 == 0 ? Material::Glass : Material::PaintLight);
    a.box({-0.6 * a.l, -a.w + 0.2, 0.42}, {0.6 * a.l, -a.w + 0.55, 0.47}, Material::Metal);
    return a.take();
}

/// A stack of boxes, the upper ones smaller and turned a little.
Mesh crates(const ClutterSpec& spec) {
    Mesh mesh;
    Random random(spec.variant, 301);
    const int layers = 1 + static_cast<int>(spec.height / 0.7);
    const double step = spec.height / layers;
    for (int k = 0; k < layers; ++k) {
        const double share = k == 0 ? 1.0 : random.uniform(0.6, 1.0), l = 0.5 * spec.length * share,
                     w = 0.5 * spec.width * share;
        const Material m = random.uniform() < 0.5 ? Material::Wood : Material::Plastic;
        const double yaw = k == 0 ? 0.0 : random.uniform(-0.1, 0.1) * share;
        append(mesh, boxMesh({-l, -w, 0.0}, {l, w, step}, m), uprightPose({0.0, 0.0, k * step}, yaw));
    }
    return mesh;
}

/// A heap of earth, gravel or snow: no beam gets into it.
Mesh pile(const ClutterSpec& spec) {
    LeafBody body{{0.0, 0.0, 0.0}, {0.5 * spec.length, 0.5 * spec.width, spec.height}, 0.0, 0.5, spec.roughness, 0};
    body.variant = spec.variant;
    return leafMesh(body, Material::Earth);
}

/// An open skip: its ends lean outwards.
Mesh skip(const ClutterSpec& spec) {
    const double l = 0.5 * spec.length, w = 0.5 * spec.width, h = spec.height;
    const auto section = [&](double x, double low) {
        return Section{x, {{-w, low}, {w, low}, {w, h}, {-w, h}}, std::vector<Material>(4, Material::PaintMiddle)};
    };
    return loftMesh({section(-l, 0.6 * h), section(-0.6 * l, 0.1), section(0.6 * l, 0.1), section(l, 0.6 * h)},
                    Material::PaintMiddle);
}

std::vector<Part> planter(const ClutterSpec& spec) {
    Assembly a(spec);
    const double rim = std::min(0.6, 0.5 * a.h);
    a.box({-a.l, -a.w, 0.0}, {a.l, a.w, rim}, Material::Concrete);
    ClutterSpec plant = spec;
    plant.length *= 0.9, plant.width *= 0.9;
    plant.leaves = std::max(plant.leaves, 0.02);
    return {{ObjectKind::Furniture, a.take()}, {ObjectKind::Bush, shrubMesh(plant)}};
}

/// A cabinet of the power or telephone company, an advertising column, a parking meter, a letter box.
Mesh cabinet(const ClutterSpec& spec) {
    Assembly a(spec);
    if (spec.variant % 3 == 0) return rodMesh({Vector3d::Zero(), {0.0, 0.0, a.h}, a.w, a.w}, Material::Concrete, 16);
    a.box({-a.l, -a.w, 0.0}, {a.l, a.w, a.h}, spec.variant % 3 == 1 ? Material::PaintMiddle : Material::Plastic);
    return a.take();
}

/// Shopping trolleys pushed into each other.
Mesh carts(const ClutterSpec& spec) {
    Assembly a(spec);
    for (double x = -a.l; x < a.l - 0.5; x += 0.25) {
        a.rod({x, -a.w, 1.0}, {x, a.w, 1.0}, 0.015, Material::Chrome);
        a.rod({x, -a.w, 0.1}, {x, -a.w, 1.0}, 0.012, Material::Chrome);
        a.rod({x, a.w, 0.1}, {x, a.w, 1.0}, 0.012, Material::Chrome);
    }
    a.box({-a.l, -a.w, 0.45}, {a.l, a.w, 0.95}, Material::WireMesh);
    a.box({-a.l, -0.8 * a.w, 0.1}, {a.l, 0.8 * a.w, 0.16}, Material::Metal);
    return a.take();
}

Mesh scooter(const ClutterSpec& spec) {
    Assembly a(spec);
    const double x = a.l - 0.12;
    a.box({-a.l + 0.1, -0.08, 0.12}, {x, 0.08, 0.16}, Material::PaintDark);
    a.rod({x, 0.0, 0.12}, {x - 0.12, 0.0, a.h}, 0.025, Material::Metal);
    a.rod({x - 0.12, -a.w, a.h - 0.02}, {x - 0.12, a.w, a.h - 0.02}, 0.018, Material::Rubber);
    for (double hub : {-a.l + 0.12, x}) a.rod({hub, -0.025, 0.11}, {hub, 0.025, 0.11}, 0.11, Material::Rubber);
    return a.take();
}

/// A pole with an arm over the road.
Mesh lamp(const ClutterSpec& spec) {
    Assembly a(spec);
    a.rod({0.0, 0.0, -0.2}, {0.0, 0.0, a.h}, a.w, Material::Metal);
    a.rod({0.0, 0.0, a.h - 0.05}, {0.0, 1.5, a.h}, 0.04, Material::Metal);
    a.box({-0.15, 1.2, a.h - 0.05}, {0.15, 1.8, a.h + 0.05}, Material::Plastic);
    return a.take();
}

/// A board on two posts.
Mesh board(const ClutterSpec& spec) {
    Assembly a(spec);
    a.box({-0.03, -a.w, 0.45 * a.h}, {0.03, a.w, a.h}, spec.variant % 2 == 0 ? Material::Reflector : Material::Wood);
    for (double side : {-0.8, 0.8}) a.rod({0.0, side * a.w, 0.0}, {0.0, side * a.w, a.h}, 0.04, Material::Metal);
    return a.take();
}

Mesh cone(const ClutterSpec& spec) {
    Assembly a(spec);
    a.box({-a.w, -a.w, 0.0}, {a.w, a.w, 0.04}, Material::Rubber);
    Mesh mesh = a.take();
    append(mesh, rodMesh({{0.0, 0.0, 0.04}, {0.0, 0.0, a.h}, 0.7 * a.w, 0.03}, Material::Plastic));
    return mesh;
}

}  // namespace

void Assembly::box(const Vector3d& low, const Vector3d& high, Material m) { append(mesh_, boxMesh(low, high, m)); }

void Assembly::rod(const Vector3d& a, const Vector3d& b, double radius, Material m) {
    append(mesh_, rodMesh({a, b, radius, radius}, m, 8));
}

void Assembly::legs(double from, double to, double inset, double radius) {
    for (double x : {inset - l, l - inset})
        for (double y : {std::min(inset, 0.5 * w) - w, w - std::min(inset, 0.5 * w)})
            rod({x, y, from}, {x, y, to}, radius, Material::Metal);
}

std::vector<Part> furnitureParts(const ClutterSpec& spec) {
    switch (spec.kind) {
        case ClutterKind::Bench:
            return {{ObjectKind::Furniture, bench(spec)}};
        case ClutterKind::Table:
            return {{ObjectKind::Furniture, table(spec)}};
        case ClutterKind::Kiosk:
            return {{ObjectKind::Furniture, kiosk(spec)}};
        case ClutterKind::Shelter:
            return {{ObjectKind::Furniture, shelter(spec)}};
        case ClutterKind::Cabinet:
            return {{ObjectKind::Furniture, cabinet(spec)}};
        case ClutterKind::Carts:
            return {{ObjectKind::Furniture, carts(spec)}};
        case ClutterKind::Planter:
            return planter(spec);
        case ClutterKind::Crate:
            return {{ObjectKind::Crate, crates(spec)}};
        case ClutterKind::Skip:
            return {{ObjectKind::Crate, skip(spec)}};
        case ClutterKind::Pile:
            return {{ObjectKind::Pile, pile(spec)}};
        case ClutterKind::Scooter:
            return {{ObjectKind::Scooter, scooter(spec)}};
        case ClutterKind::Lamp:
            return {{ObjectKind::Pole, lamp(spec)}};
        case ClutterKind::Board:
            return {{ObjectKind::Sign, board(spec)}};
        case ClutterKind::Cone:
            return {{ObjectKind::Bollard, cone(spec)}};
        default:
            return {};
    }
}

}  // namespace lidar_obstacles::simulation
