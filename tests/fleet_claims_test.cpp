// SPDX-License-Identifier: BSD-3-Clause
// Who does a piece of work, and what becomes of it when it crashes: claims, processes, the folder of results.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <new>

#include "claims.h"
#include "isolated.h"
#include "store.h"
#include "support/shell.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;
using test::readFile;
using test::writeFile;
using testing::HasSubstr;

class FleetClaims : public testing::Test {
  protected:
    FleetClaims() : store_(folder_.file("out")), place_(store_.claimsOf("abkey")) {}
    Claims claimsOf(const Owner& owner, double stale = 300.0) const {
        return {owner, stale, [this] { return store_.now(); }};
    }
    /// Leaves a claim behind, as a process that is killed does.
    void abandon(const Owner& owner) const {
        auto claim = claimsOf(owner).take(place_, "abkey");
        ASSERT_TRUE(claim);
        const std::string text = readFile((place_ / "abkey.0").string());
        claim.reset();
        writeFile((place_ / "abkey.0").string(), text);
    }

    test::TempFolder folder_;
    Store store_;
    fs::path place_;
};

/// A process that has ended.
Owner deadProcess() {
    const pid_t process = fork();
    if (process == 0) _exit(0);
    Owner dead = thisProcess();
    dead.process = process;
    waitpid(process, nullptr, 0);
    return dead;
}

Owner elsewhere() {
    Owner other = thisProcess();
    other.machine = "another one";
    return other;
}

TEST_F(FleetClaims, AreForOneAtATime) {
    const Claims claims = claimsOf(thisProcess());
    auto first = claims.take(place_, "abkey");
    ASSERT_TRUE(first);
    EXPECT_TRUE(first->holds());
    EXPECT_FALSE(claims.take(place_, "abkey"));
    EXPECT_FALSE(claimsOf(elsewhere()).take(place_, "abkey"));
    EXPECT_TRUE(claims.take(place_, "abother"));
    first.reset();
    EXPECT_TRUE(claims.take(place_, "abkey"));
    EXPECT_TRUE(fs::is_empty(place_));
}

TEST_F(FleetClaims, OfADeadProcessOfThisMachineAreVoid) {
    abandon(deadProcess());
    const auto claim = claimsOf(thisProcess()).take(place_, "abkey");
    ASSERT_TRUE(claim);
    EXPECT_TRUE(claim->holds());
}

TEST_F(FleetClaims, OfAnotherProcessWithItsNumberAreVoid) {
    Owner before = thisProcess();
    before.started -= 1;  // numbers of processes come again
    abandon(before);
    EXPECT_TRUE(claimsOf(thisProcess()).take(place_, "abkey"));
}

TEST_F(FleetClaims, OfTheSameTaskBeforeSlurmStartedItAgainAreVoid) {
    Owner before = elsewhere();
    before.job = "17.0";
    Owner now = thisProcess();
    now.job = before.job;
    abandon(before);
    EXPECT_FALSE(claimsOf(now).take(place_, "abkey"));
    now.restarts = 1;
    now.job = "18.0";
    EXPECT_FALSE(claimsOf(now).take(place_, "abkey"));
    now.job = before.job;
    EXPECT_TRUE(claimsOf(now).take(place_, "abkey"));
}

TEST_F(FleetClaims, OfOtherMachinesAreVoidWithoutASignOfLife) {
    abandon(elsewhere());
    const fs::path file = place_ / "abkey.0";
    const auto age = [&](int seconds) {
        fs::last_write_time(file, fs::file_time_type::clock::now() - std::chrono::seconds(seconds));
    };
    age(250);
    EXPECT_FALSE(claimsOf(thisProcess()).take(place_, "abkey"));
    age(350);
    EXPECT_TRUE(claimsOf(thisProcess()).take(place_, "abkey"));
}

TEST_F(FleetClaims, TellASleeperThatAnotherTookOver) {
    const Claims sleeper = claimsOf(elsewhere());
    const auto lost = sleeper.take(place_, "abkey");
    ASSERT_TRUE(lost);
    fs::last_write_time(place_ / "abkey.0", fs::file_time_type::clock::now() - std::chrono::hours(1));
    lost->beat();
    EXPECT_FALSE(claimsOf(thisProcess()).take(place_, "abkey"));  // it lives
    fs::last_write_time(place_ / "abkey.0", fs::file_time_type::clock::now() - std::chrono::hours(1));
    const auto taken = claimsOf(thisProcess()).take(place_, "abkey");
    ASSERT_TRUE(taken);
    EXPECT_FALSE(lost->holds());
    EXPECT_TRUE(taken->holds());
}

