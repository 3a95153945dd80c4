// SPDX-License-Identifier: BSD-3-Clause
#include "results_folder.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "common/text_file.h"
#include "replay_pages.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNote = "written.txt";

/// Names that a run may write, relative to the folder. Plots are found by their folder and endings.
std::set<std::string> namesOf(const EvaluateOptions& options, const std::vector<Job>& jobs) {
    std::set<std::string> names;
    for (const Variant& variant : options.variants)
        for (const char* name : {"metrics.json", "objects.csv", "matches.csv", "report.html"})
            names.insert((fs::path(variant.name) / name).string());
    for (const Variant& variant : options.variants)
        for (int k = 0; k < (options.report ? options.worst : 0); ++k)
            names.insert((fs::path(variant.name) / replayPageName(static_cast<std::size_t>(k))).string());
    for (const Job& job : jobs)
        if (job.files.detections.empty()) names.insert(fs::path(job.detections).lexically_relative(options.output));
    if (options.monza) names.insert({"monza.json", "monza.html"});
    return names;
}

/// The names of the note of an earlier run; those that would lead out of the folder are no names of ours.
std::set<std::string> notedIn(const fs::path& folder) {
    std::set<std::string> names;
    std::ifstream in(folder / kNote);
    for (std::string line; std::getline(in, line);) {
        const fs::path name(line);
        if (!line.empty() && name.is_relative() && std::find(name.begin(), name.end(), "..") == name.end())
            names.insert(line);
    }
    return names;
}

bool isRead(const fs::path& file, const std::vector<Job>& jobs) {
    std::error_code ignored;
    return std::any_of(jobs.begin(), jobs.end(), [&](const Job& job) {
        const SetFiles& f = job.files;
        const auto names = {&f.rawlog, &f.truth, &f.detections, &f.statics, &f.ego};
        return std::any_of(names.begin(), names.end(), [&](const std::string* name) {
            return !name->empty() && fs::equivalent(*name, file, ignored);
        });
    });
}

/// Scripts and pictures of gnuplot in a folder, with this beginning.
void removePlots(const fs::path& folder, const std::string& begin) {
    std::error_code ignored;
    std::vector<fs::path> found;
    for (fs::directory_iterator it(folder, ignored), end; it != end; it.increment(ignored)) {
        const std::string extension = it->path().extension().string();
        const bool is_plot = extension == ".gp" || extension == ".svg" || extension == ".png";
        if (is_plot && it->path().filename().string().rfind(begin, 0) == 0) found.push_back(it->path());
    }
    for (const fs::path& file : found) fs::remove(file, ignored);
}

}  // namespace

void beginResults(const EvaluateOptions& options, const std::vector<Job>& jobs) {
    const fs::path folder = options.output;
    std::error_code ignored;
    const std::set<std::string> noted = notedIn(folder);
    for (const std::string& name : noted) {
        const fs::path file = folder / name;
        if (!isRead(file, jobs)) fs::remove(file, ignored);
        if (file.filename() == "report.html") {
            removePlots(file.parent_path() / "plots", "");
            fs::remove(file.parent_path() / "plots", ignored);  // a folder only if it is empty
        }
        if (file.parent_path() != folder) fs::remove(file.parent_path(), ignored);
    }
    if (noted.count("monza.html") != 0) removePlots(folder, "fig_");
    std::string note;
    for (const std::string& name : namesOf(options, jobs)) note += name + '\n';
    writeTextFile(folder / kNote, note);
}

}  // namespace lidar_obstacles::apps
