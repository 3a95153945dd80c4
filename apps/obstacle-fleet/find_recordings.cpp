// SPDX-License-Identifier: BSD-3-Clause
#include "find_recordings.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iostream>
#include <iterator>
#include <set>
#include <stdexcept>

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;

std::string lowerCase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

void addLines(std::istream& in, std::vector<std::string>& inputs) {
    for (std::string line; std::getline(in, line);) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (!line.empty() && line.front() != '#') inputs.push_back(line);
    }
}

void addList(const std::string& list, std::vector<std::string>& inputs) {
    if (list.empty()) return;
    if (list == "-") return addLines(std::cin, inputs);
    std::ifstream in(list);
    if (!in || fs::is_directory(list)) throw std::runtime_error(list + ": cannot read this list of recordings");
    addLines(in, inputs);
}

/// Also in folders that links lead to, in each of them once.
void addFolder(const fs::path& folder, std::vector<std::string>& found) {
    std::error_code error, ignored;
    std::set<fs::path> visited{fs::canonical(folder, ignored)};
    fs::recursive_directory_iterator at(folder, fs::directory_options::follow_directory_symlink, error), end;
    for (; !error && at != end; at.increment(error)) {
        if (at->is_directory(ignored) && !visited.insert(fs::canonical(at->path(), ignored)).second)
            at.disable_recursion_pending();
        if (isRecordingName(at->path()) && at->is_regular_file(ignored)) found.push_back(at->path().string());
    }
    if (error) throw std::runtime_error(folder.string() + ": cannot search this folder: " + error.message());
}

}  // namespace

bool isRecordingName(const fs::path& file) {
    std::string name = lowerCase(file.filename().string());
    if (fs::path(name).extension() == ".gz") name = fs::path(name).stem().string();
    const fs::path end = fs::path(name).extension();
    return end == ".rawlog" || end == ".pcap" || end == ".pcapng";
}

std::vector<std::string> findRecordings(const std::vector<std::string>& inputs, const std::string& list) {
    std::vector<std::string> all = inputs;
    addList(list, all);
    std::vector<std::string> found;
    found.reserve(all.size());
    for (const std::string& input : all) {
        if (fs::is_directory(input))
            addFolder(input, found);
        else if (list.empty() && !fs::exists(input))
            throw std::runtime_error(input + ": no such file or folder");
        else
            found.push_back(input);  // of a list, what is not there is a bad recording among others
    }
    for (std::string& name : found) name = fs::path(name).lexically_normal().string();
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    if (!found.empty()) return found;
    std::string names;
    for (const std::string& input : all) names += (names.empty() ? "" : ", ") + input;
    throw std::runtime_error((names.empty() ? list : names) +
                             ": no recordings there (.rawlog, .pcap, .pcapng, also .gz)");
}

}  // namespace lidar_obstacles::fleet
