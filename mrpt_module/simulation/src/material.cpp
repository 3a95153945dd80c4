#include "lidar_obstacles/simulation/material.h"

namespace lidar_obstacles::simulation {

const Optics& opticsOf(Material m) {
    // Reflectivities near 905 nm, rounded: asphalt and rubber are dark, leaves and cloth bright in the near infrared.
    static const Optics asphalt{0.17}, concrete{0.35}, grass{0.35}, paint_light{0.60}, paint_dark{0.12}, rubber{0.05},
        plastic{0.15}, metal{0.45}, cloth{0.40}, skin{0.45}, wood{0.35};
    static const Optics glass{0.30, 0.65, 0.0, false, true}, foliage{0.45, 0.25, 0.05}, wire_mesh{0.40, 0.60},
        reflector{0.90, 0.0, 0.0, true};
    switch (m) {
        case Material::Asphalt:
            return asphalt;
        case Material::Concrete:
            return concrete;
        case Material::Grass:
            return grass;
        case Material::PaintLight:
            return paint_light;
        case Material::PaintDark:
            return paint_dark;
        case Material::Glass:
            return glass;
        case Material::Rubber:
            return rubber;
        case Material::Plastic:
            return plastic;
        case Material::Metal:
            return metal;
        case Material::Cloth:
            return cloth;
        case Material::Skin:
            return skin;
        case Material::Wood:
            return wood;
        case Material::Foliage:
            return foliage;
        case Material::WireMesh:
            return wire_mesh;
        case Material::Reflector:
            return reflector;
    }
    return concrete;
}

}  // namespace lidar_obstacles::simulation
