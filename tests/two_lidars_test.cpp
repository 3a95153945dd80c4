// SPDX-License-Identifier: BSD-3-Clause
// Two lidars against one: a simulated delivery robot, judged by the truth of what both see.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "support/shell.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using nlohmann::json;
using test::readFile;
using test::shell;

/// The scenario with two sensors, two scans a second.
class TwoLidars : public testing::Test {
  protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<test::TempFolder>();
        simulated_ = shell("'" OBSTACLE_SIMULATE "' '" SCENARIOS "delivery-two.yaml' --stride 5 --output '" +
                           folder_->file("robot") + "' >/dev/null");
    }
    static void TearDownTestSuite() { folder_.reset(); }

    void SetUp() override { ASSERT_EQ(simulated_, 0); }

    /// The figures of a choice of lidars, each scan for itself.
    static json judge(const std::string& lidars) {
        const std::string output = folder_->file("judged");
        const int code =
            shell("'" OBSTACLE_EVALUATE "' --prefix '" + folder_->file("robot") + "' --sensor-label " + lidars +
                  " --set tracking.enabled=false --gt-pose ref --no-report "
                  "--bootstrap 0 --max-range 20 --output '" +
                  output + "' >/dev/null 2>'" + folder_->file("err") + "'");
        if (code != 0) return readFile(folder_->file("err"));
        return json::parse(readFile(output + "/metrics.json"));
    }

    /// Objects that were found, in all scans.
    static long found(const json& figures) {
        long sum = 0;
        for (const auto& [type, n] : figures["recall_by_type"].items())
            sum += std::lround(n[0].get<double>() * n[1].get<double>());
        return sum;
    }
    /// Near objects that no box covered, in all scans.
    static int blind(const json& figures) { return figures["blind"]["blind_scans"]; }

    static inline std::unique_ptr<test::TempFolder> folder_;
    static inline int simulated_ = -1;
};

TEST_F(TwoLidars, FindMoreThanEitherOfThem) {
    const json front = judge("front"), side = judge("side"), both = judge("front,side");
    ASSERT_TRUE(front.is_object()) << front;
    ASSERT_TRUE(side.is_object()) << side;
    ASSERT_TRUE(both.is_object()) << both;
    EXPECT_GT(found(both), found(front));
    EXPECT_GT(found(both), found(side));
    EXPECT_LT(blind(both), blind(front));
    EXPECT_LT(blind(both), blind(side));
}

}  // namespace
}  // namespace lidar_obstacles
