#include "vehicle_shape.h"

// The vehicles, in metres; every line is drawn from the front to the rear.
namespace lidar_obstacles::simulation {
namespace {

VehicleShape sedan() {
    BodyShape body;
    body.roof = {{2.30, 0.64},  {2.05, 0.74},  {1.05, 0.95},  {0.20, 1.40}, {-0.40, 1.46},
                 {-1.05, 1.41}, {-1.75, 1.06}, {-2.22, 1.02}, {-2.30, 0.88}};
    body.belt = {{2.30, 0.64}, {1.05, 0.93}, {-1.75, 1.00}, {-2.30, 0.88}};
    body.corner = 0.32;
    body.tumblehome = 0.45;
    body.windows = {{0.75, -1.45}};
    body.screens = {{1.05, 0.20}, {-1.05, -1.75}};
    return {"sedan", ObjectKind::Car, {4.60, 1.82, 1.46}, {body}, {1.40, -1.36}, 0.32, {0.72, 0.98, 1.00}};
}

VehicleShape hatchback() {
    BodyShape body;
    body.roof = {{2.00, 0.68},  {1.80, 0.80},  {1.00, 0.98},  {0.25, 1.42},
                 {-0.30, 1.50}, {-1.40, 1.45}, {-1.92, 1.00}, {-2.00, 0.60}};
    body.belt = {{2.00, 0.68}, {1.00, 0.95}, {-1.85, 1.02}, {-2.00, 0.60}};
    body.corner = 0.30;
    body.tumblehome = 0.35;
    body.windows = {{0.75, -1.50}};
    body.screens = {{1.00, 0.25}, {-1.40, -1.92}};
    body.paint = Material::PaintDark;
    return {"hatchback", ObjectKind::Car, {4.00, 1.76, 1.50}, {body}, {1.25, -1.25}, 0.31, {0.72, 0.95, 1.03}};
}

VehicleShape suv() {
    BodyShape body;
    body.roof = {{2.35, 0.80},  {2.20, 0.98},  {1.15, 1.12},  {0.45, 1.66},
                 {-0.30, 1.75}, {-1.80, 1.70}, {-2.25, 1.15}, {-2.35, 0.70}};
    body.belt = {{2.35, 0.80}, {1.15, 1.10}, {-2.20, 1.18}, {-2.35, 0.70}};
    body.clearance = 0.26;
    body.tumblehome = 0.30;
    body.windows = {{0.95, -1.95}};
    body.screens = {{1.15, 0.45}, {-1.80, -2.25}};
    return {"suv", ObjectKind::Car, {4.70, 1.92, 1.75}, {body}, {1.45, -1.40}, 0.36, {0.90, 1.03, 1.18}};
}

VehicleShape van() {
    BodyShape body;
    body.roof = {{2.75, 0.85}, {2.65, 1.05}, {2.15, 1.25}, {1.35, 2.25}, {0.60, 2.50}, {-2.65, 2.48}, {-2.75, 2.35}};
    body.belt = {{2.75, 0.85}, {2.15, 1.22}, {1.00, 1.30}, {-2.75, 1.30}};
    body.clearance = 0.24;
    body.corner = 0.28;
    body.tumblehome = 0.10;
    body.windows = {{1.85, 0.75}};
    body.screens = {{2.15, 1.35}};
    return {"van", ObjectKind::Van, {5.50, 2.00, 2.50}, {body}, {1.80, -1.60}, 0.34, {1.80, 1.09, 1.40}};
}

VehicleShape bus() {
    BodyShape body;
    body.roof = {{6.00, 0.95}, {5.95, 2.85}, {5.75, 3.10}, {-5.85, 3.10}, {-6.00, 2.90}};
    body.belt = {{6.00, 0.95}, {5.90, 1.15}, {-6.00, 1.25}};
    body.clearance = 0.30;
    body.corner = 0.25;
    body.tumblehome = 0.04;
    body.windows = {{5.70, 3.20}, {3.10, 0.10}, {0.00, -2.90}, {-3.00, -5.40}};
    body.screens = {{6.00, 5.95}};
    return {"bus", ObjectKind::Bus, {12.00, 2.55, 3.10}, {body}, {3.30, -2.90}, 0.48, {5.95, 1.37, 2.20}};
}

/// A cab, a gap, a box on a low frame: underneath one sees through.
VehicleShape truck() {
    BodyShape cab;
    cab.roof = {{4.00, 1.10}, {3.92, 1.45}, {3.60, 2.60}, {3.30, 2.85}, {2.20, 2.95}};
    cab.belt = {{4.00, 1.10}, {3.92, 1.45}, {2.20, 1.60}};
    cab.clearance = 0.45;
    cab.corner = 0.22;
    cab.tumblehome = 0.05;
    cab.windows = {{3.70, 2.70}};
    cab.screens = {{3.92, 3.60}};
    BodyShape box;
    box.roof = {{1.95, 3.40}, {-4.00, 3.40}};
    box.belt = box.roof;
    box.clearance = 1.05;
    box.corner = 0.03;
    BodyShape frame;
    frame.roof = {{2.20, 1.05}, {-3.90, 1.05}};
    frame.belt = frame.roof;
    frame.clearance = 0.75;
    frame.corner = 0.05;
    frame.paint = Material::PaintDark;
    return {"truck", ObjectKind::Truck, {8.00, 2.50, 3.40}, {cab, box, frame}, {2.95, -2.10}, 0.50, {3.75, 1.36, 1.95}};
}

}  // namespace

const std::vector<VehicleShape>& vehicleShapes() {
    static const std::vector<VehicleShape> shapes{sedan(), hatchback(), suv(), van(), bus(), truck()};
    return shapes;
}

}  // namespace lidar_obstacles::simulation
