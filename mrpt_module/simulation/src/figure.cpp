// SPDX-License-Identifier: BSD-3-Clause
#include "figure.h"

#include <cmath>

#include "lidar_obstacles/simulation/random.h"

namespace lidar_obstacles::simulation {
namespace {

using Eigen::Vector3d;

Vector3d down(double angle) { return {std::sin(angle), 0.0, -std::cos(angle)}; }

/// The upper body turned about the hips.
class Upper {
  public:
    Upper(double hip, double lean) : hip_(0.0, 0.0, hip), lean_(lean) {}

    const Vector3d& hip() const { return hip_; }
    Vector3d operator()(const Vector3d& p) const {
        if (lean_ == 0.0) return p;
        return hip_ + Eigen::AngleAxisd(lean_, Vector3d::UnitY()) * (p - hip_);
    }
    void add(Mesh& mesh, const Mesh& part) const {
        if (lean_ == 0.0) return append(mesh, part);
        append(mesh, part,
               Eigen::Translation3d(hip_) * Eigen::AngleAxisd(lean_, Vector3d::UnitY()) *
                   Eigen::Translation3d(Vector3d(-hip_)));
    }

  private:
    Vector3d hip_;
    double lean_;
};

void addLeg(Mesh& mesh, const Figure& f, double side, double lift) {
    const double leg = side * f.swing;
    const Vector3d joint(0.0, side * 0.055, lift);
    const Vector3d knee = joint + 0.25 * down(leg + f.sit);
    const Vector3d ankle = knee + 0.25 * down(leg - 0.15 + f.shin);
    addLimb(mesh, {joint, knee, 0.055, 0.042}, f.bottom);
    addLimb(mesh, {knee, ankle, 0.042, 0.030}, f.bottom);
    addLimb(mesh, {ankle, ankle + Vector3d(0.09, 0.0, -0.01), 0.028, 0.020}, Material::Rubber);
}

void addArm(Mesh& mesh, const Figure& f, double side, const Upper& upper) {
    const double arm = -0.7 * (side * f.swing) + f.reach;
    const Vector3d shoulder(0.0, side * 0.125, upper.hip().z() + 0.30);
    const Vector3d elbow = shoulder + 0.17 * Vector3d(std::sin(arm), 0.12 * side, -std::cos(arm));
    const Vector3d hand = elbow + 0.17 * down(arm + 0.3);
    addLimb(mesh, {upper(shoulder), upper(elbow), 0.032, 0.026}, f.top);
    addLimb(mesh, {upper(elbow), upper(hand), 0.026, 0.020}, Material::Skin);
}

}  // namespace

void addLimb(Mesh& mesh, const Rod& rod, Material m) { append(mesh, rodMesh(rod, m, 8)); }

void moveBy(Mesh& mesh, const Vector3d& shift) {
    for (Eigen::Vector3f& v : mesh.vertices) v += shift.cast<float>();
}

Mesh scaled(Mesh mesh, double factor) {
    for (Eigen::Vector3f& v : mesh.vertices) v *= static_cast<float>(factor);
    return mesh;
}

Vector3d centre(std::vector<Mesh>& postures) {
    Eigen::AlignedBox3d bounds;
    for (const Mesh& m : postures) bounds.extend(boundsOf(m));
    const Vector3d middle = bounds.center();
    for (Mesh& m : postures) moveBy(m, {-middle.x(), -middle.y(), -bounds.min().z()});
    return bounds.sizes();
}

Mesh figureMesh(const Figure& f) {
    const double hip = f.hip_height > 0.0 ? f.hip_height : 0.50 * std::cos(f.swing), lift = hip + 0.03;
    const Upper upper(lift, f.lean);
    Mesh mesh;
    for (double side : {-1.0, 1.0}) {
        addLeg(mesh, f, side, lift);
        addArm(mesh, f, side, upper);
    }
    const Vector3d trunk = f.bulk * Vector3d(0.075, 0.120, 0.21 / f.bulk);
    upper.add(mesh, ellipsoidMesh({{0.0, 0.0, lift + 0.16}, trunk}, f.top));
    upper.add(mesh, ellipsoidMesh({{0.01, 0.0, lift + 0.41}, {0.058, 0.048, 0.068}}, Material::Skin));
    if (f.backpack) upper.add(mesh, ellipsoidMesh({{-0.11, 0.0, lift + 0.2}, {0.07, 0.09, 0.13}}, Material::ClothDark));
    if (f.coat) {
        const double waist = 0.095 * f.bulk, hem = 0.13 * f.bulk;
        upper.add(mesh, rodMesh({{0.0, 0.0, lift + 0.28}, {0.0, 0.0, lift}, 0.085 * f.bulk, waist}, f.top, 12));
        append(mesh, rodMesh({{0.0, 0.0, lift}, lift * Vector3d::UnitZ() + 0.24 * down(f.sit), waist, hem}, f.top, 12));
    }
    return mesh;
}

Figure varied(Figure figure, std::uint64_t variant) {
    if (variant == 0) return figure;
    Random random(variant, 401);
    figure.bulk = random.uniform(1.0, 1.5);
    figure.coat = random.uniform() < 0.6;
    figure.backpack = random.uniform() < 0.2;
    figure.top = random.uniform() < 0.5 ? Material::Cloth : Material::ClothDark;
    figure.bottom = random.uniform() < 0.4 ? Material::Cloth : Material::ClothDark;
    figure.lean += random.uniform(-0.05, 0.12);
    return figure;
}

}  // namespace lidar_obstacles::simulation
