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
};

struct VehicleShape {
    std::string name;
    ObjectKind kind = ObjectKind::Car;
    Eigen::Vector3d size;
    std::vector<BodyShape> bodies;
    std::vector<double> axles;  ///< x of each [m]
    double wheel_radius = 0.32;
    Eigen::Vector3d mirror;  ///< middle of the left one; it stands out of the box
};

Model vehicleModel(const VehicleShape& shape);

/// Every vehicle there is.
const std::vector<VehicleShape>& vehicleShapes();

}  // namespace lidar_obstacles::simulation
