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
};

struct Optics {
    double reflectivity;    ///< diffuse, 0 .. 1
    double pass = 0.0;      ///< probability that the ray goes on behind the surface: glass, leaves, wire
    double depth = 0.0;     ///< standard deviation of the range beside the sensor's own [m]: leaves
    bool retro = false;     ///< sends the light back whatever the angle: number plates, reflectors
    bool specular = false;  ///< returns nothing unless hit nearly head-on
};

const Optics& opticsOf(Material m);

}  // namespace lidar_obstacles::simulation
