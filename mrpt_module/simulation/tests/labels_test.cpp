// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/simulation/labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "support/small_worlds.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::simulation {
namespace {

using lidar_obstacles::test::TempFolder;
using lidar_obstacles::test::writeFile;
using test::scanOf;
using test::SmallWorld;
using test::worldOf;
using testing::HasSubstr;

World fewThings() {
    SmallWorld small;
    small.lists =
        "objects: [{model: sedan, s: 112, d: 5}, {model: pedestrian, s: 96, d: -6}]\n"
        "clutter: [{type: wall, from: 50, to: 200, d: -14, height: 4}, {type: tree, s: 104, d: 12}, {type: kerb, "
        "from: 60, to: 180, d: 9}]\n";
    return worldOf(small);
}

std::string fileOf(const LidarScan& scan) {
    return labelsHeader() + labelsRecord(labelsOf(scan, 0)) + labelsRecord(labelsOf(scan, 7));
}

/// What the reader says about a file of these bytes.
std::string complaintAbout(const TempFolder& folder, const std::string& bytes) {
    writeFile(folder.file("labels.bin"), bytes);
    try {
        LabelsReader reader(folder.file("labels.bin"));
        while (reader.next()) continue;
    } catch (const std::runtime_error& e) {
        return e.what();
    }
    return "";
}

TEST(Labels, NameWhatWasHit) {
    const World world = fewThings();
    std::map<ObjectKind, int> id_of;
    for (const LidarReturn& r : scanOf(world).returns) {
        if (r.kind == ObjectKind::Ground) continue;  // the level part of a kerb is ground with the id of the kerb
        EXPECT_EQ(id_of.emplace(r.kind, r.id).first->second, r.id) << nameOf(r.kind) << ": there is one of each";
        if (r.kind == ObjectKind::Wall) {
            EXPECT_NEAR(r.point.y(), -14.0f, 0.5f);
        }
    }
    const std::map<ObjectKind, int> expected{{ObjectKind::Car, 1},
                                             {ObjectKind::Pedestrian, 2},
                                             {ObjectKind::Wall, -1},
                                             {ObjectKind::Tree, -2},
                                             {ObjectKind::Kerb, -3}};
    EXPECT_EQ(id_of, expected);
}

TEST(Labels, AreReadAsTheyWereWritten) {
    const World world = fewThings();
    const LidarScan scan = scanOf(world, 3);
    const TempFolder folder;
    writeFile(folder.file("labels.bin"), fileOf(scan));
    LabelsReader reader(folder.file("labels.bin"));
    for (std::size_t index : {0, 7}) {
        const auto labels = reader.next();
        ASSERT_TRUE(labels);
        EXPECT_EQ(labels->scan_index, index);
        EXPECT_NEAR(labels->timestamp, 1609459200.3, 1e-2);
        ASSERT_EQ(labels->returns.size(), scan.returns.size());
        for (std::size_t i = 0; i < scan.returns.size(); ++i) {
            ASSERT_EQ(labels->returns[i].id, scan.returns[i].id);
            ASSERT_EQ(labels->returns[i].kind, scan.returns[i].kind);
        }
    }
    EXPECT_FALSE(reader.next());
    EXPECT_FALSE(reader.next());
}

TEST(Labels, AFileWithoutScansHasNone) {
    const TempFolder folder;
    writeFile(folder.file("labels.bin"), labelsHeader());
    LabelsReader reader(folder.file("labels.bin"));
    EXPECT_FALSE(reader.next());
}

TEST(Labels, BadFilesAreToldByName) {
    const TempFolder folder;
    const std::string good = fileOf(scanOf(fewThings()));
    EXPECT_THROW(LabelsReader(folder.file("missing.bin")), std::runtime_error);
    EXPECT_THAT(complaintAbout(folder, ""), HasSubstr("labels.bin: no file of labels"));
    EXPECT_THAT(complaintAbout(folder, "LOLABELZ...."), HasSubstr("no file of labels"));
    std::string newer = good;
    newer[8] = 9;
    EXPECT_THAT(complaintAbout(folder, newer), HasSubstr("labels of version 9"));
    EXPECT_THAT(complaintAbout(folder, good.substr(0, good.size() - 1)), HasSubstr("scan 1: the file ends within it"));
    EXPECT_THAT(complaintAbout(folder, good.substr(0, 20)), HasSubstr("scan 0: the file ends within it"));
    std::string strange = good;
    strange[12 + 16 + 2] = '\x7f';
    EXPECT_THAT(complaintAbout(folder, strange), HasSubstr("scan 0: return 0: no kind 127"));
}

TEST(Labels, IdsThatDoNotFitAreAnError) {
    LidarScan scan;
    scan.returns.resize(1);
    scan.returns[0].id = -40000;
    EXPECT_THROW(labelsOf(scan, 0), std::invalid_argument);
}

}  // namespace
}  // namespace lidar_obstacles::simulation
