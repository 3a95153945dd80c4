// SPDX-License-Identifier: BSD-3-Clause
// `obstacle-fleet run` from end to end: resume, failures, no work twice, any sharding, whole results, clear errors.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <fstream>
#include <optional>
#include <set>

#include "support/fleet_run.h"
#include "support/program.h"

namespace lidar_obstacles {
namespace {

namespace fs = std::filesystem;
using test::countIn;
using test::readFile;
using test::writeFile;
using testing::HasSubstr;
using testing::Not;

class Fleet : public testing::Test {
  protected:
    /// One recording of some time of work, which is begun first, and small ones.
    void addMany() const {
        fleet_.addRecording("long.rawlog", 12);
        for (int k = 1; k <= 4; ++k) fleet_.addRecording("r" + std::to_string(k) + ".rawlog", k);
        ASSERT_EQ(fleet_.manifest(), 0) << fleet_.err();
    }
    std::unique_ptr<test::Program> start(const std::string& log, rlim_t limit = 0) const {
        return std::make_unique<test::Program>(
            std::vector<std::string>{fleet_.program(), "run", fleet_.file("m.jsonl"), "--output", fleet_.file("out")},
            fleet_.file(log), fleet_.file(log + ".err"), limit);
    }
    /// The process that works on a recording, once obstacles.csv grows; its parent is obstacle-fleet.
    pid_t awaitWorker(const std::string& tool_log) const {
        for (int k = 0; k < 6000; ++k, usleep(5000)) {
            if (!fs::exists(fleet_.file("out/unfinished"))) continue;
            for (const auto& file : fs::recursive_directory_iterator(fleet_.file("out/unfinished")))
                if (file.path().filename() == "obstacles.csv.part" && file.file_size() > 5000) return childOf(file);
        }
        ADD_FAILURE() << readFile(fleet_.file(tool_log + ".err"));
        return 0;
    }
    /// unfinished/<key>.<machine>.<process>.<started>/obstacles.csv.part
    static pid_t childOf(const fs::path& file) {
        const std::string folder = file.parent_path().filename().string();
        const std::string process = folder.substr(0, folder.rfind('.'));
        const std::string parent = process.substr(process.rfind('.') + 1);
        std::ifstream in("/proc/" + parent + "/task/" + parent + "/children");
        pid_t child = 0;
        in >> child;
        return child;
    }
    void expectWholeResults() const {
        for (const fs::path& folder : fleet_.resultsIn("out")) {
            EXPECT_TRUE(fs::exists(folder / "result.json")) << folder;
            for (const auto& file : fs::directory_iterator(folder))
                EXPECT_NE(file.path().extension(), ".part") << file.path();
        }
    }
    void expectAllAsBy(const std::string& arguments) const {
        fleet_.run("run m.jsonl --output again " + arguments);
        EXPECT_TRUE(fleet_.filesIn("out/results") == fleet_.filesIn("again/results"));
    }

