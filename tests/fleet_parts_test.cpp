// SPDX-License-Identifier: BSD-3-Clause
// The parts of obstacle-fleet by themselves: shards, contents, manifests, what is strange.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/obs/CObservationImage.h>
#include <mrpt/obs/CObservationPointCloud.h>

#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>

#include "common/run_app.h"
#include "content.h"
#include "find_recordings.h"
#include "manifest.h"
#include "scan_rows.h"
#include "shard.h"
#include "support/rawlog_files.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;
using test::readFile;
using test::writeFile;
using testing::ElementsAre;
using testing::HasSubstr;

Environment variables(const std::map<std::string, std::string>& values) {
    return [values](const char* name) {
        const auto at = values.find(name);
        return at == values.end() ? nullptr : at->second.c_str();
    };
}

template <typename Call>
std::string errorOf(const Call& call) {
    try {
        call();
    } catch (const std::exception& e) {
        return e.what();
    }
    return "";
}

void expectShard(const Shard& shard, std::size_t index, std::size_t count) {
    EXPECT_EQ(shard.index, index) << shard.source;
    EXPECT_EQ(shard.count, count) << shard.source;
}

TEST(FleetShard, IsWhatTheSchedulerSays) {
    expectShard(chooseShard("", variables({})), 0, 1);
    expectShard(chooseShard("", variables({{"OMPI_COMM_WORLD_RANK", "2"}, {"OMPI_COMM_WORLD_SIZE", "4"}})), 2, 4);
    expectShard(chooseShard("", variables({{"PMI_RANK", "1"}, {"PMI_SIZE", "3"}})), 1, 3);
    expectShard(chooseShard("", variables({{"SLURM_PROCID", "5"}, {"SLURM_NTASKS", "8"}})), 5, 8);
    const std::map<std::string, std::string> array = {{"SLURM_ARRAY_TASK_ID", "14"},  {"SLURM_ARRAY_TASK_COUNT", "4"},
                                                      {"SLURM_ARRAY_TASK_MIN", "10"}, {"SLURM_ARRAY_TASK_STEP", "2"},
                                                      {"SLURM_PROCID", "0"},          {"SLURM_NTASKS", "1"}};
    expectShard(chooseShard("", variables(array)), 2, 4);
    expectShard(chooseShard("3/5", variables(array)), 3, 5);
}

TEST(FleetShard, RefusesWhatWouldLeaveRecordingsOut) {
    for (const char* words : {"4/4", "1", "a/4", "1/0", "-1/4", "1/4x", "/"})
        EXPECT_THAT(errorOf([&] { chooseShard(words, variables({})); }), HasSubstr(std::string("--shard ") + words));
    // --array=3,7: the second of two, but of which shards?
    EXPECT_THAT(errorOf([&] {
                    chooseShard("", variables({{"SLURM_ARRAY_TASK_ID", "7"},
                                               {"SLURM_ARRAY_TASK_COUNT", "2"},
                                               {"SLURM_ARRAY_TASK_MIN", "3"},
                                               {"SLURM_ARRAY_TASK_STEP", "1"}}));
                }),
                HasSubstr("SLURM_ARRAY_TASK_ID=7"));
    EXPECT_THAT(errorOf([&] { chooseShard("", variables({{"SLURM_ARRAY_TASK_ID", "7"}})); }),
                HasSubstr("SLURM_ARRAY_TASK_COUNT"));
    EXPECT_THAT(errorOf([&] { chooseShard("", variables({{"PMI_RANK", "3"}, {"PMI_SIZE", "3"}})); }),
                HasSubstr("PMI_RANK=3"));
}

Manifest manifestOf(const std::vector<std::uint64_t>& sizes) {
    Manifest manifest;
    for (std::size_t k = 0; k < sizes.size(); ++k)
        manifest.recordings.push_back({"r" + std::to_string(k), {sizes[k], 0}, "", "", "key" + std::to_string(k)});
    return manifest;
}

