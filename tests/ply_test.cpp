// SPDX-License-Identifier: BSD-3-Clause
// obstacle-replay --format ply: the files are read back by hand and held against obstacles.csv.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>

#include "support/replay_run.h"

namespace lidar_obstacles {
namespace {

using test::CsvRow;
using test::readFile;
using testing::HasSubstr;
using testing::StartsWith;

constexpr const char* kStreet = DATASETS "street_sample.rawlog";

/// A binary PLY file of properties float, int and uchar: rows of numbers per element.
struct Ply {
    std::string header;
    std::map<std::string, std::vector<std::map<std::string, double>>> rows;
    std::size_t left = 0;  ///< bytes behind the last row
};

double take(const char*& at, const std::string& type) {
    if (type == "uchar") return static_cast<unsigned char>(*at++);
    float number = 0.0F;
    std::int32_t whole = 0;
    std::memcpy(&number, at, 4);
    std::memcpy(&whole, at, 4);
    at += 4;
    return type == "float" ? static_cast<double>(number) : static_cast<double>(whole);
}

Ply readPly(const std::string& file) {
    const std::string bytes = readFile(file);
    const std::size_t begin = bytes.find("end_header\n") + 11;
    Ply ply{bytes.substr(0, begin), {}, 0};
    struct Element {
        std::string name;
        std::size_t count;
        std::vector<std::pair<std::string, std::string>> properties;
    };
    std::vector<Element> elements;
    std::istringstream in(ply.header);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        std::string word, type, name;
        words >> word >> type >> name;
        if (word == "element") elements.push_back({type, std::stoul(name), {}});
        if (word == "property") elements.back().properties.emplace_back(name, type);
    }
    const char* at = bytes.data() + begin;
    for (const Element& e : elements) {
        for (std::size_t k = 0; k < e.count; ++k) {
            std::map<std::string, double> row;
            for (const auto& [name, type] : e.properties) row[name] = take(at, type);
            ply.rows[e.name].push_back(row);
        }
    }
    ply.left = static_cast<std::size_t>(bytes.data() + bytes.size() - at);
    return ply;
}

class PlyFiles : public testing::Test, public test::ReplayRun {
  protected:
    Ply ply(std::size_t scan) const { return readPly(file("out/ply/00000" + std::to_string(scan) + ".ply")); }
};

TEST_F(PlyFiles, EachReturnHasTheClassAndTheTrackOfItsBox) {
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --format csv,ply"), 0) << err();
    const std::map<std::string, int> codes{
        {"unknown", 2}, {"vehicle", 3}, {"pedestrian", 4}, {"cyclist", 5}, {"structure", 6}};
    for (std::size_t scan = 0; scan < 8; ++scan) {
        const Ply got = ply(scan);
        EXPECT_THAT(got.header, StartsWith("ply\nformat binary_little_endian 1.0\n"));
        EXPECT_EQ(got.left, 0U);
        std::map<std::pair<int, int>, int> counts;  // by track and class
        int ground = 0;
        for (const auto& v : got.rows.at("vertex")) {
            if (v.at("is_box") != 0) continue;
            ground += v.at("class") == 1;
            if (v.at("track") >= 0) ++counts[{static_cast<int>(v.at("track")), static_cast<int>(v.at("class"))}];
        }
        EXPECT_GT(ground, 5000);
        std::size_t seen = 0;
        for (const CsvRow& row : csv(scan)) {
            if (row.fields[23] == "0") continue;  // predicted
            ++seen;
            EXPECT_EQ((counts[{std::stoi(row.fields[2]), codes.at(row.fields[3])}]), row.at(12)) << row.fields[2];
        }
        EXPECT_EQ(counts.size(), seen);
    }
}

TEST_F(PlyFiles, TheEdgesAreThoseOfTheBoxes) {
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --format csv,ply --to 0"), 0) << err();
    const Ply got = ply(0);
    const std::vector<CsvRow> rows = csv(0);
    ASSERT_EQ(got.rows.at("edge").size(), 12 * rows.size());
    for (std::size_t k = 0; k < rows.size(); ++k) {
        std::vector<double> lengths;
        double x = 0.0, z = 0.0;
        for (std::size_t e = 12 * k; e < 12 * k + 12; ++e) {
            const auto& edge = got.rows.at("edge")[e];
            const auto& a = got.rows.at("vertex")[static_cast<std::size_t>(edge.at("vertex1"))];
            const auto& b = got.rows.at("vertex")[static_cast<std::size_t>(edge.at("vertex2"))];
            EXPECT_EQ(a.at("is_box"), 1);
            EXPECT_EQ(a.at("track"), rows[k].at(2));
            lengths.push_back(std::hypot(a.at("x") - b.at("x"), a.at("y") - b.at("y"), a.at("z") - b.at("z")));
            x += (a.at("x") + b.at("x")) / 24;
            z += (a.at("z") + b.at("z")) / 24;
        }
        EXPECT_NEAR(x, rows[k].at(4), 1e-3);
        EXPECT_NEAR(z, rows[k].at(6), 1e-3);
        for (const int size : {7, 8, 9})
            EXPECT_GE(std::count_if(lengths.begin(), lengths.end(),
                                    [&](double length) { return std::abs(length - rows[k].at(size)) < 1e-3; }),
                      4)
                << "edges as long as column " << size;
    }
}

TEST_F(PlyFiles, AnEarlierRunLeavesNoneBehind) {
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --format ply --to 2"), 0) << err();
    EXPECT_TRUE(std::filesystem::exists(file("out/ply/000002.ply")));
    EXPECT_FALSE(std::filesystem::exists(file("out/obstacles.csv")));
    ASSERT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --to 2"), 0) << err();
    EXPECT_FALSE(std::filesystem::exists(file("out/ply/000002.ply")));
    EXPECT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --format plx"), 2);
    EXPECT_THAT(err(), HasSubstr("--format plx: must be csv"));
}

TEST_F(PlyFiles, AFullDiskIsAnErrorThatNamesTheFile) {
    EXPECT_EQ(run(OBSTACLE_REPLAY, std::string(kStreet) + " --format ply", "trap '' XFSZ; ulimit -f 100;"), 1);
    EXPECT_THAT(err(), HasSubstr("000000.ply: cannot write"));
}

}  // namespace
}  // namespace lidar_obstacles
