// SPDX-License-Identifier: BSD-3-Clause
// Several lidars of a recording as one: which scans belong together.
#include "lidar_obstacles/mrpt_bridge/joined_lidars.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/rawlog_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

class Joined : public testing::Test {
  protected:
    /// The items of a rawlog of these scans: "front+rear@0.04" is a joined one with the time of the other since its
    /// own.
    std::vector<std::string> read(const Objects& objects, const std::string& choice) {
        const std::string file = folder_.file("drive.rawlog");
        writeRawlog(file, objects, false);
        JoinedLidars source(openScanSource(file), choice);
        std::vector<std::string> items;
        while (const auto item = source.next()) {
            items.push_back(item->lidar);
            const double time = mrpt::Clock::toDouble(item->observation->timestamp);
            for (const auto& other : item->beside) {
                const double later = mrpt::Clock::toDouble(other->timestamp) - time;
                items.back() += "+" + other->sensorLabel + "@" + std::to_string(std::lround(1e3 * later));
            }
        }
        remarks_ = source.remarks();
        return items;
    }

    std::string remarks_;

  private:
    TempFolder folder_;
};

TEST_F(Joined, ScansThatAreNearestInTimeBelongTogether) {
    const Objects objects = {scanLabelled("rear", 10.04),  scanLabelled("front", 10.06), scanLabelled("rear", 10.14),
                             scanLabelled("front", 10.16), scanLabelled("rear", 10.24),  scanLabelled("front", 10.26)};
    EXPECT_THAT(read(objects, "front,rear"),
                ElementsAre("front,rear+rear@-20", "front,rear+rear@-20", "front,rear+rear@-20"));
    EXPECT_EQ(remarks_, "");
    EXPECT_THAT(read(objects, "rear,front"),
                ElementsAre("rear,front+front@20", "rear,front+front@20", "rear,front+front@20"));
    EXPECT_THAT(read(objects, "all"), ElementsAre("all+front@20", "all+front@20", "all+front@20"))
        << "at the times of the first that comes";
}

TEST_F(Joined, AMissingScanIsSaidAndTheOthersStay) {
    const Objects objects = {scanLabelled("front", 10.0), scanLabelled("rear", 10.02), scanLabelled("front", 10.1),
                             scanLabelled("front", 10.2), scanLabelled("rear", 10.22), scanLabelled("front", 10.3)};
    EXPECT_THAT(read(objects, "front,rear"),
                ElementsAre("front,rear+rear@20", "front,rear", "front,rear+rear@20", "front,rear"));
    EXPECT_EQ(remarks_, "2 of 4 scans of 'front' without one of 'rear' (none within 0.1 s)");
}

TEST_F(Joined, AScanThatBelongsToNoneIsLeftOutAndCounted) {
    const Objects objects = {scanLabelled("rear", 9.5), scanLabelled("front", 10.0), scanLabelled("rear", 10.02),
                             scanLabelled("rear", 10.04), scanLabelled("rear", 10.5)};
    EXPECT_THAT(read(objects, "front,rear"), ElementsAre("rear", "front,rear+rear@20", "rear", "rear"));
    EXPECT_THAT(remarks_, HasSubstr("3 scans of 'rear' left out, which belong to none of 'front'"));
}

TEST_F(Joined, OtherLidarsAndObservationsPassInTheirOrder) {
    const Objects objects = {scanLabelled("front", 10.0), scanLabelled("roof", 10.01), scanLabelled("rear", 10.02)};
    EXPECT_THAT(read(objects, "front,rear"), ElementsAre("front,rear+rear@20", "roof"));
    EXPECT_THAT(read(objects, "all"), ElementsAre("all+rear@20+roof@10"));
}

TEST_F(Joined, AllScansArriveAlsoWhereStampsDoNotRise) {
    const Objects objects(500, scanLabelled("front", 10.0));  // more than it reads ahead
    EXPECT_EQ(read(objects, "front,rear").size(), 500u);
}

TEST_F(Joined, ScansOfAClockThatIsSetBackStillBelongTogether) {
    Objects objects;
    for (const double begin : {100.0, 40.0})
        for (int k = 0; k < 4; ++k)
            for (const auto& [lidar, later] : {std::pair{"front", 0.0}, std::pair{"rear", 0.04}})
                objects.push_back(scanLabelled(lidar, begin + 0.1 * k + later));
    EXPECT_THAT(read(objects, "front,rear"), testing::AllOf(testing::SizeIs(8), testing::Each("front,rear+rear@40")));
    EXPECT_EQ(remarks_, "");
}

TEST(JoinedCloudOfItem, HoldsTheReturnsOfAll) {
    SourceItem item;
    const auto front = scanLabelled("front", 10.0);
    const auto rear = scanLabelled("rear", 10.02);
    rear->sensorPose = mrpt::poses::CPose3D(-2, 0, 0, M_PI, 0, 0);
    item.observation = front;
    const std::size_t alone = toPointCloud(item, {}).size();
    item.beside = {rear};
    DecodeStats stats;
    const PointCloud joined = toPointCloud(item, {}, &stats);
    EXPECT_EQ(joined.size(), 2 * alone);
    EXPECT_EQ(stats.packets, 150);
    EXPECT_EQ(joined.originOf(static_cast<std::int32_t>(joined.size()) - 1).x(), -2.0f);
    EXPECT_NEAR(joined.xyz.back().x() + 2.0f, -joined.xyz[alone - 1].x(), 1e-3f);
}

}  // namespace
}  // namespace lidar_obstacles
