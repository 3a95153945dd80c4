#include "people_models.h"

#include <cmath>

namespace lidar_obstacles::simulation {
namespace {

using Eigen::Vector3d;

void addLimb(Mesh& mesh, const Rod& rod, Material m) { append(mesh, rodMesh(rod, m, 8)); }

/// A person of height 1 in mid-stride: `swing` is the angle of the legs to the vertical [rad], the arms swing against
/// them. Soles on z = 0.
Mesh figure(double swing) {
    Mesh mesh;
    const double hip = 0.50 * std::cos(swing), lift = hip + 0.03;
    for (double side : {-1.0, 1.0}) {
        const double leg = side * swing, arm = -0.7 * leg;
        const Vector3d joint(0.0, side * 0.055, lift);
        const Vector3d knee = joint + 0.25 * Vector3d(std::sin(leg), 0.0, -std::cos(leg));
        const Vector3d ankle = knee + 0.25 * Vector3d(std::sin(leg - 0.15), 0.0, -std::cos(leg - 0.15));
        addLimb(mesh, {joint, knee, 0.055, 0.042}, Material::Cloth);
        addLimb(mesh, {knee, ankle, 0.042, 0.030}, Material::Cloth);
        addLimb(mesh, {ankle, ankle + Vector3d(0.09, 0.0, -0.01), 0.028, 0.020}, Material::Rubber);
        const Vector3d shoulder(0.0, side * 0.125, lift + 0.30);
        const Vector3d elbow = shoulder + 0.17 * Vector3d(std::sin(arm), 0.12 * side, -std::cos(arm));
        const Vector3d hand = elbow + 0.17 * Vector3d(std::sin(arm + 0.3), 0.0, -std::cos(arm + 0.3));
        addLimb(mesh, {shoulder, elbow, 0.032, 0.026}, Material::Cloth);
        addLimb(mesh, {elbow, hand, 0.026, 0.020}, Material::Skin);
    }
    append(mesh, ellipsoidMesh({{0.0, 0.0, lift + 0.16}, {0.075, 0.120, 0.21}}, Material::Cloth));
    append(mesh, ellipsoidMesh({{0.01, 0.0, lift + 0.41}, {0.058, 0.048, 0.068}}, Material::Skin));
    return mesh;
}

void moveBy(Mesh& mesh, const Vector3d& shift) {
    for (Eigen::Vector3f& v : mesh.vertices) v += shift.cast<float>();
}

/// Moves the postures so that the box of all of them stands on the origin; its size.
Vector3d centre(std::vector<Mesh>& postures) {
    Eigen::AlignedBox3d bounds;
    for (const Mesh& m : postures) bounds.extend(boundsOf(m));
    const Vector3d middle = bounds.center();
    for (Mesh& m : postures) moveBy(m, {-middle.x(), -middle.y(), -bounds.min().z()});
    return bounds.sizes();
}

Mesh scaled(Mesh mesh, double factor) {
    for (Eigen::Vector3f& v : mesh.vertices) v *= static_cast<float>(factor);
    return mesh;
}

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

}  // namespace

Model personModel(const std::string& name, double height, bool walking) {
    Model model{name, ObjectKind::Pedestrian, {}, {}, 0.0, 0.0};
    constexpr int kSteps = 8;
    for (int k = 0; k < (walking ? kSteps : 1); ++k) {
        const double swing = walking ? 0.42 * std::sin(2.0 * M_PI * k / kSteps) : 0.0;
        model.postures.push_back(scaled(figure(swing), height));
    }
    model.size = centre(model.postures);
    return model;
}

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

Model cyclistModel() {
    std::vector<Mesh> posture{bicycleMesh()};
    addRider(posture.front());
    const Vector3d size = centre(posture);
    return {"cyclist", ObjectKind::Cyclist, size, posture, 1.04, 0.0};
}

}  // namespace lidar_obstacles::simulation