TEST_F(FleetClaims, OfManyProcessesAtOnceOneWins) {
    constexpr int kProcesses = 8;
    constexpr int kKeys = 100;
    for (int p = 0; p < kProcesses; ++p) {
        if (fork() != 0) continue;
        const Claims claims = claimsOf(thisProcess());
        for (int k = 0; k < kKeys; ++k) {
            const std::string key = "ab" + std::to_string(k);
            if (store_.isDone(key, false)) continue;
            const auto claim = claims.take(place_, key);
            if (!claim || store_.isDone(key, false)) continue;
            const int log = open(folder_.file("log").c_str(), O_WRONLY | O_APPEND | O_CREAT, 0666);
            if (write(log, ".", 1) != 1) _exit(1);
            close(log);
            const fs::path results = store_.begin(key, std::to_string(getpid()));
            writeFailure(results, {});
            if (!store_.publish(results, key, false)) _exit(2);
        }
        _exit(0);
    }
    for (int p = 0; p < kProcesses; ++p) {
        int status = -1;
        wait(&status);
        EXPECT_EQ(status, 0);
    }
    EXPECT_EQ(readFile(folder_.file("log")).size(), static_cast<std::size_t>(kKeys));
}

TEST(FleetStore, GivesResultsTheirPlaceAsAWholeAndOnce) {
    const test::TempFolder folder;
    const Store store(folder.file("out"));
    const auto write = [&](const char* who, const char* reason) {
        const fs::path results = store.begin("abkey", who);
        writeFailure(results, {Status::Failed, reason, true});
        return results;
    };
    write("killed", "half");
    const fs::path mine = write("me", "first");
    EXPECT_FALSE(fs::exists(store.resultOf("abkey")));
    EXPECT_TRUE(store.publish(mine, "abkey", false));
    EXPECT_FALSE(store.publish(write("you", "second"), "abkey", false));
    EXPECT_EQ(store.read("abkey").reason, "first");
    EXPECT_TRUE(store.isDone("abkey", true));  // another process did it while this one runs
    EXPECT_TRUE(fs::is_empty(folder.file("out/unfinished")));

    usleep(20000);
    const Store later(folder.file("out"));
    EXPECT_FALSE(later.isDone("abkey", false));  // the recording was not to blame
    EXPECT_TRUE(later.publish(write("me", "third"), "abkey", false));
    EXPECT_EQ(later.read("abkey").reason, "third");
    writeFile((store.resultOf("abkey") / "result.json").string(), "{\"status\":");
    EXPECT_THROW(later.read("abkey"), std::runtime_error);
}

Ending endingOf(const std::function<void()>& work, double timeout = 0.0) {
    return runIsolated(work, {timeout, {}, {}});
}

TEST(FleetIsolated, LosesNothingButTheWorkThatCrashes) {
    EXPECT_EQ(endingOf([] {}).kind, Ending::Kind::Well);
    const Ending crash = endingOf([] { raise(SIGABRT); });
    EXPECT_EQ(crash.kind, Ending::Kind::Failed);
    EXPECT_THAT(crash.reason, HasSubstr("crashed: "));
    EXPECT_FALSE(crash.again);
    EXPECT_EQ(endingOf([] { _exit(7); }).reason, "ended with exit code 7");
    const Ending killed = endingOf([] { raise(SIGKILL); });
    EXPECT_THAT(killed.reason, HasSubstr("was killed"));
    EXPECT_TRUE(killed.again);
    const Ending hung = endingOf([] { sleep(600); }, 0.1);
    EXPECT_THAT(hung.reason, HasSubstr("--timeout"));
    EXPECT_TRUE(hung.again);
}

TEST(FleetIsolated, SaysWhyWorkFailed) {
    const Ending bad = endingOf([] { throw std::runtime_error("a.rawlog: is bad"); });
    EXPECT_EQ(bad.reason, "a.rawlog: is bad");
    EXPECT_FALSE(bad.again);
    EXPECT_TRUE(endingOf([] { throw PassingError("gone"); }).again);
    EXPECT_EQ(endingOf([] { throw std::bad_alloc(); }).reason, "out of memory");
    EXPECT_EQ(endingOf([] { throw OutputError("disk full"); }).kind, Ending::Kind::NoOutput);
    EXPECT_EQ(runIsolated([] { sleep(600); }, {0.0, {}, [] { return true; }}).kind, Ending::Kind::Interrupted);
}

}  // namespace
}  // namespace lidar_obstacles::fleet
