// Classes from sizes.
#include "lidar_obstacles/classification.h"

#include <gtest/gtest.h>

namespace lidar_obstacles {
namespace {

Obstacle sized(double length, double width, double height) {
    Obstacle o;
    o.box.size = {length, width, height};
    return o;
}

TEST(Classify, SizesTellTheClass) {
    const ClassParams p;
    EXPECT_EQ(classify(sized(4.5, 1.8, 1.5), p), ObstacleClass::Vehicle);
    EXPECT_EQ(classify(sized(12.0, 2.5, 3.0), p), ObstacleClass::Vehicle);
    EXPECT_EQ(classify(sized(1.8, 4.5, 1.5), p), ObstacleClass::Vehicle) << "whichever side is along the heading";
    EXPECT_EQ(classify(sized(0.5, 0.5, 1.7), p), ObstacleClass::Pedestrian);
    EXPECT_EQ(classify(sized(0.5, 0.5, 0.4), p), ObstacleClass::Unknown);
    EXPECT_EQ(classify(sized(20.0, 2.0, 2.0), p), ObstacleClass::Unknown);
    EXPECT_EQ(classify(sized(6.0, 5.0, 2.0), p), ObstacleClass::Unknown);
}

TEST(Classify, ARiderIsACyclist) { EXPECT_EQ(classify(sized(1.8, 0.6, 1.75), ClassParams{}), ObstacleClass::Cyclist); }

}  // namespace
}  // namespace lidar_obstacles