TEST(FleetShard, HasEachRecordingOnceAndAsManyBytesAsTheOthers) {
    Manifest manifest = manifestOf({700, 100, 200, 300, 400, 500, 600, 100, 100});
    manifest.recordings.push_back(manifest.recordings.front());            // a copy under another name
    manifest.recordings.push_back({"bad", {}, "", "cannot read it", ""});  // nothing to do
    std::multiset<std::size_t> all;
    for (std::size_t s = 0; s < 3; ++s) {
        std::uint64_t bytes = 0;
        for (const std::size_t k : worksOf(manifest, {s, 3})) {
            all.insert(k);
            bytes += manifest.recordings[k].stamp.bytes;
        }
        EXPECT_EQ(bytes, 1000U) << s;
    }
    EXPECT_THAT(all, ElementsAre(0, 1, 2, 3, 4, 5, 6, 7, 8));
    EXPECT_TRUE(worksOf(manifestOf({1}), {1, 2}).empty());
}

TEST(FleetContent, IsSha256OfTheBytes) {
    const test::TempFolder folder;
    writeFile(folder.file("abc.rawlog"), "abc");
    const std::string abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";  // FIPS 180-4
    EXPECT_EQ(sha256Of("abc"), abc);
    EXPECT_EQ(contentOf(folder.file("abc.rawlog")), abc);
    EXPECT_EQ(contentOf(folder.file("abc.rawlog")), sha256OfFile(folder.file("abc.rawlog")));
    EXPECT_THAT(errorOf([&] { contentOf(folder.file("none")); }), HasSubstr("none: cannot read"));
    EXPECT_THAT(errorOf([&] { stampOf(folder.file("")); }), HasSubstr("not a file"));
}

/// A rawlog whose cloud is in 1.bin and whose image is in 1.png.
void writeRawlogNamingFiles(const std::string& path) {
    const auto cloud = mrpt::obs::CObservationPointCloud::Create();
    cloud->setAsExternalStorage("1.bin", mrpt::obs::CObservationPointCloud::ExternalStorageFormat::MRPT_Serialization);
    const auto camera = mrpt::obs::CObservationImage::Create();
    camera->image.setExternalStorage("1.png");
    test::writeRawlog(path, {cloud, camera}, true);
}

TEST(FleetContent, IncludesCloudsAndImagesWhereverTheyAreFound) {
    for (const std::string place : {"a_Images", "a_images", "Images", "."}) {
        const test::TempFolder folder;
        const std::string rawlog = folder.file("a.rawlog");
        writeRawlogNamingFiles(rawlog);
        const std::vector<std::string> named = filesNamedIn(rawlog);
        EXPECT_THAT(named, ElementsAre("1.bin", "1.png"));
        std::set<std::string> contents = {contentOf(rawlog, named)};
        EXPECT_EQ(*contents.begin(), sha256OfFile(rawlog)) << "neither is there";
        fs::create_directories(folder.file(place));
        for (const char* name : {"/1.bin", "/1.png"})
            for (const char* text : {"one", "two"}) {
                writeFile(folder.file(place + name), text);
                contents.insert(contentOf(rawlog, named));
            }
        EXPECT_EQ(contents.size(), 5U) << place;
        EXPECT_EQ(stampOf(rawlog, named).bytes, fs::file_size(rawlog) + 6) << place;
        writeFile(folder.file(place + "/notes.txt"), "of other things");
        EXPECT_EQ(contents.count(contentOf(rawlog, named)), 1U) << place;
    }
}

TEST(FleetContent, IsTheSameUnderAnotherName) {
    const test::TempFolder folder;
    writeRawlogNamingFiles(folder.file("a.rawlog"));
    fs::create_directories(folder.file("a_Images"));
    writeFile(folder.file("a_Images/1.bin"), "one");
    const std::string content = contentOf(folder.file("a.rawlog"), {"1.bin"});
    EXPECT_NE(content, sha256OfFile(folder.file("a.rawlog")));
    fs::rename(folder.file("a.rawlog"), folder.file("b.rawlog"));
    fs::rename(folder.file("a_Images"), folder.file("b_Images"));
    EXPECT_EQ(contentOf(folder.file("b.rawlog"), {"1.bin"}), content);
}

TEST(FleetContent, NamesNoFilesWhereThereIsNoRawlog) {
    const test::TempFolder folder;
    writeFile(folder.file("text.rawlog"), "abc");
    writeFile(folder.file("picture.rawlog"), "\x89PNG");
    for (const char* name : {"text.rawlog", "picture.rawlog", "none.rawlog"})
        EXPECT_TRUE(filesNamedIn(folder.file(name)).empty()) << name;
}

