// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What surfaces are made of, as a 905 nm lidar sees them.
#pragma once

#include <cstdint>

namespace lidar_obstacles::simulation {

enum class Material : std::uint8_t {
    Asphalt,
    Concrete,
    Grass,
    PaintLight,
    PaintDark,
    Glass,
    Rubber,
    Plastic,
    Metal,
    Cloth,
    Skin,
    Wood,
    Foliage,
    WireMesh,
    Reflector,
    PaintMiddle,
    PaintBlack,  ///< polished: part of the shots is lost
    ClothDark,
    Earth,
    TallGrass,
    Chrome,
    Leaves,  ///< the first of kLeafLevels materials, see leaves()
};

struct Optics {
    double reflectivity;    ///< diffuse, 0 .. 1
    double pass = 0.0;      ///< probability that the ray goes on behind the surface: glass, leaves, wire
    double depth = 0.0;     ///< standard deviation of the range beside the sensor's own [m]: leaves
    bool retro = false;     ///< sends the light back whatever the angle: number plates, reflectors
    bool specular = false;  ///< returns nothing unless hit nearly head-on
    double loss = 0.0;      ///< share of the shots that are sent elsewhere: polished paint
    /// > 0: not a surface but a volume full of leaves, closed, its triangles turned outwards. How deep beams get into
    /// it on average [m]; those that get further than its end go on behind it.
    double free_path = 0.0;
};

constexpr int kLeafLevels = 16;

/// The material of leaves that beams get into by about `free_path` on average [m]: 1 cm for a trimmed hedge, half a
/// metre and more for an open crown.
Material leaves(double free_path);

const Optics& opticsOf(Material m);

}  // namespace lidar_obstacles::simulation
