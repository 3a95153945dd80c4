// SPDX-License-Identifier: BSD-3-Clause
// `obstacle-fleet merge` from end to end: the databases, the report, drift against a baseline.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "database.h"
#include "support/fleet_run.h"

namespace lidar_obstacles {
namespace {

namespace fs = std::filesystem;
using fleet::Database;
using test::countIn;
using test::readFile;
using test::writeFile;
using testing::HasSubstr;
using testing::Not;

class FleetMerge : public testing::Test {
  protected:
    void SetUp() override {
        fleet_.addTracks("tracks.rawlog");
        fleet_.addRecording("twice.rawlog", 2);
        fleet_.addRecording("short.rawlog");
        ASSERT_EQ(fleet_.manifest(), 0) << fleet_.err();
    }
    void runAndMerge(const std::string& output, const std::string& options = "") const {
        fleet_.run("run m.jsonl --output " + output);
        fleet_.run("merge m.jsonl --output " + output + " " + options);
    }
    std::int64_t number(const std::string& database, const std::string& sql) const {
        const Database d(fleet_.file(database), Database::Mode::Read);
        auto row = d.prepare(sql);
        return row.step() ? row.integer(0) : -1;
    }
    std::string report(const std::string& output = "out") const {
        return readFile(fleet_.file(output + "/report.html"));
    }
    /// Lines of a file in all results, without the headers.
    std::size_t rowsOf(const std::string& name) const {
        std::size_t rows = 0;
        for (const fs::path& folder : fleet_.resultsIn("out"))
            rows += countIn(readFile((folder / name).string()), "\n") - 1;
        return rows;
    }