TEST(FleetRecordings, AreThoseOfFoldersAndLists) {
    const test::TempFolder folder;
    fs::create_directories(folder.file("a/b"));
    for (const char* name :
         {"a/2.RAWLOG", "a/b/1.pcap.gz", "a/b/3.pcapng", "a/notes.txt", "a/x.rawlog.part", "odd.bin"})
        writeFile(folder.file(name), "");
    EXPECT_THAT(findRecordings({folder.file("a"), folder.file("odd.bin"), folder.file("a/b")}, ""),
                ElementsAre(folder.file("a/2.RAWLOG"), folder.file("a/b/1.pcap.gz"), folder.file("a/b/3.pcapng"),
                            folder.file("odd.bin")));
    writeFile(folder.file("list"), "# two\n\n" + folder.file("gone.pcap") + "\r\n" + folder.file("a/b") + "\n");
    EXPECT_EQ(findRecordings({}, folder.file("list")).size(), 3U);
    EXPECT_THAT(errorOf([&] { findRecordings({folder.file("gone.pcap")}, ""); }), HasSubstr("gone.pcap: no such file"));
    EXPECT_THAT(errorOf([&] { findRecordings({}, folder.file("none")); }), HasSubstr("none: cannot read this list"));
    fs::create_directories(folder.file("empty"));
    EXPECT_THAT(errorOf([&] { findRecordings({folder.file("empty")}, ""); }), HasSubstr("empty: no recordings"));
}

TEST(FleetRecordings, FoldersBehindLinksAreSearchedOnce) {
    const test::TempFolder folder;
    fs::create_directories(folder.file("elsewhere"));
    fs::create_directories(folder.file("drives/day"));
    writeFile(folder.file("elsewhere/a.rawlog"), "");
    writeFile(folder.file("drives/day/b.rawlog"), "");
    fs::create_directory_symlink(folder.file("elsewhere"), folder.file("drives/linked"));
    fs::create_directory_symlink(folder.file("elsewhere"), folder.file("drives/twice"));
    fs::create_directory_symlink(folder.file("drives"), folder.file("drives/day/back"));
    fs::create_symlink(folder.file("gone"), folder.file("drives/broken"));
    fs::create_symlink("self", folder.file("drives/self"));
    EXPECT_EQ(findRecordings({folder.file("drives")}, "").size(), 2U);
}

TEST(FleetManifest, ComesBackAsItWasWritten) {
    const test::TempFolder folder;
    writeFile(folder.file("a \"b\".rawlog"), "abc");
    const Settings settings = makeSettings(DetectorParams{}, {"--sensor-label", "top"});
    const Manifest made = makeManifest(
        settings, {folder.file("a \"b\".rawlog"), folder.file("gone.pcap"), folder.file("\xff.pcap")}, {}, 3);
    writeManifest(folder.file("m"), made);
    const Manifest read = readOwnManifest(folder.file("m"));
    EXPECT_EQ(read.settings.parameters, settings.parameters);
    EXPECT_EQ(inputChoiceOf(read.settings.input_options).sensor_label, "top");
    ASSERT_EQ(read.recordings.size(), 3U);
    EXPECT_EQ(read.recordings[0].name, folder.file("a \"b\".rawlog"));
    EXPECT_EQ(read.recordings[0].key, keyOf(settings, sha256Of("abc")));
    EXPECT_TRUE(read.recordings[0].stamp == made.recordings[0].stamp);
    EXPECT_THAT(read.recordings[1].error, HasSubstr("gone.pcap: cannot read"));
    EXPECT_THAT(read.recordings[2].error, HasSubstr("UTF-8"));
}

TEST(FleetManifest, KeysFollowContentParametersModelAndOptions) {
    const test::TempFolder folder;
    DetectorParams params;
    const Settings settings = makeSettings(params, {});
    params.grid.resolution *= 1.5;
    std::set<std::string> keys = {keyOf(settings, "a"), keyOf(settings, "b"), keyOf(makeSettings(params, {}), "a"),
                                  keyOf(makeSettings(DetectorParams{}, {"--port", "1"}), "a")};
    for (const char* text : {"one", "another"}) {
        writeFile(folder.file("model"), text);
        DetectorParams learned;
        learned.recognizer.model = folder.file("model");
        keys.insert(keyOf(makeSettings(learned, {}), "a"));
    }
    EXPECT_EQ(keys.size(), 6U);
    EXPECT_EQ(keyOf(settings, "a"), keyOf(makeSettings(DetectorParams{}, {}), "a"));
}

