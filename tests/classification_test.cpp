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

TEST(Classify, ARiderIsACyclist) {
    Obstacle rider = sized(1.8, 0.6, 1.75);
    rider.top_share = 0.3;  // the shoulders over a bicycle
    EXPECT_EQ(classify(rider, ClassParams{}), ObstacleClass::Cyclist);
}

TEST(Classify, ARearAsWideAboveAsBelowIsNoCyclist) {
    Obstacle van = sized(1.8, 0.6, 1.75);
    van.top_share = 0.95;
    EXPECT_EQ(classify(van, ClassParams{}), ObstacleClass::Vehicle);
    van.top_share = ClassParams{}.cyclist_max_top;
    EXPECT_EQ(classify(van, ClassParams{}), ObstacleClass::Cyclist) << "the limit belongs to them";
}

TEST(ClassifyAll, APedestrianLosesItsHeadingAndOthersKeepTheirs) {
    Obstacle person = sized(0.6, 0.5, 1.7);
    Obstacle car = sized(4.5, 1.8, 1.5);
    for (Obstacle* o : {&person, &car}) {
        o->heading_valid = true;
        o->heading_std = 0.1;
        o->rule = HeadingRule::Plane;
    }
    const auto classed = classifyAll({person, car}, ClassParams{});
    EXPECT_EQ(classed[0].cls, ObstacleClass::Pedestrian);
    EXPECT_FALSE(classed[0].heading_valid);
    EXPECT_EQ(classed[0].heading_std, 0.0);
    EXPECT_EQ(classed[0].rule, HeadingRule::None);
    EXPECT_EQ(classed[1].cls, ObstacleClass::Vehicle);
    EXPECT_TRUE(classed[1].heading_valid);
    EXPECT_EQ(classed[1].rule, HeadingRule::Plane);
    EXPECT_TRUE(classifyAll({}, ClassParams{}).empty());
}

}  // namespace
}  // namespace lidar_obstacles
