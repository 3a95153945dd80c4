// SPDX-License-Identifier: BSD-3-Clause
#include "replays.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "common/text_file.h"
#include "html.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kWhole = 300;   // recordings up to so many scans are played as a whole
constexpr std::size_t kAround = 100;  // of others this many before and after the scan that changed most

/// obstacle-replay beside this program, as installed or as built; else whatever the shell would find.
std::string replayProgram() {
    std::error_code ignored;
    const fs::path here = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    for (const fs::path& place : {here / "obstacle-replay", here / "../obstacle-replay/obstacle-replay"})
        if (fs::is_regular_file(place, ignored)) return place.lexically_normal().string();
    return "obstacle-replay";
}

/// Runs a program with its output in a file. @return its exit code; 127 if it could not be started.
int runProgram(std::vector<std::string> command, const fs::path& log) {
    std::vector<char*> words;
    words.reserve(command.size() + 1);
    for (std::string& word : command) words.push_back(word.data());
    words.push_back(nullptr);
    std::fflush(nullptr);
    const pid_t process = fork();
    if (process == 0) {
        const int file = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
        dup2(file, STDOUT_FILENO);
        dup2(file, STDERR_FILENO);
        execvp(words[0], words.data());
        _exit(127);
    }
    int status = -1;
    while (process > 0 && waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return process > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : 127;
}

std::string lastLineOf(const fs::path& file) {
    std::ifstream in(file);
    std::string last;
    for (std::string line; std::getline(in, line);)
        if (!line.empty()) last = line;
    return last;
}

/// One of the two runs.
struct Side {
    std::string program;
    std::string name;  ///< "before" or "now"
    std::string parameters;
    std::vector<std::string> options;
};

class Pages {
  public:
    Pages(fs::path folder, const Settings& settings) : folder_(std::move(folder)), settings_(settings) {
        std::error_code ignored;
        fs::remove_all(folder_, ignored);  // of an earlier merge
        fs::create_directories(folder_);
    }

    /// @throws std::runtime_error saying why there is no page.
    void play(const Side& side, const Change& change, const std::string& number) const {
        const std::string stem = number + "_" + side.name;
        const fs::path config = folder_ / (side.name + ".ini");
        const fs::path output = folder_ / stem;
        apps::writeTextFile(config, side.parameters);
        std::vector<std::string> command = {side.program, pathOf(settings_, change.name).string(),
                                            "--config",   config.string(),
                                            "--output",   output.string(),
                                            "--report",   (folder_ / (stem + ".html")).string()};
        command.insert(command.end(), side.options.begin(), side.options.end());
        if (std::max(change.scans_before, change.scans_now) > kWhole) {
            const std::size_t from = change.worst_scan - std::min(change.worst_scan, kAround);
            for (const std::string& word : {std::string("--from"), std::to_string(from), std::string("--to"),
                                            std::to_string(change.worst_scan + kAround)})
                command.push_back(word);
        }
        const fs::path log = folder_ / (stem + ".log");
        const int code = runProgram(command, log);
        std::error_code ignored;
        fs::remove_all(output, ignored);
        if (!fs::exists(folder_ / (stem + ".html"), ignored))  // of a damaged recording there is one, with code 1
            throw std::runtime_error(code == 127 ? side.program + ": cannot be started" : lastLineOf(log));
    }

    std::string join(const Change& change, const std::string& number) const {
        const std::string page = number + ".html";
        const std::string side = "<div><h2>%</h2><iframe src=\"" + number + "_%.html\"></iframe></div>\n";
        std::string text = "<!doctype html><meta charset=\"utf-8\"><title>" + escaped(change.name) +
                           "</title><style>body{margin:0;font:15px sans-serif;display:flex;flex-direction:column;"
                           "height:100vh}h1,h2{font-size:1em;margin:.4em .6em}main{flex:1;display:flex}"
                           "main div{flex:1;display:flex;flex-direction:column;border-left:1px solid #888}"
                           "iframe{flex:1;border:0}</style>\n<h1>" +
                           escaped(change.name) + ": most boxes changed in scan " + std::to_string(change.worst_scan) +
                           "</h1>\n<main>\n";
        for (const char* name : {"before", "now"}) {
            std::string part = side;
            for (auto at = part.find('%'); at != std::string::npos; at = part.find('%')) part.replace(at, 1, name);
            text += part;
        }
        apps::writeTextFile(folder_ / page, text + "</main>\n");
        return folder_.filename().string() + "/" + page;
    }

  private:
    fs::path folder_;
    const Settings& settings_;
};

}  // namespace

void makeReplays(const MergeOptions& options, const Settings& now, Drift& drift) {
    const std::size_t count = std::min(drift.changes.size(), static_cast<std::size_t>(options.replays));
    if (count == 0) return;
    const Pages pages(options.into / "replays", now);
    const std::string program = options.replay.empty() ? replayProgram() : options.replay;
    const std::string before_program = options.baseline_replay.empty() ? program : options.baseline_replay;
    const Side before{before_program, "before", drift.parameters, drift.options};
    const Side after{program, "now", now.parameters, now.input_options};
    for (std::size_t k = 0; k < count; ++k) {
        char number[32];
        std::snprintf(number, sizeof number, "%03zu", k + 1);
        Change& change = drift.changes[k];
        try {
            if (drift.version != now.version && options.baseline_replay.empty())
                throw std::runtime_error("the baseline was made by version " + drift.version +
                                         ": name its obstacle-replay with --baseline-replay");
            pages.play(before, change, number);
            pages.play(after, change, number);
            change.replay = pages.join(change, number);
        } catch (const std::exception& e) {
            change.no_replay = e.what();
        }
    }
}

}  // namespace lidar_obstacles::fleet
