// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A program that runs beside a test.
#pragma once

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "support/temp_folder.h"

namespace lidar_obstacles::test {

/// A program that runs beside the test; killed if it still does at the end.
class Program {
  public:
    /// @param limit  size of files [byte]; 0: none.
    Program(std::vector<std::string> command, const std::string& out, const std::string& err, rlim_t limit = 0) {
        process_ = fork();
        if (process_ != 0) return;
        dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDOUT_FILENO);
        dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666), STDERR_FILENO);
        if (limit > 0) {
            const rlimit files{limit, limit};
            signal(SIGXFSZ, SIG_IGN);
            setrlimit(RLIMIT_FSIZE, &files);
        }
        std::vector<char*> words;
        for (std::string& word : command) words.push_back(word.data());
        words.push_back(nullptr);
        setenv("ASAN_OPTIONS", "quarantine_size_mb=0", 1);  // what is freed is freed: memory is measured
        execv(words[0], words.data());
        _exit(127);
    }
    ~Program() {
        if (process_ <= 0) return;
        kill(process_, SIGKILL);
        wait();
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;

    void interrupt(int signal = SIGINT) const { kill(process_, signal); }
    /// As a terminal does at Ctrl-C; the program must have made a group of its own (setsid).
    void interruptGroup() const { kill(-process_, SIGINT); }
    /// Its exit code; -1 if it was killed.
    int wait() {
        int status = -1;
        if (process_ > 0) waitpid(std::exchange(process_, 0), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    /// Memory it has [kB].
    long residentKb() const {
        std::istringstream in(readFile("/proc/" + std::to_string(process_) + "/status"));
        for (std::string line; std::getline(in, line);)
            if (line.rfind("VmRSS:", 0) == 0) return std::stol(line.substr(6));
        return -1;
    }

  private:
    pid_t process_ = 0;
};

}  // namespace lidar_obstacles::test
