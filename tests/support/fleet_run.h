// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// obstacle-fleet, run for a test, on recordings made of the shipped samples.
#pragma once

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "support/shell.h"
#include "support/temp_folder.h"

namespace lidar_obstacles::test {

/// Works in a folder of its own: recordings in rec/, the manifest is m.jsonl.
class FleetRun {
  public:
    /// @param program   obstacle-fleet.
    /// @param datasets  folder of street_sample.rawlog, 10 scans, and street_tracks.rawlog, 20 scans; ends with a
    /// slash.
    FleetRun(std::string program, std::string datasets) : program_(std::move(program)), datasets_(std::move(datasets)) {
        std::filesystem::create_directories(file("rec"));
    }

    std::string file(const std::string& name) const { return folder_.file(name); }
    const std::string& program() const { return program_; }

    /// The sample so many times in a row: each number gives other content.
    void addRecording(const std::string& name, int times = 1) const {
        std::string command = "for k in $(seq " + std::to_string(times) + "); do gunzip -c '" + datasets_ +
                              "street_sample.rawlog'; done >'" + file("rec/" + name) + "'";
        shell(command);
    }
    void addTracks(const std::string& name) const {
        std::filesystem::copy_file(datasets_ + "street_tracks.rawlog", file("rec/" + name));
    }
    /// Cut off in the middle of its second half.
    void addDamaged(const std::string& name) const {
        const std::string whole = readFile(datasets_ + "street_tracks.rawlog");
        writeFile(file("rec/" + name), whole.substr(0, whole.size() * 3 / 4));
    }

    /// @return the exit code; what was printed is in out() and err().
    int run(const std::string& arguments, const std::string& before = "") const {
        return shell("cd '" + file("") + "' && " + before + " '" + program_ + "' " + arguments + " >stdout 2>stderr");
    }
    int manifest(const std::string& arguments = "") const { return run("manifest rec --output m.jsonl " + arguments); }
    std::string out() const { return readFile(file("stdout")); }
    std::string err() const { return readFile(file("stderr")); }

    /// The files below a folder with their content, but for times.
    std::map<std::string, std::string> filesIn(const std::string& name) const {
        namespace fs = std::filesystem;
        std::map<std::string, std::string> files;
        if (!fs::exists(file(name))) return files;
        for (const auto& entry : fs::recursive_directory_iterator(file(name)))
            if (entry.is_regular_file() && entry.path().filename() != "timings.csv")
                files[fs::relative(entry.path(), file(name)).string()] = readFile(entry.path().string());
        return files;
    }
    /// The folders of results of an output folder.
    std::vector<std::filesystem::path> resultsIn(const std::string& output) const {
        namespace fs = std::filesystem;
        std::vector<fs::path> folders;
        if (!fs::exists(file(output + "/results"))) return folders;
        for (const auto& two : fs::directory_iterator(file(output + "/results")))
            for (const auto& one : fs::directory_iterator(two)) folders.push_back(one.path());
        std::sort(folders.begin(), folders.end());
        return folders;
    }

  private:
    TempFolder folder_;
    std::string program_, datasets_;
};

/// How often a word is in a text.
inline std::size_t countIn(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (auto at = text.find(word); at != std::string::npos; at = text.find(word, at + word.size())) ++count;
    return count;
}

}  // namespace lidar_obstacles::test
