// SPDX-License-Identifier: BSD-3-Clause
// Guards on classes, near objects without a box, and tracks of the default detector, on labelled recordings. The limits
// are the lower ends of bootstrap intervals over objects of what was measured (95 %), so that a real loss shows.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <ostream>

#include "support/shell.h"
#include "support/temp_folder.h"
#include "support/test_data.h"

namespace lidar_obstacles {
namespace {

using nlohmann::json;
using namespace test;

/// What has to be reached at least, and the share of near objects without a box at most.
struct Limits {
    const char* name;
    const char* set;  ///< below the labelled data; "": the recording of a street that is part of this repository
    const char* options;
    double vehicle = 0.0, person = 0.0;  ///< F1
    double hota = 0.0;                   ///< of vehicles; 0: no tracks
    double blind = 0.0;
};

std::ostream& operator<<(std::ostream& out, const Limits& limits) { return out << limits.name; }

class ClassAccuracy : public testing::TestWithParam<Limits> {};

TEST_P(ClassAccuracy, ReachesWhatWasMeasured) {
    const Limits limits = GetParam();
    std::string prefix = STREET_SAMPLE;
    if (*limits.set != '\0') {
        LIDAR_OBSTACLES_NEED(truth, labelledData(std::string(limits.set) + "_gt.csv"));
        prefix = truth.substr(0, truth.size() - std::string("_gt.csv").size());
    }
    const test::TempFolder folder;
    ASSERT_EQ(test::shell("'" OBSTACLE_EVALUATE "' --prefix '" + prefix + "' " + limits.options +
                          " --no-report --bootstrap 0 --output '" + folder.file("out") + "' >'" + folder.file("said") +
                          "' 2>&1"),
              0)
        << test::readFile(folder.file("said"));
    const json metrics = json::parse(test::readFile(folder.file("out/metrics.json")));
    const json& found = metrics["by_class"];
    EXPECT_GE(found["vehicle"]["f1"].get<double>(), limits.vehicle);
    if (limits.person > 0.0) {
        EXPECT_GE(found["person"]["f1"].get<double>(), limits.person);
    }
    if (limits.hota > 0.0) {
        EXPECT_GE(found["vehicle"]["hota"].get<double>(), limits.hota);
    }
    EXPECT_LE(metrics["blind"]["share"].get<double>(), limits.blind);
}

constexpr const char* kScanByScan = "--set tracking.enabled=off";
constexpr const char* kScanByScanInView = "--set tracking.enabled=off --fov 80";

INSTANTIATE_TEST_SUITE_P(Sets, ClassAccuracy,
                         testing::Values(Limits{"street_scans", "sim_street", kScanByScan, 0.86, 0.90, 0.0, 0.015},
                                         Limits{"street_tracks", "sim_street", "", 0.90, 0.92, 0.68, 0.01},
                                         Limits{"drive_scans", "kitti_0001_16", kScanByScanInView, 0.87, 0.75, 0.0,
                                                0.07},
                                         Limits{"drive_tracks", "kitti_0001_16", "--fov 80", 0.86, 0.80, 0.60, 0.04},
                                         Limits{"sample", "", "", 0.85, 0.0, 0.0, 0.03}),
                         [](const auto& limits) { return std::string(limits.param.name); });

}  // namespace
}  // namespace lidar_obstacles
