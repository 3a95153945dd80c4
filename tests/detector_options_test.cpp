// SPDX-License-Identifier: BSD-3-Clause
// The parameters in config files that MRPT reads.
#include "lidar_obstacles/mrpt_bridge/detector_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>

#include <fstream>
#include <sstream>

#include "support/temp_folder.h"

namespace lidar_obstacles {
namespace {

using mrpt::config::CConfigFileMemory;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

/// Parameters of which some are not the defaults: a number, a word, a truth value, a text.
DetectorParams someParams() {
    DetectorParams params;
    for (const char* assignment : {"grid.resolution=0.123456789012345", "pipeline.algorithm=8-plane",
                                   "tracking.enabled=false", "region.own_body=box(-1, 1, -0.5, 0.5)"})
        setParam(params, assignment);
    return params;
}

std::string errorOf(const std::string& text, const std::string& section) {
    DetectorOptions options;
    options.params = someParams();
    try {
        options.loadFromConfigFile(CConfigFileMemory(text), section);
    } catch (const ConfigError& e) {
        EXPECT_EQ(dumpParams(options.params), dumpParams(someParams())) << "changed by a file that is not right";
        return e.what();
    }
    return "no error";
}

TEST(DetectorOptions, WhatIsSavedLoadsTheSameInASectionOrInTheSectionsOfConfigIni) {
    const test::TempFolder folder;
    for (const std::string section : {"", "front_lidar"}) {
        DetectorOptions saved, loaded;
        saved.params = someParams();
        saved.saveToConfigFileName(folder.file("robot.ini"), section);
        loaded.loadFromConfigFileName(folder.file("robot.ini"), section);
        EXPECT_EQ(dumpParams(loaded.params), dumpParams(someParams())) << "section '" << section << "'";
    }
}

TEST(DetectorOptions, TheSectionsOfConfigIniAreReadByEither) {
    const test::TempFolder folder;
    std::ofstream(folder.file("config.ini")) << dumpParams(someParams());
    DetectorOptions options;
    options.loadFromConfigFileName(folder.file("config.ini"), "");
    EXPECT_EQ(dumpParams(options.params), dumpParams(someParams()));

    DetectorOptions().saveToConfigFileName(folder.file("saved.ini"), "");
    EXPECT_EQ(dumpParams(loadParams(folder.file("saved.ini"))), dumpParams(DetectorParams{}));
}

TEST(DetectorOptions, AKeyThatIsNotThereKeepsItsValue) {
    DetectorOptions options;
    options.params = someParams();
    options.loadFromConfigFile(CConfigFileMemory("[robot]\nwheels = 4\n[front]\ngrid.resolution = 0.2 ; coarse\n"),
                               "front");
    DetectorParams expected = someParams();
    setParam(expected, "grid.resolution=0.2");
    EXPECT_EQ(dumpParams(options.params), dumpParams(expected));
}

TEST(DetectorOptions, WhatIsNotExactlyRightIsAnErrorThatSaysWhere) {
    EXPECT_THAT(
        errorOf("[front]\ngrid.resolution = 0,2\n", "front"),
        AllOf(StartsWith("in section [front]: [grid] resolution = 0,2: not a number"), HasSubstr("0.02 .. 2 m")));
    EXPECT_THAT(errorOf("[grid]\nresolutoin = 0.2\n", ""), HasSubstr("did you mean 'resolution'?"));
    EXPECT_THAT(errorOf("[front]\nresolution = 0.2\n", "front"), HasSubstr("section.key=value"));
    EXPECT_THAT(errorOf("[front]\ngrid.resolution = 7\n", "front"), HasSubstr("out of range"));
    EXPECT_THAT(errorOf("[front]\ngrid.resolution = 0.2\n", "frnt"), HasSubstr("no section [frnt]"));
    EXPECT_THAT(errorOf("[robot]\nwheels = 4\n", ""), HasSubstr("no section of lidar_obstacles"));
}

TEST(DetectorOptions, TheDumpIsAConfigFile) {
    DetectorOptions options;
    options.params = someParams();
    std::ostringstream text;
    options.dumpToTextStream(text);
    EXPECT_EQ(dumpParams(parseParams(text.str(), "dump")), dumpParams(someParams()));
}

}  // namespace
}  // namespace lidar_obstacles
