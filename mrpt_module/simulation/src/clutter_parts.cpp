// SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include "clutter_builder.h"
#include "furniture.h"
#include "lidar_obstacles/simulation/models.h"
#include "plants.h"

namespace lidar_obstacles::simulation {
namespace {

using Eigen::Vector3d;

Mesh uprightRod(double radius, double height, Material m) {
    return rodMesh({Vector3d::Zero(), {0.0, 0.0, height}, radius, radius}, m);
}

Mesh standingBox(const ClutterSpec& spec, Material m) {
    const Vector3d half(0.5 * spec.length, 0.5 * spec.width, 0.0);
    return boxMesh(-half, half + Vector3d(0.0, 0.0, spec.height), m);
}

std::vector<Part> tree(const ClutterSpec& spec) {
    if (spec.leaves > 0.0) {
        TreeMeshes meshes = treeMeshes(spec);
        return {{ObjectKind::Tree, std::move(meshes.trunk), "trunk"}, {ObjectKind::Tree, std::move(meshes.crown)}};
    }
    const double h = spec.height, bole = 0.4 * h;
    const double radius = 0.02 * h + 0.02;
    Part crown{ObjectKind::Tree,
               ellipsoidMesh({{0.0, 0.0, 0.68 * h}, {0.5 * spec.width, 0.5 * spec.width, 0.32 * h}, 0.3, spec.variant},
                             Material::Foliage)};
    const Mesh trunk = rodMesh({Vector3d::Zero(), {0.0, 0.0, bole}, 1.2 * radius, radius}, Material::Wood);
    return {{ObjectKind::Tree, trunk, "trunk"}, crown};
}

std::vector<Part> bush(const ClutterSpec& spec) {
    if (spec.leaves > 0.0) return {{ObjectKind::Bush, bushMesh(spec)}};
    const double h = spec.height;
    return {{ObjectKind::Bush,
             ellipsoidMesh({{0.0, 0.0, 0.5 * h}, {0.5 * spec.width, 0.5 * spec.width, 0.5 * h}, 0.25, spec.variant},
                           Material::Foliage)}};
}

std::vector<Part> sign(const ClutterSpec& spec) {
    const double h = spec.height, w = 0.5 * spec.width;
    Mesh plate = boxMesh({-0.02, -w, h - spec.width}, {0.02, w, h}, Material::Reflector);
    append(plate, uprightRod(0.035, h, Material::Metal));
    return {{ObjectKind::Sign, plate, "pole"}};
}

/// Up, level, down again, along x.
std::vector<Part> ramp(const ClutterSpec& spec) {
    const double l = 0.5 * spec.length, w = 0.5 * spec.width, h = spec.height;
    const auto section = [&](double x, double z) {
        return Section{x, {{-w, -0.05}, {w, -0.05}, {w, z}, {-w, z}}, std::vector<Material>(4, Material::Concrete)};
    };
    return {{ObjectKind::Ramp, loftMesh({section(-l, 0.0), section(-0.2 * l, h), section(0.2 * l, h), section(l, 0.0)},
                                        Material::Concrete)}};
}

/// A deck across the track, `height` above it, `length` from end to end, `width` along the track, on two walls.
std::vector<Part> bridge(const ClutterSpec& spec) {
    const double half_span = 0.5 * spec.length, half_width = 0.5 * spec.width, wall = 1.0;
    std::vector<Part> parts{
        {ObjectKind::Overhead, boxMesh({-half_width, -half_span, spec.height},
                                       {half_width, half_span, spec.height + 1.2}, Material::Concrete)}};
    for (double side : {-1.0, 1.0}) {
        const double y = side * (half_span - 0.5 * wall);
        parts.push_back({ObjectKind::Wall, boxMesh({-half_width, y - 0.5 * wall, -3.0},
                                                   {half_width, y + 0.5 * wall, spec.height}, Material::Concrete)});
    }
    return parts;
}

}  // namespace

std::vector<Part> partsOf(const ClutterSpec& spec) {
    switch (spec.kind) {
        case ClutterKind::Tree:
            return tree(spec);
        case ClutterKind::Bush:
            return bush(spec);
        case ClutterKind::Pole:
            return {{ObjectKind::Pole, uprightRod(0.5 * spec.width, spec.height, Material::Metal)}};
        case ClutterKind::Bollard:
            return {{ObjectKind::Bollard, uprightRod(0.5 * spec.width, spec.height, Material::Concrete)}};
        case ClutterKind::Bin:
            return {{ObjectKind::Bin, standingBox(spec, Material::Plastic)}};
        case ClutterKind::Sign:
            return sign(spec);
        case ClutterKind::Bike:
            return {{ObjectKind::Bicycle, bicycleMesh()}};
        case ClutterKind::Building:
            return {{ObjectKind::Wall, standingBox(spec, Material::Concrete)}};
        case ClutterKind::Step:
            return {{ObjectKind::Step, standingBox(spec, Material::Concrete)}};
        case ClutterKind::Ramp:
            return ramp(spec);
        case ClutterKind::Bridge:
            return bridge(spec);
        case ClutterKind::Shrub:
            return {{ObjectKind::Bush, shrubMesh(spec)}};
        case ClutterKind::Reed:
            return {{ObjectKind::Bush, reedMesh(spec)}};
        default:
            break;
    }
    const std::vector<Part> furniture = furnitureParts(spec);
    return furniture.empty() ? barrierParts(spec) : furniture;
}

}  // namespace lidar_obstacles::simulation