    test::FleetRun fleet_{OBSTACLE_FLEET, DATASETS};
};

TEST_F(FleetMerge, TablesHoldWhatTheFilesHold) {
    fs::copy_file(fleet_.file("rec/short.rawlog"), fleet_.file("rec/copy.rawlog"));
    fleet_.addDamaged("damaged.rawlog");
    ASSERT_EQ(fleet_.manifest(), 0);
    runAndMerge("out");
    const std::string all = "out/fleet.sqlite";
    for (const char* table : {"obstacles", "scans", "tracks"}) {
        const std::size_t rows = rowsOf(std::string(table) + ".csv");
        EXPECT_GT(rows, 30U) << table;
        EXPECT_EQ(number(all, std::string("SELECT count(*) FROM ") + table), static_cast<std::int64_t>(rows)) << table;
    }
    EXPECT_EQ(number("out/timings.sqlite", "SELECT count(*) FROM timings"),
              static_cast<std::int64_t>(rowsOf("scans.csv")));
    EXPECT_EQ(number(all, "SELECT count(*) FROM recordings"), 5);
    EXPECT_EQ(number(all, "SELECT count(*) FROM results"), 4);  // the copy is the same work
    EXPECT_EQ(number(all, "SELECT count(DISTINCT result) FROM recordings"), 4);
    EXPECT_EQ(number(all, "SELECT count(*) FROM failures WHERE status = 'damaged'"), 1);
    EXPECT_EQ(number(all, "SELECT sum(vehicles + pedestrians + cyclists + structure + unknown) FROM scans"),
              number(all, "SELECT count(*) FROM obstacles"));
    EXPECT_EQ(number(all, "SELECT count(*) FROM tracks"),
              number(all, "SELECT count(*) FROM (SELECT DISTINCT result, id FROM obstacles WHERE age IS NOT NULL)"));
    EXPECT_EQ(number(all,
                     "SELECT count(*) FROM obstacles WHERE typeof(x) <> 'real' OR typeof(num_points) <> 'integer' "
                     "OR typeof(class) <> 'text'"),
              0);
    EXPECT_GT(number("out/timings.sqlite", "SELECT count(*) FROM timings WHERE detect_ms > 0 AND slowest_stage <> ''"),
              30);
}

TEST_F(FleetMerge, LeavesObstaclesOutWhereThatIsWanted) {
    runAndMerge("out", "--no-obstacles");
    EXPECT_EQ(number("out/fleet.sqlite", "SELECT count(*) FROM obstacles"), 0);
    EXPECT_GT(number("out/fleet.sqlite", "SELECT count(*) FROM tracks"), 10);
}

TEST_F(FleetMerge, PartsOfAManifestGoIntoFoldersOfTheirOwn) {
    fleet_.run("run m.jsonl --output out");
    test::shell("cd '" + fleet_.file("") + "' && { head -n 1 m.jsonl; tail -n 1 m.jsonl; } >part.jsonl");
    ASSERT_EQ(fleet_.run("merge part.jsonl --output out --into part/2"), 0) << fleet_.err();
    EXPECT_EQ(number("part/2/fleet.sqlite", "SELECT count(*) FROM results"), 1);
    EXPECT_TRUE(fs::exists(fleet_.file("part/2/report.html")));
    EXPECT_FALSE(fs::exists(fleet_.file("out/fleet.sqlite")));
}

TEST_F(FleetMerge, SaysWhatIsNotDoneYet) {
    fleet_.run("run m.jsonl --output out --shard 0/3");
    EXPECT_EQ(fleet_.run("merge m.jsonl --output out"), 1);
    EXPECT_THAT(fleet_.out(), HasSubstr("3 recordings, 0 failed or damaged, 2 not done yet"));
    EXPECT_EQ(countIn(readFile(fleet_.file("out/failures.csv")), ",missing,is not done yet"), 2U);
    EXPECT_EQ(number("out/fleet.sqlite", "SELECT count(*) FROM results"), 1);
}

TEST_F(FleetMerge, ReportSaysWhatWasSeen) {
    runAndMerge("out");
    const std::string text = report();
    for (const char* name : {"rec/tracks.rawlog", "rec/twice.rawlog", "rec/short.rawlog"})
        EXPECT_GE(countIn(text, name), 2U) << name << ": among the recordings and the strangest scans";
    EXPECT_THAT(text, HasSubstr("<td>pedestrian</td>"));
    EXPECT_THAT(readFile(fleet_.file("out/timings.html")), HasSubstr("rec/twice.rawlog"));
    EXPECT_THAT(text, Not(HasSubstr("baseline")));
}

TEST_F(FleetMerge, NamesFileAndLineOfResultsThatAreNotAsTheyWere) {
    fleet_.run("run m.jsonl --output out");
    const std::string tracks = (fleet_.resultsIn("out")[0] / "tracks.csv").string();
    const std::string good = readFile(tracks);
    writeFile(tracks, good + "1,vehicle,x,2,3,4,5,6,7,8,9\n");
    EXPECT_EQ(fleet_.run("merge m.jsonl --output out"), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr("tracks.csv:" + std::to_string(countIn(good, "\n") + 1) + ": 'x' in column"));
    writeFile(tracks, good + "1,vehicle\n");
    EXPECT_EQ(fleet_.run("merge m.jsonl --output out"), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr(": expected 11 cells"));
    writeFile(tracks, "a,b\n");
    EXPECT_EQ(fleet_.run("merge m.jsonl --output out"), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr("tracks.csv:1: expected the columns id,class"));
    EXPECT_FALSE(fs::exists(fleet_.file("out/fleet.sqlite")));
    writeFile(tracks, good);
    EXPECT_EQ(fleet_.run("merge m.jsonl --output out"), 0) << fleet_.err();
}

TEST_F(FleetMerge, FindsNoDriftWhereNothingChanged) {
    runAndMerge("old");
    fs::rename(fleet_.file("rec/short.rawlog"), fleet_.file("rec/renamed.rawlog"));  // content counts, not names
    ASSERT_EQ(fleet_.manifest(), 0);
    runAndMerge("out", "--baseline old/fleet.sqlite");
    EXPECT_THAT(fleet_.out(), HasSubstr("0 recordings changed against"));
    EXPECT_THAT(report(), HasSubstr("3 have the same bytes, <b>0 changed</b>; 0 are new, 0 are not there any more"));
}

TEST_F(FleetMerge, ShowsWhichRecordingsChangedSideBySide) {
    runAndMerge("old");
    fs::remove(fleet_.file("rec/short.rawlog"));
    fleet_.addRecording("new.rawlog", 3);
    ASSERT_EQ(fleet_.manifest("--set region.front=12"), 0) << fleet_.err();
    runAndMerge("out", "--baseline old/fleet.sqlite --replays 1");
    const std::string text = report();
    EXPECT_THAT(text, HasSubstr("0 have the same bytes, <b>2 changed</b>; 1 are new, 1 are not there any more"));
    EXPECT_THAT(text, HasSubstr("region.front: "));
    EXPECT_THAT(text, HasSubstr("<a href=\"replays/001.html\">side by side</a>"));
    const std::string pages = readFile(fleet_.file("out/replays/001.html"));
    for (const char* side : {"001_before.html", "001_now.html"}) {
        EXPECT_THAT(pages, HasSubstr(side));
        EXPECT_GT(fs::file_size(fleet_.file(std::string("out/replays/") + side)), 50000U);
    }
    EXPECT_NE(readFile(fleet_.file("out/replays/001_before.html")), readFile(fleet_.file("out/replays/001_now.html")));
    EXPECT_FALSE(fs::exists(fleet_.file("out/replays/002.html")));
}

TEST_F(FleetMerge, AsksForTheProgramOfAnotherVersion) {
    runAndMerge("old");
    test::shell("sqlite3 '" + fleet_.file("old/fleet.sqlite") +
                "' \"UPDATE about SET value = '0.0.1' WHERE name = 'version'\"");
    if (number("old/fleet.sqlite", "SELECT count(*) FROM about WHERE value = '0.0.1'") == 0)
        GTEST_SKIP() << "no sqlite3 here";
    ASSERT_EQ(fleet_.manifest("--set region.front=12"), 0);
    runAndMerge("out", "--baseline old/fleet.sqlite --replays 1");
    EXPECT_THAT(report(), HasSubstr("made by version 0.0.1: name its obstacle-replay with --baseline-replay"));
    fleet_.run("merge m.jsonl --output out --baseline old/fleet.sqlite --replays 1 --baseline-replay '" OBSTACLE_REPLAY
               "'");
    EXPECT_THAT(report(), HasSubstr("side by side"));
}

TEST_F(FleetMerge, RefusesABaselineThatIsNone) {
    fleet_.run("run m.jsonl --output out");
    writeFile(fleet_.file("text.sqlite"),
              "this is a text, and longer than the head of a database would have to be, it is\n");
    for (const char* name : {"none.sqlite", "text.sqlite"}) {
        EXPECT_EQ(fleet_.run(std::string("merge m.jsonl --output out --baseline ") + name), 1);
        EXPECT_THAT(fleet_.err(), HasSubstr(name));
        EXPECT_THAT(fleet_.err(), HasSubstr("--baseline wants fleet.sqlite"));
    }
}

}  // namespace
}  // namespace lidar_obstacles
