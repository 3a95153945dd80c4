// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "lidar_obstacles/object_models.h"

namespace lidar_obstacles {
namespace {

TEST(ObjectKinds, AreListedInTheOrderOfTheirValues) {
    for (std::size_t i = 0; i < allKinds().size(); ++i) EXPECT_EQ(static_cast<std::size_t>(allKinds()[i]), i);
    EXPECT_EQ(allKinds().back(), ObjectKind::Pile);
}

TEST(ObjectKinds, AreFoundByTheirNames) {
    for (ObjectKind kind : allKinds()) EXPECT_EQ(kindNamed(nameOf(kind)), kind) << nameOf(kind);
    EXPECT_EQ(kindNamed("person_sitting"), ObjectKind::Pedestrian);
    EXPECT_EQ(kindNamed("sedan"), ObjectKind::Car);
    EXPECT_FALSE(kindNamed("spaceship"));
    EXPECT_FALSE(kindNamed(""));
}

TEST(ObjectKinds, HaveTheClassOfWhatTheyAre) {
    for (const char* name : {"car", "van", "truck", "bus", "trailer", "tram", "tractor", "motorcycle"})
        EXPECT_EQ(classOf(*kindNamed(name)), ObstacleClass::Vehicle) << name;
    for (const char* name : {"cyclist", "motorcyclist", "scooter_rider", "chair_user"})
        EXPECT_EQ(classOf(*kindNamed(name)), ObstacleClass::Cyclist) << name;
    EXPECT_EQ(classOf(ObjectKind::Pedestrian), ObstacleClass::Pedestrian);
    for (const char* name : {"bike", "scooter", "bin", "bollard", "animal", "ground", "noise"})
        EXPECT_EQ(classOf(*kindNamed(name)), ObstacleClass::Unknown) << name;
    for (const char* name : {"wall", "fence", "hedge", "bush", "tree", "pole", "rail", "furniture", "crate"})
        EXPECT_EQ(classOf(*kindNamed(name)), ObstacleClass::Structure) << name;
}

}  // namespace
}  // namespace lidar_obstacles
