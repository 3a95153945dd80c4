// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_shape.h"

#include <algorithm>
#include <cmath>

#include "lidar_obstacles/simulation/random.h"

namespace lidar_obstacles::simulation {
namespace {

constexpr double kStation = 0.12;     ///< distance of the sections of a body [m]
constexpr double kWheelWidth = 0.21;  ///< [m]
constexpr double kArchGap = 0.06;     ///< between tyre and wheel arch [m]

/// z of a side line at x; its end values beyond.
double heightOn(const SideLine& line, double x) {
    if (x >= line.front().x()) return line.front().y();
    for (std::size_t i = 1; i < line.size(); ++i) {
        const Eigen::Vector2d &a = line[i - 1], &b = line[i];
        if (x >= b.x()) return b.y() + (a.y() - b.y()) * (x - b.x()) / (a.x() - b.x());
    }
    return line.back().y();
}

/// Where sections are needed: evenly, and where a line bends.
std::vector<double> stations(const BodyShape& body) {
    const double front = body.roof.front().x(), rear = body.roof.back().x();
    const int n = std::max(1, static_cast<int>(std::ceil((front - rear) / kStation)));
    std::vector<double> x;
    for (int i = 0; i <= n; ++i) x.push_back(front + (rear - front) * i / n);
    for (const Eigen::Vector2d& p : body.roof) x.push_back(p.x());
    std::sort(x.begin(), x.end(), std::greater<>());
    x.erase(std::unique(x.begin(), x.end(), [](double a, double b) { return a - b < 1e-6; }), x.end());
    return x;
}

/// How much of the width is left at x: an ellipse rounds both ends off.
double planShare(const BodyShape& body, double half_width, double x) {
    const double to_end = std::min(body.roof.front().x() - x, x - body.roof.back().x());
    const double u = std::clamp(1.0 - to_end / body.corner, 0.0, 1.0);
    return 1.0 - body.corner / half_width * (1.0 - std::sqrt(std::max(0.0, 1.0 - 0.8 * u * u)));
}

/// Underside at x: the clearance, and the arches over the wheels.
double undersideAt(const VehicleShape& shape, const BodyShape& body, double x) {
    double z = body.clearance;
    const double radius = shape.wheel_radius + kArchGap;
    for (double axle : shape.axles) {
        const double d = std::abs(x - axle);
        if (d < radius) z = std::max(z, shape.wheel_radius + std::sqrt(radius * radius - d * d));
    }
    return z;
}

bool anyHas(const std::vector<Stretch>& stretches, double x) {
    return std::any_of(stretches.begin(), stretches.end(), [x](const Stretch& s) { return s.has(x); });
}

Section sectionAt(const VehicleShape& shape, const BodyShape& body, double x, double next) {
    const double width = body.width * shape.size.y(), half = 0.5 * width * planShare(body, 0.5 * width, x);
    const double top = heightOn(body.roof, x);
    const double belt = std::min(heightOn(body.belt, x), top);
    const double under = std::min(undersideAt(shape, body, x), belt - 0.02);
    const double half_top = half - body.tumblehome * (top - belt);
    const double middle = 0.5 * (x + next);
    const Material side = anyHas(body.windows, middle) ? Material::Glass : body.paint;
    const Material roof = anyHas(body.screens, middle) ? Material::Glass : body.paint;
    return {x,
            {{-half, under}, {half, under}, {half, belt}, {half_top, top}, {-half_top, top}, {-half, belt}},
            {Material::Plastic, body.paint, side, roof, side, body.paint}};
}

Mesh bodyMesh(const VehicleShape& shape, const BodyShape& body) {
    const std::vector<double> x = stations(body);
    std::vector<Section> sections;
    for (std::size_t i = 0; i < x.size(); ++i)
        sections.push_back(sectionAt(shape, body, x[i], x[std::min(i + 1, x.size() - 1)]));
    return loftMesh(sections, body.paint);
}

void addWheels(const VehicleShape& shape, Mesh& mesh) {
    const double outer = 0.5 * shape.size.y() - 0.02, r = shape.wheel_radius;
    for (double x : shape.axles)
        for (double side : {-1.0, 1.0}) {
            const Eigen::Vector3d a(x, side * outer, r), b(x, side * (outer - kWheelWidth), r);
            append(mesh, rodMesh({a, b, r, r}, Material::Rubber, 20));
            const Eigen::Vector3d rim(x, side * (outer + 0.005), r);
            append(mesh, rodMesh({rim, a, 0.6 * r, 0.6 * r}, Material::Metal, 12));
        }
}

void addMirrors(const VehicleShape& shape, Mesh& mesh) {
    if (shape.mirror.isZero()) return;
    const Eigen::Vector3d half(0.05, 0.09, 0.08);
    for (double side : {-1.0, 1.0}) {
        const Eigen::Vector3d center(shape.mirror.x(), side * shape.mirror.y(), shape.mirror.z());
        append(mesh, boxMesh(center - half, center + half, Material::Plastic));
    }
}

/// Number plates and lamps: narrow reflectors just outside of both ends.
void addReflectors(const VehicleShape& shape, Mesh& mesh) {
    const double z = 0.5;
    for (double end : {-1.0, 1.0}) {
        const double x = end * (0.5 * shape.size.x() + 0.004);
        mesh.addQuad({Eigen::Vector3d(x, -0.26, z - 0.06), Eigen::Vector3d(x, 0.26, z - 0.06),
                      Eigen::Vector3d(x, 0.26, z + 0.06), Eigen::Vector3d(x, -0.26, z + 0.06)},
                     Material::Reflector);
    }
}

/// Stretches what is drawn in (x, z).
void stretch(SideLine& line, const Eigen::Vector3d& by) {
    for (Eigen::Vector2d& p : line) p = {p.x() * by.x(), p.y() * by.z()};
}

Material anyPaint(Random& random) {
    const double u = random.uniform();
    if (u < 0.35) return Material::PaintLight;
    if (u < 0.60) return Material::PaintMiddle;
    return u < 0.85 ? Material::PaintDark : Material::PaintBlack;
}

}  // namespace

VehicleShape varied(VehicleShape shape, std::uint64_t variant) {
    if (variant == 0) return shape;
    Random random(variant, 411);
    const double l = random.uniform(0.9, 1.1), w = random.uniform(0.94, 1.05), h = random.uniform(0.94, 1.08);
    const Eigen::Vector3d by(l, w, h);
    const Material paint = anyPaint(random);
    shape.size = shape.size.cwiseProduct(by);
    shape.mirror = shape.mirror.cwiseProduct(by);
    for (double& axle : shape.axles) axle *= by.x();
    for (BodyShape& body : shape.bodies) {
        stretch(body.roof, by);
        stretch(body.belt, by);
        for (auto* glass : {&body.windows, &body.screens})
            for (Stretch& s : *glass) s = {s.front * by.x(), s.rear * by.x()};
        body.corner *= random.uniform(0.7, 1.2);
        body.tumblehome *= random.uniform(0.7, 1.2);
        body.paint = paint;
    }
    return shape;
}

Model vehicleModel(const VehicleShape& shape) {
    Mesh mesh;
    for (const BodyShape& body : shape.bodies) append(mesh, bodyMesh(shape, body));
    addWheels(shape, mesh);
    addMirrors(shape, mesh);
    addReflectors(shape, mesh);
    const double wheelbase = shape.axles.front() - shape.axles.back();
    return {shape.name, shape.kind, shape.size, {mesh}, wheelbase, shape.size.y() - 0.3};
}

}  // namespace lidar_obstacles::simulation
