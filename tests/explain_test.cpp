// SPDX-License-Identifier: BSD-3-Clause
// An obstacle in words, as the panel of a clicked box has them.
#include "explain.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lidar_obstacles::apps {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

/// 4 m long, its middle 13 m ahead.
Obstacle vehicle() {
    Obstacle o;
    o.cls = ObstacleClass::Vehicle;
    o.box = {{13.0, 0.0, 0.75}, {4.0, 1.8, 1.5}, 0.0};
    o.points = {0};
    return o;
}

/// A return of the vehicle, and clusters of two returns each that were sorted out, their middles there.
LayerData scanWithRejected(const std::vector<Eigen::Vector2f>& middles) {
    LayerData scan;
    scan.cloud.xyz = {{12.F, 0.F, 0.5F}};
    for (const Eigen::Vector2f& m : middles) {
        RejectedCluster rejected;
        rejected.reason = RejectReason::TooFewPoints;
        rejected.measured = 2.0;
        rejected.limit = 5.0;
        for (const float half : {-0.25F, 0.25F}) {
            rejected.cluster.points.push_back(static_cast<std::int32_t>(scan.cloud.xyz.size()));
            scan.cloud.xyz.emplace_back(m.x() + half, m.y(), 0.5F);
        }
        scan.result.clusters.rejected.push_back(rejected);
    }
    return scan;
}

TEST(Numbers, SayWhatIsKnownOfABox) {
    Obstacle o = vehicle();
    o.track.emplace();
    o.track->age = 2.5;
    o.track->velocity = Eigen::Vector2d(3.0, 4.0);
    o.track->moving = true;
    o.probability[1] = 0.9F;
    o.num_points = 42;
    std::vector<std::string> lines;
    for (const Line& l : numbersOf(o)) lines.push_back(l.name + ": " + l.value);
    EXPECT_THAT(lines, testing::IsSupersetOf({"class: vehicle, 0.90", "size: 4.00 x 1.80 x 1.50 m", "distance: 11.0 m",
                                              "speed: 5.0 m/s", "age: 2.5 s", "returns: 42 of 0 rings"}));
}

TEST(Reasons, NameWhatWasLeftOutWithinThreeMetres) {
    const LayerData scan = scanWithRejected({{13.F, 2.5F}, {13.F, -3.5F}, {11.F, 0.F}});
    EXPECT_THAT(reasonsOf(vehicle(), scan),
                ElementsAre("nothing was weighed for it", "left out 2.5 m away: too_few_points, 2 of 5",
                            "left out 2.0 m away: too_few_points, 2 of 5"));
}

TEST(Reasons, NameFiveOfManyThatWereLeftOut) {
    const auto lines = reasonsOf(vehicle(), scanWithRejected(std::vector<Eigen::Vector2f>(9, {13.F, 1.F})));
    EXPECT_THAT(lines, SizeIs(6));
    EXPECT_THAT(lines.back(), HasSubstr("left out 1.0 m away"));
}

TEST(Reasons, SayThatAHiddenObstacleWasNotSeen) {
    Obstacle hidden = vehicle();
    hidden.points.clear();
    EXPECT_THAT(reasonsOf(hidden, {}), ElementsAre("nothing of it was seen in this scan"));
}

}  // namespace
}  // namespace lidar_obstacles::apps
