// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Vehicles as their maker draws them: a roof line, a belt line, glass, wheels.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/simulation/models.h"

namespace lidar_obstacles::simulation {

/// z over x of a line seen from the side, x falling from front to rear [m].
using SideLine = std::vector<Eigen::Vector2d>;

/// From x `front` back to x `rear`; empty if they are equal.
struct Stretch {
    double front = 0.0;
    double rear = 0.0;

    bool has(double x) const { return x < front && x > rear; }
};

/// One closed body: cab, box or a whole car.
struct BodyShape {
    SideLine roof;                 ///< upper outline: hood, windscreen, roof, boot
    SideLine belt;                 ///< lower edge of the side windows; at the roof where there are none
    double clearance = 0.2;        ///< of the underside
    double corner = 0.3;           ///< how far the front and rear corners are rounded, seen from above
    double tumblehome = 0.0;       ///< how far the sides lean inwards per metre above the belt
    std::vector<Stretch> windows;  ///< glass of the sides
    std::vector<Stretch> screens;  ///< glass of the upper outline: windscreen, rear window
    Material paint = Material::PaintLight;
    double width = 1.0;  ///< share of the vehicle's
};

struct VehicleShape {
    std::string name;
    ObjectKind kind = ObjectKind::Car;
    Eigen::Vector3d size;
    std::vector<BodyShape> bodies;
    std::vector<double> axles;  ///< x of each [m]
    double wheel_radius = 0.32;
    Eigen::Vector3d mirror;  ///< middle of the left one; it stands out of the box; 0: none
};

Model vehicleModel(const VehicleShape& shape);

/// Larger or smaller by some per cent in each direction, in another paint; the shape itself for 0.
VehicleShape varied(VehicleShape shape, std::uint64_t variant);

/// Every vehicle there is that does not bend.
const std::vector<VehicleShape>& vehicleShapes();
/// Of them those made for goods and many people, and what they pull.
std::vector<VehicleShape> largeVehicleShapes();

/// An articulated bus, bent at its joint by up to a quarter of a right angle.
Model articulatedBusModel(std::uint64_t variant);
/// A tractor: small front wheels, large rear wheels, a cab of glass.
Model tractorModel(std::uint64_t variant);

}  // namespace lidar_obstacles::simulation
