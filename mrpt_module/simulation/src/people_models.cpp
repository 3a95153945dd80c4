// SPDX-License-Identifier: BSD-3-Clause
#include "people_models.h"

#include <cmath>

#include "lidar_obstacles/simulation/random.h"

namespace lidar_obstacles::simulation {
namespace {

using Eigen::Vector3d;

constexpr int kSteps = 8;

/// A body height for a variant: `mean` for 0 [m].
double heightOf(double mean, std::uint64_t variant) {
    if (variant == 0) return mean;
    return mean * Random(variant, 402).uniform(0.92, 1.08);
}

/// The eight steps of a person that holds a thing which does not step; hands forwards.
Model pusher(const std::string& name, const Mesh& thing, std::uint64_t variant) {
    Figure figure = varied({}, variant);
    figure.lean = std::max(figure.lean, 0.08);
    figure.reach = 0.75;
    Model model{name, ObjectKind::Pedestrian, {}, {}, 0.0, 0.0};
    const double height = heightOf(1.70, variant);
    for (int k = 0; k < kSteps; ++k) {
        figure.swing = 0.36 * std::sin(2.0 * M_PI * k / kSteps);
        Mesh posture = scaled(figureMesh(figure), height);
        append(posture, thing);
        model.postures.push_back(std::move(posture));
    }
    model.size = centre(model.postures);
    return model;
}

void addTyre(Mesh& mesh, const Vector3d& hub, double radius, double width) {
    const Vector3d half(0.0, 0.5 * width, 0.0);
    append(mesh, rodMesh({hub - half, hub + half, radius, radius}, Material::Rubber, 14));
}

/// Two wheels on each side.
void addCastors(Mesh& mesh, const Eigen::Vector2d& x, double y, double radius) {
    for (double at : {x.x(), x.y()})
        for (double side : {-y, y}) addTyre(mesh, {at, side, radius}, radius, 0.04);
}

}  // namespace

Model personModel(const Person& person, std::uint64_t variant) {
    Model model{person.name, ObjectKind::Pedestrian, {}, {}, 0.0, 0.0};
    const double height = heightOf(person.height, variant);
    Figure figure = varied(person.figure, variant);
    for (int k = 0; k < (person.walking ? kSteps : 1); ++k) {
        figure.swing = person.walking ? 0.42 * std::sin(2.0 * M_PI * k / kSteps) : 0.0;
        model.postures.push_back(scaled(figureMesh(figure), height));
    }
    model.size = centre(model.postures);
    return model;
}

Model pramPusherModel(std::uint64_t variant) {
    Mesh pram;
    const Eigen::Isometry3d cot = Eigen::Isometry3d(Eigen::Translation3d(1.0, 0.0, 0.68));
    append(pram, ellipsoidMesh({Vector3d::Zero(), {0.42, 0.20, 0.20}}, Material::ClothDark), cot);
    append(pram, ellipsoidMesh({{0.80, 0.0, 0.88}, {0.20, 0.20, 0.22}}, Material::ClothDark));
    addCastors(pram, {0.70, 1.25}, 0.24, 0.13);
    for (double side : {-0.2, 0.2}) {
        addLimb(pram, {{0.48, side, 1.02}, {0.95, side, 0.55}, 0.015, 0.015}, Material::Metal);
        addLimb(pram, {{0.70, side, 0.14}, {1.20, side, 0.60}, 0.015, 0.015}, Material::Metal);
    }
    return pusher("pram_pusher", pram, variant);
}

Model trolleyPusherModel(std::uint64_t variant) {
    Mesh trolley = boxMesh({0.60, -0.27, 0.50}, {1.35, 0.27, 0.98}, Material::WireMesh);
    append(trolley, boxMesh({0.70, -0.22, 0.55}, {1.25, 0.22, 0.70}, Material::Cloth));  // what was bought
    append(trolley, boxMesh({0.55, -0.24, 0.14}, {1.30, 0.24, 0.18}, Material::Metal));
    addCastors(trolley, {0.62, 1.25}, 0.24, 0.07);
    for (double side : {-0.26, 0.26})
        addLimb(trolley, {{0.58, side, 0.16}, {0.52, side, 1.02}, 0.015, 0.015}, Material::Chrome);
    return pusher("trolley_pusher", trolley, variant);
}

Model wheelchairPusherModel(std::uint64_t variant) {
    Mesh chair = boxMesh({0.60, -0.22, 0.44}, {1.05, 0.22, 0.50}, Material::ClothDark);
    append(chair, boxMesh({0.56, -0.22, 0.50}, {0.60, 0.22, 0.95}, Material::ClothDark));
    addTyre(chair, {0.68, -0.28, 0.30}, 0.30, 0.03);
    addTyre(chair, {0.68, 0.28, 0.30}, 0.30, 0.03);
    addCastors(chair, {1.10, 1.12}, 0.22, 0.09);
    Figure sitting = varied({}, variant == 0 ? 0 : variant + 1);
    sitting.sit = 1.4, sitting.hip_height = 0.29, sitting.reach = 0.5, sitting.lean = 0.0;
    Mesh person = scaled(figureMesh(sitting), 1.65);
    moveBy(person, {0.74, 0.0, 0.0});
    append(chair, person);
    return pusher("wheelchair_pusher", chair, variant);
}

Model suitcasePullerModel(std::uint64_t variant) {
    Model model = personModel({"suitcase_puller", 1.74, true}, variant);
    Mesh suitcase = boxMesh({-0.95, -0.02, 0.06}, {-0.65, 0.42, 0.62}, Material::Plastic);
    addLimb(suitcase, {{-0.66, 0.2, 0.60}, {-0.25, 0.22, 0.80}, 0.012, 0.012}, Material::Metal);
    for (Mesh& posture : model.postures) append(posture, suitcase);
    model.size = centre(model.postures);
    return model;
}

Model sitterModel(std::uint64_t variant) {
    Figure figure = varied({}, variant);
    figure.sit = 1.45, figure.hip_height = 0.27, figure.reach = 0.6;
    Mesh person = scaled(figureMesh(figure), heightOf(1.72, variant));
    append(person, boxMesh({-0.22, -0.22, 0.40}, {0.22, 0.22, 0.44}, Material::Plastic));
    for (double x : {-0.19, 0.19})
        for (double y : {-0.19, 0.19}) addLimb(person, {{x, y, 0.0}, {x, y, 0.42}, 0.015, 0.015}, Material::Metal);
    if (variant % 2 == 0) append(person, boxMesh({-0.24, -0.2, 0.5}, {-0.21, 0.2, 0.88}, Material::Plastic));
    std::vector<Mesh> postures{person};
    const Vector3d size = centre(postures);
    return {"sitting_pedestrian", ObjectKind::Pedestrian, size, postures, 0.0, 0.0};
}

Model dogModel(std::uint64_t variant) {
    Model model{"dog", ObjectKind::Animal, {}, {}, 0.0, 0.0};
    const double size = variant == 0 ? 1.0 : Random(variant, 403).uniform(0.5, 1.2);
    for (int k = 0; k < 4; ++k) {
        const double swing = 0.4 * std::sin(0.5 * M_PI * k);
        Mesh dog = ellipsoidMesh({{0.0, 0.0, 0.50}, {0.38, 0.13, 0.15}}, Material::ClothDark);
        append(dog, ellipsoidMesh({{0.44, 0.0, 0.68}, {0.14, 0.08, 0.10}}, Material::ClothDark));
        addLimb(dog, {{0.30, 0.0, 0.55}, {0.40, 0.0, 0.68}, 0.08, 0.07}, Material::ClothDark);
        addLimb(dog, {{-0.36, 0.0, 0.55}, {-0.58, 0.0, 0.70}, 0.03, 0.015}, Material::ClothDark);
        for (double x : {-0.26, 0.26})
            for (double side : {-1.0, 1.0}) {
                const double angle = side * swing * (x > 0.0 ? 1.0 : -1.0);
                const Vector3d hip(x, 0.09 * side, 0.45), paw = hip + 0.45 * Vector3d(std::sin(angle), 0.0, -1.0);
                addLimb(dog, {hip, paw, 0.05, 0.03}, Material::ClothDark);
            }
        model.postures.push_back(scaled(dog, size));
    }
    model.size = centre(model.postures);
    return model;
}

}  // namespace lidar_obstacles::simulation