TEST(FleetManifest, DoesNotReadAgainWhatIsKnown) {
    const test::TempFolder folder;
    const std::string name = folder.file("a.rawlog");
    writeFile(name, "abc");
    const Settings settings = makeSettings(DetectorParams{}, {});
    const Manifest first = makeManifest(settings, {name}, {}, 1);
    const auto time = fs::last_write_time(name);
    writeFile(name, "xyz");
    fs::last_write_time(name, time);  // as if nothing had happened: so one sees that it is not read
    EXPECT_EQ(makeManifest(settings, {name}, {first}, 1).recordings[0].sha256, sha256Of("abc"));
    EXPECT_EQ(makeManifest(settings, {name}, {}, 1).recordings[0].sha256, sha256Of("xyz"));
    writeFile(name, "uvwxyz");
    EXPECT_EQ(makeManifest(settings, {name}, {first}, 1).recordings[0].sha256, sha256Of("uvwxyz"));
}

TEST(FleetManifest, ReadsARecordingAgainWhereOneOfItsCloudsIsNew) {
    const test::TempFolder folder;
    const std::string name = folder.file("a.rawlog");
    writeRawlogNamingFiles(name);
    fs::create_directories(folder.file("Images"));
    writeFile(folder.file("Images/1.bin"), "one");
    const Settings settings = makeSettings(DetectorParams{}, {});
    writeManifest(folder.file("m"), makeManifest(settings, {name}, {}, 2));
    const Manifest known = readOwnManifest(folder.file("m"));
    EXPECT_THAT(known.recordings[0].named, ElementsAre("1.bin", "1.png"));
    const auto keyNow = [&] { return makeManifest(settings, {name}, {known}, 1).recordings[0].key; };
    EXPECT_EQ(keyNow(), known.recordings[0].key);
    writeFile(folder.file("Images/1.bin"), "another");
    EXPECT_NE(keyNow(), known.recordings[0].key);
}

TEST(FleetManifest, ErrorsNameFileAndLine) {
    const test::TempFolder folder;
    const std::string name = folder.file("m");
    writeFile(folder.file("a.rawlog"), "abc");
    writeManifest(name, makeManifest(makeSettings(DetectorParams{}, {}), {folder.file("a.rawlog")}, {}, 1));
    const std::string good = readFile(name);
    EXPECT_THAT(errorOf([&] { readManifest(folder.file("none")); }), HasSubstr("none: cannot read"));
    writeFile(name, "");
    EXPECT_THAT(errorOf([&] { readManifest(name); }), HasSubstr("m: is empty"));
    writeFile(name, good + "{\"name\":");
    EXPECT_THAT(errorOf([&] { readManifest(name); }), HasSubstr("m:3: "));
    std::string other = good;
    other.replace(other.find("grid"), 4, "grit");  // the parameters are not those of the keys any more
    writeFile(name, other);
    EXPECT_THAT(errorOf([&] { readManifest(name); }), HasSubstr("m:2: "));
    Manifest old = makeManifest(makeSettings(DetectorParams{}, {}), {}, {}, 1);
    old.settings.version = "0.0.1";
    writeManifest(name, old);
    EXPECT_THAT(errorOf([&] { readOwnManifest(name); }), HasSubstr("made by version 0.0.1"));
}

TEST(FleetStrange, IsTheScanThatIsUnlikeTheOthers) {
    std::vector<ScanRow> scans(20);
    for (std::size_t k = 0; k < scans.size(); ++k) {
        scans[k].returns = 20000 + 10 * (k % 3);
        scans[k].ground_percent = 50.0;
    }
    scans[7].ground_percent = 10.0;
    findStrange(scans);
    for (const ScanRow& s : scans) EXPECT_LE(s.strangeness, scans[7].strangeness);
    EXPECT_EQ(scans[7].strange_by, "ground_percent");
    EXPECT_NEAR(scans[7].strangeness, 40.0, 1e-9);  // the least that counts is one percent
    EXPECT_LT(scans[3].strangeness, 1.0);
    std::vector<ScanRow> few(4);
    few[0].returns = 1000;
    findStrange(few);
    EXPECT_EQ(few[0].strangeness, 0.0);
}

}  // namespace
}  // namespace lidar_obstacles::fleet
