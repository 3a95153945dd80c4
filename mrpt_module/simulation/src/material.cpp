// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/material.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lidar_obstacles::simulation {
namespace {

constexpr double kDensestLeaves = 0.01, kLeafStep = 1.4;  ///< free path of the first level [m]; from level to level
constexpr auto kFirstLeaves = static_cast<std::size_t>(Material::Leaves);

Optics diffuse(double reflectivity) { return {reflectivity}; }

Optics polished(double reflectivity, double loss) {
    Optics optics{reflectivity};
    optics.loss = loss;
    return optics;
}

Optics leafOptics(int level) {
    Optics optics{0.45};
    optics.free_path = kDensestLeaves * std::pow(kLeafStep, level);
    return optics;
}

/// Reflectivities near 905 nm, rounded: asphalt and rubber are dark, leaves and cloth bright in the near infrared.
/// In the order of the materials.
std::array<Optics, kFirstLeaves + kLeafLevels> makeTable() {
    std::array<Optics, kFirstLeaves + kLeafLevels> table{
        diffuse(0.17),                         // Asphalt
        diffuse(0.35),                         // Concrete
        diffuse(0.35),                         // Grass
        diffuse(0.60),                         // PaintLight
        diffuse(0.12),                         // PaintDark
        Optics{0.30, 0.65, 0.0, false, true},  // Glass
        diffuse(0.05),                         // Rubber
        diffuse(0.15),                         // Plastic
        diffuse(0.45),                         // Metal
        diffuse(0.40),                         // Cloth
        diffuse(0.45),                         // Skin
        diffuse(0.35),                         // Wood
        Optics{0.45, 0.25, 0.05},              // Foliage
        Optics{0.40, 0.60},                    // WireMesh
        Optics{0.90, 0.0, 0.0, true},          // Reflector
        diffuse(0.30),                         // PaintMiddle
        polished(0.05, 0.25),                  // PaintBlack
        diffuse(0.15),                         // ClothDark
        diffuse(0.25),                         // Earth
        Optics{0.40, 0.0, 0.04},               // TallGrass
        polished(0.60, 0.5),                   // Chrome
    };
    for (int level = 0; level < kLeafLevels; ++level)
        table[kFirstLeaves + static_cast<std::size_t>(level)] = leafOptics(level);
    return table;
}

}  // namespace

Material leaves(double free_path) {
    const double level = std::log(free_path / kDensestLeaves) / std::log(kLeafStep);
    const int k = std::clamp(static_cast<int>(std::lround(level)), 0, kLeafLevels - 1);
    return static_cast<Material>(static_cast<int>(kFirstLeaves) + k);
}

const Optics& opticsOf(Material m) {
    static const auto table = makeTable();
    return table[static_cast<std::size_t>(m)];
}

}  // namespace lidar_obstacles::simulation
