// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lidar_obstacles/simulation/models.h"

namespace lidar_obstacles::simulation {
namespace {

TEST(Models, FillTheirBoxAndStandOnTheGround) {
    for (const std::string& name : modelNames()) {
        const auto model = modelNamed(name);
        ASSERT_TRUE(model) << name;
        Eigen::AlignedBox3d bounds;
        for (const Mesh& posture : model->postures) bounds.extend(boundsOf(posture));
        EXPECT_NEAR(bounds.min().z(), 0.0, 0.01) << name;
        EXPECT_NEAR(bounds.max().z(), model->size.z(), 0.01) << name;
        EXPECT_NEAR(bounds.sizes().x(), model->size.x(), 0.02) << name;
        EXPECT_NEAR(bounds.center().x(), 0.0, 0.01) << name;
        // Wing mirrors stand out, a quarter of a metre at most.
        EXPECT_GT(bounds.sizes().y(), model->size.y() - 0.05) << name;
        EXPECT_LT(bounds.sizes().y(), model->size.y() + 0.5) << name;
    }
}

TEST(Models, OfAVariantFillTheirBoxToo) {
    for (const std::string& name : modelNames())
        for (std::uint64_t variant : {1, 2, 3, 4, 5}) {
            const auto model = modelNamed(name, variant);
            Eigen::AlignedBox3d bounds;
            for (const Mesh& posture : model->postures) bounds.extend(boundsOf(posture));
            EXPECT_NEAR(bounds.min().z(), 0.0, 0.01) << name;
            EXPECT_NEAR(bounds.max().z(), model->size.z(), 0.01) << name;
            EXPECT_NEAR(bounds.sizes().x(), model->size.x(), 0.02) << name;
            EXPECT_GT(bounds.sizes().y(), model->size.y() - 0.05) << name;
            EXPECT_LT(bounds.sizes().y(), model->size.y() + 0.5) << name;
        }
}

TEST(Models, VariantsDifferAndAreAlwaysTheSame) {
    for (const char* name : {"sedan", "bus", "pedestrian", "cyclist", "tractor", "dog"}) {
        EXPECT_EQ(modelNamed(name, 3)->size, modelNamed(name, 3)->size) << name;
        EXPECT_NE(modelNamed(name, 3)->size, modelNamed(name, 4)->size) << name;
    }
}

TEST(Models, BelongToTheClassOfWhatTheyAre) {
    EXPECT_EQ(classOf(modelNamed("articulated_bus")->kind), ObstacleClass::Vehicle);
    EXPECT_EQ(classOf(modelNamed("motorcycle")->kind), ObstacleClass::Vehicle);
    for (const char* name : {"cyclist", "motorcyclist", "scooter_rider", "chair_user"})
        EXPECT_EQ(classOf(modelNamed(name)->kind), ObstacleClass::Cyclist) << name;
    for (const char* name : {"sitting_pedestrian", "crouching_pedestrian", "pram_pusher", "wheelchair_pusher"})
        EXPECT_EQ(classOf(modelNamed(name)->kind), ObstacleClass::Pedestrian) << name;
    EXPECT_EQ(classOf(modelNamed("dog")->kind), ObstacleClass::Unknown);
}

TEST(Models, HoldThemselvesAsTheirNameSays) {
    const auto height = [](const char* name) { return modelNamed(name)->size.z(); };
    EXPECT_NEAR(height("standing_pedestrian"), 1.72, 0.06);
    EXPECT_NEAR(height("bending_pedestrian"), 1.3, 0.2);
    EXPECT_NEAR(height("sitting_pedestrian"), 1.3, 0.15);
    EXPECT_NEAR(height("crouching_pedestrian"), 1.05, 0.2);
    EXPECT_GT(modelNamed("pram_pusher")->size.x(), 1.4) << "the pram belongs to the person";
}

TEST(Models, AreNoBoxes) {
    // The share of a car's box that lies above hood and boot is empty.
    for (const char* name : {"sedan", "hatchback", "suv"}) {
        const auto model = modelNamed(name);
        const double half = 0.5 * model->size.x(), roof = 0.9 * model->size.z();
        for (const Eigen::Vector3f& v : model->postures.front().vertices)
            EXPECT_FALSE(v.x() > 0.6 * half && v.z() > roof) << name;
    }
}

TEST(Models, UnknownNamesGiveNone) { EXPECT_EQ(modelNamed("tank"), nullptr); }

TEST(Mesh, EveryTriangleHasItsMaterialAndItsVertices) {
    for (const std::string& name : modelNames()) {
        const auto model = modelNamed(name);
        for (const Mesh& mesh : model->postures) {
            ASSERT_EQ(mesh.material.size(), mesh.triangles.size());
            for (const auto& triangle : mesh.triangles)
                for (std::uint32_t corner : triangle) ASSERT_LT(corner, mesh.vertices.size());
        }
    }
}

}  // namespace
}  // namespace lidar_obstacles::simulation
