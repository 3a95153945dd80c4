// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "lidar_obstacles/simulation/random.h"
#include "people_models.h"

namespace lidar_obstacles::simulation {
namespace {

using Eigen::Vector3d;

void addWheel(Mesh& mesh, const Vector3d& hub, double radius) {
    constexpr int kPieces = 16;
    const auto rim = [&](int k) {
        const double angle = 2.0 * M_PI * k / kPieces;
        return Vector3d(hub.x() + radius * std::cos(angle), hub.y(), hub.z() + radius * std::sin(angle));
    };
    for (int k = 0; k < kPieces; ++k) addLimb(mesh, {rim(k), rim(k + 1), 0.022, 0.022}, Material::Rubber);
    for (int k = 0; k < kPieces; k += 2) addLimb(mesh, {hub, rim(k), 0.005, 0.005}, Material::Metal);
}

void addRider(Mesh& mesh) {
    const Vector3d hip(-0.22, 0.0, 0.98), shoulder(0.16, 0.0, 1.42);
    const Eigen::Isometry3d lean =
        Eigen::Translation3d(0.5 * (hip + shoulder)) * Eigen::AngleAxisd(0.72, Vector3d::UnitY());
    append(mesh, ellipsoidMesh({Vector3d::Zero(), {0.13, 0.21, 0.36}}, Material::Cloth), lean);
    append(mesh, ellipsoidMesh({{0.28, 0.0, 1.64}, {0.11, 0.09, 0.12}}, Material::Plastic));
    for (double side : {-1.0, 1.0}) {
        const Vector3d joint = hip + Vector3d(0.0, 0.10 * side, 0.0);
        const Vector3d knee(0.18, 0.13 * side, 0.80 + 0.10 * side),
            foot(0.0 - 0.02 * side, 0.12 * side, 0.30 + 0.14 * side);
        addLimb(mesh, {joint, knee, 0.085, 0.065}, Material::Cloth);
        addLimb(mesh, {knee, foot, 0.065, 0.045}, Material::Cloth);
        const Vector3d arm = shoulder + Vector3d(0.02, 0.20 * side, -0.02), hand(0.46, 0.25 * side, 1.04);
        addLimb(mesh, {arm, hand, 0.048, 0.036}, Material::Cloth);
    }
}

/// What some cyclists carry: bags beside the rear wheel, a crate on the rack, a child's seat.
void addLoad(Mesh& mesh, std::uint64_t variant) {
    if (variant % 4 == 1)
        for (double side : {-1.0, 1.0})
            append(mesh,
                   boxMesh({-0.75, side * 0.15 - 0.08, 0.35}, {-0.40, side * 0.15 + 0.08, 0.75}, Material::ClothDark));
    if (variant % 4 == 2) append(mesh, boxMesh({-0.80, -0.2, 0.72}, {-0.42, 0.2, 1.05}, Material::Plastic));
    if (variant % 4 == 3) append(mesh, boxMesh({0.42, -0.2, 0.80}, {0.70, 0.2, 1.02}, Material::WireMesh));
}

void addMotorbike(Mesh& mesh) {
    for (double x : {-0.70, 0.70}) {
        const Vector3d hub(x, 0.0, 0.31), half(0.0, 0.07, 0.0);
        append(mesh, rodMesh({hub - half, hub + half, 0.31, 0.31}, Material::Rubber, 16));
    }
    append(mesh, boxMesh({-0.30, -0.17, 0.22}, {0.32, 0.17, 0.62}, Material::Metal));           // engine
    append(mesh, ellipsoidMesh({{0.12, 0.0, 0.82}, {0.34, 0.17, 0.16}}, Material::PaintDark));  // tank
    append(mesh, boxMesh({-0.80, -0.14, 0.70}, {-0.05, 0.14, 0.80}, Material::Plastic));        // seat
    append(mesh, boxMesh({-0.95, -0.10, 0.62}, {-0.70, 0.10, 0.72}, Material::Plastic));        // tail
    append(mesh, ellipsoidMesh({{0.58, 0.0, 0.92}, {0.16, 0.20, 0.18}}, Material::PaintDark));  // fairing
    for (double side : {-0.09, 0.09})
        addLimb(mesh, {{0.70, side, 0.31}, {0.48, side, 0.98}, 0.03, 0.03}, Material::Chrome);
    addLimb(mesh, {{0.42, -0.38, 1.05}, {0.42, 0.38, 1.05}, 0.02, 0.02}, Material::Metal);
    addLimb(mesh, {{-0.85, -0.18, 0.35}, {-0.10, -0.18, 0.32}, 0.05, 0.04}, Material::Chrome);
}

Model alone(const std::string& name, ObjectKind kind, Mesh mesh, double wheelbase) {
    std::vector<Mesh> posture{std::move(mesh)};
    const Vector3d size = centre(posture);
    return {name, kind, size, posture, wheelbase, 0.0};
}

double sizeOf(std::uint64_t variant) { return variant == 0 ? 1.0 : Random(variant, 404).uniform(0.9, 1.1); }

}  // namespace

Mesh bicycleMesh() {
    Mesh mesh;
    constexpr double kRadius = 0.33;
    const Vector3d rear(-0.52, 0.0, kRadius + 0.022), front(0.52, 0.0, kRadius + 0.022);
    const Vector3d crank(-0.08, 0.0, 0.30), seat(-0.26, 0.0, 0.90), head(0.36, 0.0, 0.88);
    addWheel(mesh, rear, kRadius);
    addWheel(mesh, front, kRadius);
    for (const auto& [a, b] :
         {std::pair{rear, crank}, {rear, seat}, {crank, seat}, {crank, head}, {seat, head}, {head, front}})
        addLimb(mesh, {a, b, 0.018, 0.018}, Material::PaintDark);
    const Vector3d bar(0.42, 0.0, 1.02);
    addLimb(mesh, {head, bar, 0.014, 0.014}, Material::Metal);
    addLimb(mesh, {bar + Vector3d(0.0, -0.27, 0.0), bar + Vector3d(0.0, 0.27, 0.0), 0.014, 0.014}, Material::Metal);
    append(mesh, ellipsoidMesh({seat + Vector3d(0.0, 0.0, 0.04), {0.13, 0.08, 0.04}}, Material::Plastic));
    return mesh;
}

Model cyclistModel(std::uint64_t variant) {
    Mesh mesh = bicycleMesh();
    addRider(mesh);
    if (variant == 0) return alone("cyclist", ObjectKind::Cyclist, std::move(mesh), 1.04);
    addLoad(mesh, variant);
    return alone("cyclist", ObjectKind::Cyclist, scaled(std::move(mesh), sizeOf(variant)), 1.04);
}

Model motorcycleModel(std::uint64_t variant) {
    Mesh mesh;
    addMotorbike(mesh);
    if (variant % 3 == 1) append(mesh, boxMesh({-1.05, -0.22, 0.75}, {-0.68, 0.22, 1.08}, Material::Plastic));
    return alone("motorcycle", ObjectKind::Motorcycle, scaled(std::move(mesh), sizeOf(variant)), 1.40);
}

Model motorcyclistModel(std::uint64_t variant) {
    Mesh mesh, rider;
    addMotorbike(mesh);
    addRider(rider);
    moveBy(rider, {-0.08, 0.0, -0.16});
    append(mesh, rider);
    return alone("motorcyclist", ObjectKind::Motorcyclist, scaled(std::move(mesh), sizeOf(variant)), 1.40);
}

Model scooterRiderModel(std::uint64_t variant) {
    Mesh mesh = boxMesh({-0.45, -0.09, 0.13}, {0.45, 0.09, 0.17}, Material::PaintDark);
    for (double x : {-0.48, 0.52}) {
        const Vector3d hub(x, 0.0, 0.11), half(0.0, 0.025, 0.0);
        append(mesh, rodMesh({hub - half, hub + half, 0.11, 0.11}, Material::Rubber, 12));
    }
    addLimb(mesh, {{0.52, 0.0, 0.15}, {0.38, 0.0, 1.12}, 0.025, 0.025}, Material::Metal);
    addLimb(mesh, {{0.38, -0.24, 1.12}, {0.38, 0.24, 1.12}, 0.018, 0.018}, Material::Rubber);
    Figure figure = varied({}, variant);
    figure.reach = 0.7, figure.swing = 0.15;
    Mesh person = scaled(figureMesh(figure), 1.70 * sizeOf(variant));
    moveBy(person, {-0.05, 0.0, 0.17});
    append(mesh, person);
    return alone("scooter_rider", ObjectKind::ScooterRider, std::move(mesh), 1.0);
}

Model chairUserModel(std::uint64_t variant) {
    Mesh mesh = boxMesh({-0.42, -0.28, 0.10}, {0.32, 0.28, 0.36}, Material::PaintDark);
    append(mesh, boxMesh({-0.25, -0.25, 0.42}, {0.25, 0.25, 0.52}, Material::ClothDark));
    append(mesh, boxMesh({-0.32, -0.24, 0.52}, {-0.24, 0.24, 1.10}, Material::ClothDark));
    for (double side : {-0.30, 0.30}) {
        for (double x : {-0.30, 0.28}) {
            const Vector3d hub(x, side, 0.17), half(0.0, 0.04, 0.0);
            append(mesh, rodMesh({hub - half, hub + half, 0.17, 0.17}, Material::Rubber, 12));
        }
        append(mesh, boxMesh({-0.22, side - 0.03, 0.66}, {0.20, side + 0.03, 0.70}, Material::Plastic));
    }
    if (variant % 2 == 1)
        append(mesh, boxMesh({0.48, -0.2, 0.10}, {0.60, 0.2, 0.95}, Material::PaintMiddle));  // column
    Figure figure = varied({}, variant);
    figure.sit = 1.45, figure.hip_height = 0.32, figure.reach = 0.7, figure.lean = 0.0, figure.coat = false;
    Mesh person = scaled(figureMesh(figure), 1.68);
    moveBy(person, {-0.10, 0.0, 0.0});
    append(mesh, person);
    return alone("chair_user", ObjectKind::ChairUser, scaled(std::move(mesh), sizeOf(variant)), 0.6);
}

}  // namespace lidar_obstacles::simulation
