// SPDX-License-Identifier: BSD-3-Clause
#include "gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "common/text_file.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

std::string readText(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Runs gnuplot with its output in `log`; its exit status. @throws std::runtime_error if it cannot be started.
int runGnuplot(std::vector<std::string> arguments, const fs::path& folder, const fs::path& log) {
    arguments.insert(arguments.begin(), "gnuplot");
    std::vector<char*> argv;
    for (std::string& a : arguments) argv.push_back(a.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions{};
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawnattr_t own_group;  // Ctrl-C goes to all of a group: a plot that was begun is completed
    posix_spawnattr_init(&own_group);
    posix_spawnattr_setflags(&own_group, POSIX_SPAWN_SETPGROUP);
    pid_t pid = 0;
    const int error = posix_spawnp(&pid, "gnuplot", &actions, &own_group, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&own_group);
    if (error != 0) throw std::runtime_error(std::string("cannot run gnuplot: ") + std::strerror(error));
    int status = 0;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

bool hasGnuplot() {
    try {
        return runGnuplot({"--version"}, ".", "/dev/null") == 0;
    } catch (const std::runtime_error&) {
        return false;
    }
}

void plot(const fs::path& stem, const std::string& script) {
    const fs::path file = stem.string() + ".gp";
    const fs::path log = fs::absolute(stem.string() + ".log");
    writeTextFile(file, script);
    const int code = runGnuplot({file.filename().string()}, fs::absolute(file).parent_path(), log);
    const std::string said = readText(log);
    fs::remove(log);
    if (code != 0) throw std::runtime_error(file.string() + ": gnuplot failed: " + said);
}

}  // namespace lidar_obstacles::apps
