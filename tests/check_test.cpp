// SPDX-License-Identifier: BSD-3-Clause
// obstacle-check from end to end, on drives of the simulator whose mount the recording does not know.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "support/shell.h"
#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using test::readFile;
using testing::HasSubstr;

class Check : public testing::Test {
  protected:
    /// Two seconds of the street.
    std::string drive(const std::string& options) const {
        const int code =
            test::shell(std::string(OBSTACLE_SIMULATE) + " " + DATASETS + "scenarios/street.yaml --from 8 --to 10.1 " +
                        options + " --output '" + folder_.file("drive") + "' >/dev/null");
        EXPECT_EQ(code, 0);
        return "'" + folder_.file("drive.rawlog") + "'";
    }
    int run(const std::string& arguments) {
        const int code = test::shell(std::string(OBSTACLE_CHECK) + " " + arguments + " >'" + folder_.file("out") +
                                     "' 2>'" + folder_.file("err") + "'");
        out_ = readFile(folder_.file("out"));
        err_ = readFile(folder_.file("err"));
        return code;
    }
    /// The number behind `words` in what was printed; NaN if it is not there.
    double numberAfter(const std::string& words) const {
        const auto at = out_.find(words);
        return at == std::string::npos ? std::nan("") : std::stod(out_.substr(at + words.size()));
    }

    test::TempFolder folder_;
    std::string out_, err_;
};

TEST_F(Check, FindsNothingToSetInAnOrdinaryDrive) {
    ASSERT_EQ(run(drive("")), 0) << err_;
    EXPECT_NEAR(numberAfter("\nsensor: "), 1.85, 0.1) << out_;  // the road is crowned
    EXPECT_LT(numberAfter("tilted by "), 1.0) << out_;
    EXPECT_THAT(out_, HasSubstr("scans: 20,"));
    EXPECT_THAT(out_, HasSubstr("\nrate: 10.0 scans/s"));
    EXPECT_THAT(out_, HasSubstr("\nposes: pose of 'ego_rtk'"));
    EXPECT_THAT(out_, HasSubstr("Nothing to set"));
}

TEST_F(Check, TheOfferedPoseMakesATiltedMountLevel) {
    const std::string tilted = drive("--mount-error 0,0,0,0,12,0");
    ASSERT_EQ(run(tilted), 0) << err_;
    EXPECT_NEAR(numberAfter("tilted by "), 12.0, 0.7) << out_;
    const auto at = out_.find("--sensor-pose ");
    ASSERT_NE(at, std::string::npos) << out_;
    const std::string offered = out_.substr(at, out_.find("   #", at) - at);
    ASSERT_EQ(run(tilted + " " + offered), 0) << err_;
    EXPECT_LT(numberAfter("tilted by "), 0.7) << offered << "\n" << out_;
    EXPECT_THAT(out_, HasSubstr("Nothing to set"));
}

TEST_F(Check, SaysThatASensorHangsUpsideDown) {
    ASSERT_EQ(run(drive("--mount-error 0,0,0,0,0,180")), 0) << err_;
    EXPECT_THAT(out_, HasSubstr("it hangs upside down"));
    EXPECT_NEAR(numberAfter("\nsensor: "), 1.85, 0.1) << out_;  // the road is crowned
}

TEST_F(Check, ASingleScanHasNeitherRateNorBody) {
    ASSERT_EQ(run(std::string(DATASETS) + "street_sample.rawlog --scans 1"), 0) << err_;
    EXPECT_THAT(out_, HasSubstr("rate: not known"));
    EXPECT_THAT(out_, HasSubstr("more is not known"));
}

TEST_F(Check, RefusesWhatIsNoScan) {
    EXPECT_EQ(run("/nowhere.rawlog"), 1);
    EXPECT_THAT(err_, HasSubstr("/nowhere.rawlog"));
    EXPECT_EQ(run(std::string(DATASETS) + "street_sample.rawlog --from 99"), 2);
    EXPECT_THAT(err_, HasSubstr("--from leaves none of its scans"));
    EXPECT_EQ(run(std::string(DATASETS) + "street_sample.rawlog --sensor-label rear"), 2);
    EXPECT_THAT(err_, HasSubstr("no lidar 'rear'"));
    EXPECT_EQ(run(std::string(DATASETS) + "street_sample.rawlog --set ground.max_slope=3"), 2);
}

}  // namespace
}  // namespace lidar_obstacles
