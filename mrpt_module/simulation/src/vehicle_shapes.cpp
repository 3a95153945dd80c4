// SPDX-License-Identifier: BSD-3-Clause
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

VehicleShape estate() {
    BodyShape body;
    body.roof = {{2.35, 0.62},  {2.10, 0.74},  {1.15, 0.95},  {0.35, 1.40},
                 {-0.30, 1.48}, {-1.85, 1.44}, {-2.28, 1.02}, {-2.35, 0.60}};
    body.belt = {{2.35, 0.62}, {1.15, 0.93}, {-2.20, 1.02}, {-2.35, 0.60}};
    body.tumblehome = 0.40;
    body.windows = {{0.85, -1.95}};
    body.screens = {{1.15, 0.35}, {-1.85, -2.28}};
    body.paint = Material::PaintDark;
    return {"estate", ObjectKind::Car, {4.70, 1.83, 1.48}, {body}, {1.40, -1.38}, 0.33, {0.80, 0.98, 1.00}};
}

VehicleShape smallCar() {
    BodyShape body;
    body.roof = {{1.75, 0.70}, {1.65, 0.85}, {1.15, 1.02}, {0.55, 1.45}, {-0.20, 1.54}, {-1.45, 1.48}, {-1.75, 0.70}};
    body.belt = {{1.75, 0.70}, {1.15, 1.00}, {-1.65, 1.05}, {-1.75, 0.70}};
    body.corner = 0.28;
    body.tumblehome = 0.28;
    body.windows = {{0.95, -1.35}};
    body.screens = {{1.15, 0.55}, {-1.45, -1.65}};
    return {"small_car", ObjectKind::Car, {3.50, 1.62, 1.54}, {body}, {1.15, -1.18}, 0.28, {0.85, 0.88, 1.05}};
}

VehicleShape coupe() {
    BodyShape body;
    body.roof = {{2.20, 0.52}, {1.95, 0.70}, {0.95, 0.86}, {0.15, 1.22}, {-0.45, 1.27}, {-1.70, 0.98}, {-2.20, 0.80}};
    body.belt = {{2.20, 0.52}, {0.95, 0.84}, {-1.70, 0.92}, {-2.20, 0.80}};
    body.clearance = 0.14;
    body.corner = 0.40;
    body.tumblehome = 0.60;
    body.windows = {{0.55, -1.20}};
    body.screens = {{0.95, 0.15}, {-0.60, -1.70}};
    body.paint = Material::PaintBlack;
    return {"coupe", ObjectKind::Car, {4.40, 1.84, 1.27}, {body}, {1.32, -1.22}, 0.33, {0.55, 0.99, 0.92}};
}

VehicleShape pickup() {
    BodyShape cab;
    cab.roof = {{2.65, 0.85}, {2.50, 1.05}, {1.45, 1.18}, {0.80, 1.75}, {0.10, 1.80}, {-0.70, 1.74}, {-0.85, 1.15}};
    cab.belt = {{2.65, 0.85}, {1.45, 1.15}, {-0.85, 1.15}};
    cab.clearance = 0.30;
    cab.tumblehome = 0.25;
    cab.windows = {{1.25, -0.60}};
    cab.screens = {{1.45, 0.80}};
    BodyShape bed;
    bed.roof = {{-0.85, 1.12}, {-2.65, 1.12}};
    bed.belt = bed.roof;
    bed.clearance = 0.35;
    bed.corner = 0.06;
    return {"pickup", ObjectKind::Car, {5.30, 1.90, 1.80}, {cab, bed}, {1.70, -1.50}, 0.38, {1.15, 1.04, 1.20}};
}

VehicleShape minivan() {
    BodyShape body;
    body.roof = {{2.30, 0.78}, {2.15, 0.98}, {1.70, 1.12}, {0.75, 1.78}, {-0.20, 1.88}, {-2.10, 1.85}, {-2.30, 0.80}};
    body.belt = {{2.30, 0.78}, {1.70, 1.08}, {-2.25, 1.15}, {-2.30, 0.80}};
    body.tumblehome = 0.15;
    body.windows = {{1.30, -2.00}};
    body.screens = {{1.70, 0.75}, {-2.10, -2.25}};
    return {"minivan", ObjectKind::Van, {4.60, 1.83, 1.88}, {body}, {1.40, -1.40}, 0.33, {1.25, 1.00, 1.15}};
}

}  // namespace

const std::vector<VehicleShape>& vehicleShapes() {
    static const std::vector<VehicleShape> shapes = [] {
        std::vector<VehicleShape> all{sedan(),  hatchback(), suv(),     estate(), smallCar(), coupe(),
                                      pickup(), van(),       minivan(), bus(),    truck()};
        const std::vector<VehicleShape> large = largeVehicleShapes();
        all.insert(all.end(), large.begin(), large.end());
        return all;
    }();
    return shapes;
}

}  // namespace lidar_obstacles::simulation