    test::FleetRun fleet_{OBSTACLE_FLEET, DATASETS};
};

TEST_F(Fleet, FindsWhatObstacleReplayFinds) {
    fleet_.addTracks("a.rawlog");
    ASSERT_EQ(fleet_.manifest("--set tracking.max_hidden=2"), 0) << fleet_.err();
    ASSERT_EQ(fleet_.run("run m.jsonl --output out"), 0) << fleet_.err();
    ASSERT_EQ(test::shell("'" OBSTACLE_REPLAY "' '" + fleet_.file("rec/a.rawlog") +
                          "' --set tracking.max_hidden=2 --output '" + fleet_.file("replay") + "' >/dev/null 2>&1"),
              0);
    ASSERT_EQ(fleet_.resultsIn("out").size(), 1U);
    const fs::path results = fleet_.resultsIn("out").front();
    EXPECT_GT(fs::file_size(results / "obstacles.csv"), 10000U);
    EXPECT_EQ(readFile((results / "obstacles.csv").string()), readFile(fleet_.file("replay/obstacles.csv")));
}

TEST_F(Fleet, DoesNotDoTwiceWhatIsDone) {
    fleet_.addRecording("a.rawlog");
    fleet_.addRecording("b.rawlog", 2);
    fleet_.addRecording("copy.rawlog");
    ASSERT_EQ(fleet_.manifest(), 0);
    ASSERT_EQ(fleet_.run("run m.jsonl --output out"), 0);
    EXPECT_EQ(countIn(fleet_.out(), ": done in "), 2U) << fleet_.out();
    ASSERT_EQ(fleet_.run("run m.jsonl --output out"), 0);
    EXPECT_EQ(countIn(fleet_.out(), ": done in "), 0U) << fleet_.out();
    fleet_.addRecording("c.rawlog", 3);
    fs::rename(fleet_.file("rec/a.rawlog"), fleet_.file("rec/renamed.rawlog"));
    ASSERT_EQ(fleet_.manifest(), 0);
    ASSERT_EQ(fleet_.run("run m.jsonl --output out"), 0);
    EXPECT_EQ(countIn(fleet_.out(), ": done in "), 1U) << fleet_.out();
    EXPECT_THAT(fleet_.out(), HasSubstr("c.rawlog: done in "));
    ASSERT_EQ(fleet_.manifest("--set grid.resolution=0.15"), 0);  // other parameters are other work
    ASSERT_EQ(fleet_.run("run m.jsonl --output out"), 0);
    EXPECT_EQ(countIn(fleet_.out(), ": done in "), 3U) << fleet_.out();
}

TEST_F(Fleet, AManifestThatCannotBeWrittenLeavesTheOneThereIs) {
    for (int k = 0; k < 9; ++k) writeFile(fleet_.file("rec/" + std::to_string(k) + ".rawlog"), "a" + std::to_string(k));
    ASSERT_EQ(fleet_.manifest(), 0) << fleet_.err();
    const std::string whole = readFile(fleet_.file("m.jsonl"));
    const std::size_t blocks = whole.find('\n') / 512 + 1;  // room for the settings
    ASSERT_LT(512 * blocks, whole.size());
    const std::string full = "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + ";";
    EXPECT_EQ(fleet_.run("manifest rec --output m.jsonl", full), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr("m.jsonl: cannot write"));
    EXPECT_TRUE(readFile(fleet_.file("m.jsonl")) == whole);
    EXPECT_FALSE(fs::exists(fleet_.file("m.jsonl.part")));
}

TEST_F(Fleet, HasTheSameBytesForAnySharding) {
    addMany();
    fleet_.addDamaged("damaged.rawlog");
    ASSERT_EQ(fleet_.manifest(), 0);
    EXPECT_EQ(fleet_.run("run m.jsonl --output out"), 1);
    for (int s = 0; s < 2; ++s) fleet_.run("run m.jsonl --output two --shard " + std::to_string(s) + "/2");
    for (int s = 3; s >= 0; --s)
        fleet_.run("run m.jsonl --output four",
                   "env SLURM_ARRAY_TASK_ID=" + std::to_string(s) + " SLURM_ARRAY_TASK_COUNT=4 SLURM_ARRAY_TASK_MIN=0");
    ASSERT_EQ(fleet_.resultsIn("out").size(), 6U);
    EXPECT_TRUE(fleet_.filesIn("out/results") == fleet_.filesIn("two/results"));
    EXPECT_TRUE(fleet_.filesIn("out/results") == fleet_.filesIn("four/results"));
    for (const char* output : {"out", "two", "four"}) fleet_.run(std::string("merge m.jsonl --output ") + output);
    for (const char* name : {"fleet.sqlite", "report.html", "failures.csv"}) {
        EXPECT_FALSE(readFile(fleet_.file(std::string("out/") + name)).empty()) << name;
        for (const char* other : {"two/", "four/"})
            EXPECT_TRUE(readFile(fleet_.file(std::string("out/") + name)) ==
                        readFile(fleet_.file(other + std::string(name))))
                << other << name;
    }
}

TEST_F(Fleet, ListsWhyRecordingsFailAndKeepsTheOthers) {
    fleet_.addRecording("good.rawlog");
    fleet_.addDamaged("damaged.rawlog");
    writeFile(fleet_.file("rec/empty.rawlog"), "");
    writeFile(fleet_.file("rec/junk.pcap"), "no capture");
    ASSERT_EQ(fleet_.manifest(), 0);
    EXPECT_EQ(fleet_.run("run m.jsonl --output out"), 1);
    EXPECT_THAT(fleet_.out(), HasSubstr("rec/good.rawlog: done in "));
    EXPECT_THAT(fleet_.err(), HasSubstr("rec/damaged.rawlog: damaged: rec/damaged.rawlog: object "));
    EXPECT_THAT(fleet_.err(), HasSubstr("rec/empty.rawlog: failed: rec/empty.rawlog: no lidar scans in it"));
    EXPECT_THAT(fleet_.err(), HasSubstr("rec/junk.pcap: failed: rec/junk.pcap: neither a rawlog nor"));
    // Once more it says so again, and tries none of it: the recordings are to blame.
    EXPECT_EQ(fleet_.run("run m.jsonl --output out"), 1);
    EXPECT_EQ(countIn(fleet_.err(), " before: "), 3U) << fleet_.err();
    EXPECT_EQ(fleet_.run("run m.jsonl --output out --retry-failed"), 1);
    EXPECT_THAT(fleet_.out(), HasSubstr("4 recordings: 3 done now, 1 before, 3 of these failed, 0 left"));
    EXPECT_EQ(fleet_.run("merge m.jsonl --output out"), 1);
    const std::string list = readFile(fleet_.file("out/failures.csv"));
    EXPECT_EQ(countIn(list, "\n"), 4U) << list;
    EXPECT_THAT(list, HasSubstr("rec/damaged.rawlog,damaged,rec/damaged.rawlog: object "));
}

TEST_F(Fleet, TriesAgainWhatWasNotTheRecordingsFault) {
    fleet_.addRecording("a.rawlog");
    fleet_.addRecording("b.rawlog", 2);
    ASSERT_EQ(fleet_.manifest(), 0);
    fs::rename(fleet_.file("rec/a.rawlog"), fleet_.file("a"));
    EXPECT_EQ(fleet_.run("run m.jsonl --output out"), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr("rec/a.rawlog: failed: rec/a.rawlog: cannot read: No such file"));
    writeFile(fleet_.file("rec/a.rawlog"), "another one");
    EXPECT_EQ(fleet_.run("run m.jsonl --output out"), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr("rec/a.rawlog: changed since the manifest was made"));
    fs::rename(fleet_.file("a"), fleet_.file("rec/a.rawlog"));
    fs::last_write_time(fleet_.file("rec/a.rawlog"), fs::file_time_type::clock::now());  // touched is not changed
    EXPECT_EQ(fleet_.run("run m.jsonl --output out"), 0) << fleet_.err();
    EXPECT_THAT(fleet_.out(), HasSubstr("2 recordings: 1 done now, 1 before, 0 of these failed, 0 left"));
}

TEST_F(Fleet, TakesUpWhatAKilledRunHadBegun) {
    addMany();
    const auto killed = start("first");
    ASSERT_GT(awaitWorker("first"), 0);
    killed->interrupt(SIGKILL);
    killed->wait();
    expectWholeResults();
    const std::size_t before = fleet_.resultsIn("out").size();
    EXPECT_LT(before, 5U);
    ASSERT_EQ(fleet_.run("run m.jsonl --output out"), 0) << fleet_.err();  // at once: its claim is void
    EXPECT_EQ(countIn(fleet_.out(), ": done in "), 5U - before);
    expectWholeResults();
    expectAllAsBy("");
}

TEST_F(Fleet, EndsOrderlyOnASignalAndIsTakenUp) {
    addMany();
    const auto stopped = start("first");
    ASSERT_GT(awaitWorker("first"), 0);
    stopped->interrupt(SIGTERM);
    EXPECT_EQ(stopped->wait(), 130);
    EXPECT_THAT(readFile(fleet_.file("first.err")), HasSubstr("the same command takes it up"));
    EXPECT_TRUE(fs::is_empty(fleet_.file("out/unfinished")));
    ASSERT_EQ(fleet_.run("run m.jsonl --output out"), 0) << fleet_.err();
    expectAllAsBy("--shard 0/1");
}

TEST_F(Fleet, ACrashLosesOneRecordingOnly) {
    addMany();
    const auto run = start("first");
    const pid_t worker = awaitWorker("first");
    ASSERT_GT(worker, 0);
    kill(worker, SIGABRT);
    EXPECT_EQ(run->wait(), 1);
    EXPECT_THAT(readFile(fleet_.file("first.err")), HasSubstr("rec/long.rawlog: failed: crashed: Aborted (signal 6)"));
    EXPECT_EQ(countIn(readFile(fleet_.file("first")), ": done in "), 4U);
    EXPECT_EQ(fleet_.run("run m.jsonl --output out"), 1);  // a crash would come again
    EXPECT_EQ(fleet_.run("run m.jsonl --output out --retry-failed"), 0) << fleet_.err();
    expectAllAsBy("");
}

TEST_F(Fleet, TwoRunsAtOnceShareTheWork) {
    addMany();
    for (int k = 5; k <= 9; ++k) fleet_.addRecording("s" + std::to_string(k) + ".rawlog", k);
    ASSERT_EQ(fleet_.manifest(), 0);
    const auto first = start("first"), second = start("second"), third = start("third");
    EXPECT_EQ(first->wait(), 0);
    EXPECT_EQ(second->wait(), 0);
    EXPECT_EQ(third->wait(), 0);
    std::size_t in_all = 0;
    for (const char* log : {"first", "second", "third"}) {
        const std::string said = readFile(fleet_.file(log));
        in_all += countIn(said, ": done in ");
        EXPECT_THAT(said, HasSubstr(" 0 left")) << "each waits for the others' work";
    }
    EXPECT_EQ(in_all, 10U);
    expectAllAsBy("");
}

TEST_F(Fleet, StopsWhereResultsCannotBeWritten) {
    addMany();
    const auto run = start("first", 20000);  // bytes that a file may have
    EXPECT_EQ(run->wait(), 1);
    EXPECT_THAT(readFile(fleet_.file("first.err")), HasSubstr("obstacles.csv: cannot write: File too large"));
    EXPECT_TRUE(fleet_.resultsIn("out").empty());
    EXPECT_EQ(fleet_.run("run m.jsonl --output out"), 0) << fleet_.err();
    writeFile(fleet_.file("file"), "");
    EXPECT_EQ(fleet_.run("run m.jsonl --output file"), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr("file/results: cannot make the folder"));
}

TEST_F(Fleet, ErrorsNameWhatIsWrong) {
    EXPECT_EQ(fleet_.run("manifest none"), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr("none: no such file or folder"));
    EXPECT_EQ(fleet_.run("manifest"), 2);
    EXPECT_THAT(fleet_.err(), HasSubstr("INPUT or --list is missing"));
    EXPECT_EQ(fleet_.run(""), 2);
    EXPECT_EQ(fleet_.run("run none.jsonl"), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr("none.jsonl: cannot read this manifest"));
    fleet_.addRecording("a.rawlog");
    EXPECT_EQ(fleet_.manifest("--set grid.resolution=9"), 2);
    EXPECT_EQ(fleet_.manifest("--set recognizer.model=none.txt"), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr("none.txt: cannot read"));
    writeFile(fleet_.file("list"), "rec/a.rawlog\nrec/gone.rawlog\n");
    EXPECT_EQ(fleet_.run("manifest --list list --output m.jsonl"), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr("gone.rawlog: cannot read: No such file"));
    EXPECT_EQ(fleet_.run("run m.jsonl --output out --shard 2/2"), 2);
    EXPECT_THAT(fleet_.err(), HasSubstr("--shard 2/2: must be I/N"));
    EXPECT_EQ(fleet_.run("run m.jsonl --output out", "env SLURM_ARRAY_TASK_ID=x"), 2);
    EXPECT_THAT(fleet_.err(), HasSubstr("SLURM_ARRAY_TASK_ID=x"));
    EXPECT_EQ(fleet_.run("run m.jsonl --output out"), 0);
    EXPECT_EQ(fleet_.run("merge m.jsonl --output out"), 1);  // what the manifest could not read is listed
    EXPECT_THAT(readFile(fleet_.file("out/failures.csv")), HasSubstr("rec/gone.rawlog,failed,"));
    EXPECT_EQ(fleet_.manifest("--sensor-label rear"), 0);
    EXPECT_EQ(fleet_.run("run m.jsonl --output out"), 1);
    EXPECT_THAT(fleet_.err(), HasSubstr("rec/a.rawlog: no lidar scans of 'rear' in it"));
}

TEST_F(Fleet, GnuParallelRunsAllShards) {
    if (test::shell("command -v parallel >/dev/null") != 0) GTEST_SKIP() << "no GNU parallel here";
    fleet_.addRecording("a b.rawlog");
    fleet_.addRecording("c.rawlog", 2);
    ASSERT_EQ(fleet_.manifest(), 0);
    ASSERT_EQ(test::shell("cd '" + fleet_.file("") + "' && OBSTACLE_FLEET='" + fleet_.program() +
                          "' '" SCRIPTS "fleet_parallel.sh' m.jsonl 'out put' 2 >stdout 2>stderr"),
              0)
        << fleet_.err();
    EXPECT_EQ(countIn(fleet_.out(), ": done in "), 2U) << fleet_.out();
    EXPECT_EQ(countIn(fleet_.out(), "\nshard ") + 1, 8U) << fleet_.out();
    EXPECT_TRUE(fs::exists(fleet_.file("out put/fleet.sqlite")));
    writeFile(fleet_.file("rec/junk.pcap"), "no capture");
    ASSERT_EQ(fleet_.manifest(), 0);
    EXPECT_EQ(test::shell("cd '" + fleet_.file("") + "' && OBSTACLE_FLEET='" + fleet_.program() +
                          "' '" SCRIPTS "fleet_parallel.sh' m.jsonl 'out put' 2 >stdout 2>stderr"),
              1);
    EXPECT_EQ(countIn(fleet_.out(), ": done in "), 0U) << fleet_.out();
}

}  // namespace
}  // namespace lidar_obstacles
