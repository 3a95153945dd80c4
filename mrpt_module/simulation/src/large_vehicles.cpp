// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "figure.h"
#include "lidar_obstacles/simulation/random.h"
#include "vehicle_shape.h"

// Large vehicles and what they pull, in metres; every line is drawn from the front to the rear.
namespace lidar_obstacles::simulation {
namespace {

/// A box from x `front` back to x `rear`, between two heights.
BodyShape boxBody(const Stretch& along, double low, double high) {
    BodyShape body;
    body.roof = {{along.front, high}, {along.rear, high}};
    body.belt = body.roof;
    body.clearance = low;
    body.corner = 0.04;
    return body;
}

/// A cab over the engine whose front is at `front`.
BodyShape cabBody(double front, double high) {
    BodyShape cab;
    cab.roof = {{front, 0.55 * high},
                {front - 0.08, 0.62 * high},
                {front - 0.3, 0.92 * high},
                {front - 0.6, 0.98 * high},
                {front - 2.1, high}};
    cab.belt = {{front, 0.50 * high}, {front - 2.1, 0.55 * high}};
    cab.clearance = 0.45;
    cab.corner = 0.2;
    cab.tumblehome = 0.04;
    cab.windows = {{front - 0.3, front - 1.3}};
    cab.screens = {{front - 0.08, front - 0.3}};
    return cab;
}

VehicleShape boxTruck() {
    return {"box_truck",        ObjectKind::Truck,
            {6.60, 2.20, 3.10}, {cabBody(3.30, 2.30), boxBody({1.10, -3.30}, 0.85, 3.10)},
            {2.30, -1.90},      0.40,
            {3.05, 1.22, 1.70}};
}

/// A tractor unit and its trailer.
VehicleShape semiTrailer() {
    BodyShape frame = boxBody({6.10, -8.00}, 0.80, 1.20);
    frame.width = 0.5;
    frame.paint = Material::PaintDark;
    return {"semi_trailer",
            ObjectKind::Truck,
            {16.50, 2.55, 4.00},
            {cabBody(8.25, 3.60), boxBody({5.60, -8.25}, 1.15, 4.00), frame},
            {6.85, 3.20, -4.60, -5.90, -7.20},
            0.50,
            {7.95, 1.38, 2.20}};
}

VehicleShape truckAndTrailer() {
    BodyShape bar = boxBody({1.60, -1.60}, 0.60, 0.75);
    bar.width = 0.1;
    return {"truck_and_trailer",
            ObjectKind::Truck,
            {18.00, 2.55, 3.80},
            {cabBody(9.00, 3.10), boxBody({6.80, 1.00}, 1.10, 3.80), boxBody({-0.60, -9.00}, 1.10, 3.80), bar},
            {7.60, 3.00, -2.00, -6.90},
            0.48,
            {8.70, 1.38, 2.00}};
}

VehicleShape dumpTruck() {
    BodyShape tub;
    tub.roof = {{1.30, 2.70}, {1.20, 2.30}, {-3.70, 2.30}};
    tub.belt = tub.roof;
    tub.clearance = 1.05;
    tub.corner = 0.05;
    return {"dump_truck", ObjectKind::Truck, {7.40, 2.50, 3.00}, {cabBody(3.70, 3.00), tub}, {2.40, -1.20, -2.50},
            0.50,         {3.45, 1.35, 2.00}};
}

VehicleShape tram() {
    BodyShape body;
    body.roof = {{14.0, 0.90},  {13.6, 2.00},  {13.0, 3.20},  {12.0, 3.45},
                 {-12.0, 3.45}, {-13.0, 3.20}, {-13.6, 2.00}, {-14.0, 0.90}};
    body.belt = {{14.0, 0.90}, {13.4, 1.25}, {-13.4, 1.25}, {-14.0, 0.90}};
    body.clearance = 0.15;
    body.corner = 0.7;
    body.windows = {{13.0, 8.0}, {7.0, 1.0}, {0.0, -6.0}, {-7.0, -13.0}};
    body.screens = {{13.6, 13.0}, {-13.0, -13.6}};
    return {"tram", ObjectKind::Tram, {28.0, 2.40, 3.45}, {body}, {10.0, -10.0}, 0.30, {0.0, 0.0, 0.0}};
}

VehicleShape minibus() {
    BodyShape body;
    body.roof = {{3.50, 0.85}, {3.40, 1.10}, {2.95, 1.30}, {2.20, 2.45}, {1.50, 2.75}, {-3.40, 2.75}, {-3.50, 2.40}};
    body.belt = {{3.50, 0.85}, {2.95, 1.25}, {-3.50, 1.35}};
    body.clearance = 0.25;
    body.tumblehome = 0.08;
    body.windows = {{2.60, -3.20}};
    body.screens = {{2.95, 2.20}};
    return {"minibus", ObjectKind::Bus, {7.00, 2.10, 2.75}, {body}, {2.40, -1.90}, 0.36, {2.60, 1.16, 1.50}};
}

VehicleShape carTrailer() {
    BodyShape bar = boxBody({1.60, 1.00}, 0.42, 0.50);
    bar.width = 0.12;
    return {"trailer", ObjectKind::Trailer, {3.20, 1.60, 1.00}, {boxBody({1.00, -1.60}, 0.50, 1.00), bar}, {-0.20},
            0.30,      {0.0, 0.0, 0.0}};
}

VehicleShape caravan() {
    BodyShape body;
    body.roof = {{2.20, 1.00}, {2.15, 1.80}, {1.70, 2.55}, {-2.60, 2.55}, {-2.95, 2.00}, {-3.10, 1.00}};
    body.belt = {{2.20, 1.00}, {-3.10, 1.00}};
    body.clearance = 0.40;
    body.corner = 0.15;
    body.windows = {{1.20, 0.20}, {-0.60, -1.80}};
    BodyShape bar = boxBody({3.10, 2.10}, 0.42, 0.52);
    bar.width = 0.12;
    return {"caravan", ObjectKind::Trailer, {6.20, 2.20, 2.55}, {body, bar}, {-0.40}, 0.32, {0.0, 0.0, 0.0}};
}

BodyShape busPart(const Stretch& along) {
    BodyShape body;
    const double f = along.front, r = along.rear;
    body.roof = {{f, 0.95}, {f - 0.05, 2.85}, {f - 0.25, 3.10}, {r + 0.15, 3.10}, {r, 2.90}};
    body.belt = {{f, 0.95}, {f - 0.1, 1.15}, {r, 1.25}};
    body.clearance = 0.30;
    body.corner = 0.25;
    body.tumblehome = 0.04;
    body.windows = {{f - 0.3, 0.5 * (f + r) + 0.1}, {0.5 * (f + r) - 0.1, r + 0.5}};
    return body;
}

}  // namespace

std::vector<VehicleShape> largeVehicleShapes() {
    return {boxTruck(), semiTrailer(), truckAndTrailer(), dumpTruck(), tram(), minibus(), carTrailer(), caravan()};
}

Model articulatedBusModel(std::uint64_t variant) {
    const double bend = variant == 0 ? 0.0 : Random(variant, 421).uniform(-0.4, 0.4);
    const VehicleShape front{"",   ObjectKind::Bus,   {10.0, 2.55, 3.10}, {busPart({10.0, 0.3})}, {7.3, 1.6},
                             0.48, {9.95, 1.37, 2.20}};
    const VehicleShape rear{"",   ObjectKind::Bus, {8.0, 2.55, 3.10}, {busPart({-0.3, -8.0})}, {-4.5},
                            0.48, {0.0, 0.0, 0.0}};
    std::vector<Mesh> posture(1);
    for (const VehicleShape& part : {varied(front, variant), varied(rear, variant)}) {
        const bool turned = part.mirror.isZero();
        append(posture.front(), vehicleModel(part).postures.front(),
               uprightPose(Eigen::Vector3d::Zero(), turned ? bend : 0.0));
    }
    append(posture.front(), boxMesh({-0.5, -1.1, 0.4}, {0.5, 1.1, 2.9}, Material::ClothDark));  // the bellows
    const Eigen::Vector3d size = centre(posture);
    return {"articulated_bus", ObjectKind::Bus, size, posture, 11.0, 2.2};
}

Model tractorModel(std::uint64_t variant) {
    const double scale = variant == 0 ? 1.0 : Random(variant, 422).uniform(0.8, 1.2);
    Mesh mesh = boxMesh({0.10, -0.38, 0.65}, {2.00, 0.38, 1.50}, Material::PaintMiddle);   // bonnet
    append(mesh, boxMesh({-1.30, -0.65, 1.00}, {0.10, 0.65, 1.45}, Material::PaintDark));  // floor of the cab
    append(mesh, boxMesh({-1.25, -0.65, 1.45}, {0.08, 0.65, 2.55}, Material::Glass));
    append(mesh, boxMesh({-1.35, -0.72, 2.55}, {0.15, 0.72, 2.70}, Material::PaintMiddle));  // its roof
    append(mesh, boxMesh({-1.80, -0.30, 0.50}, {-1.30, 0.30, 0.90}, Material::Metal));
    for (double side : {-1.0, 1.0}) {
        const Eigen::Vector3d rear(-0.85, side * 0.80, 0.85), front(1.45, side * 0.75, 0.55);
        const Eigen::Vector3d half(0.0, 0.22, 0.0);
        append(mesh, rodMesh({rear - half, rear + half, 0.85, 0.85}, Material::Rubber, 20));
        append(mesh, rodMesh({front - 0.7 * half, front + 0.7 * half, 0.55, 0.55}, Material::Rubber, 16));
    }
    std::vector<Mesh> posture{scaled(std::move(mesh), scale)};
    const Eigen::Vector3d size = centre(posture);
    return {"tractor", ObjectKind::Tractor, size, posture, 2.3 * scale, 1.5 * scale};
}

}  // namespace lidar_obstacles::simulation
