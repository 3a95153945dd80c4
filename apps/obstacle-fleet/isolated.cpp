// SPDX-License-Identifier: BSD-3-Clause
#include "isolated.h"

#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <new>

#include "common/message_of.h"

namespace lidar_obstacles::fleet {
namespace {

using Clock = std::chrono::steady_clock;

enum Code { kWell = 0, kFailed = 1, kAgain = 3, kNoOutput = 4 };

struct Verdict {
    Code code = kWell;
    std::string reason;
};

Verdict verdictOn(const std::function<void()>& work) {
    try {
        work();
        return {};
    } catch (const OutputError& e) {
        return {kNoOutput, e.what()};
    } catch (const PassingError& e) {
        return {kAgain, e.what()};
    } catch (const std::bad_alloc&) {
        return {kAgain, "out of memory"};
    } catch (const std::exception& e) {
        return {kFailed, apps::messageOf(e)};
    } catch (...) {
        return {kFailed, "an error without a message"};
    }
}

/// The work's own process. It ends with the one that started it, and obeys signals as programs do.
[[noreturn]] void workAndExit(const std::function<void()>& work, int out, pid_t parent) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(kAgain);  // it ended before that
    for (const int signal : {SIGINT, SIGTERM}) ::signal(signal, SIG_DFL);
    const Verdict verdict = verdictOn(work);
    const std::string reason = verdict.reason.substr(0, 4000);  // fits into a pipe
    if (write(out, reason.data(), reason.size()) < 0) _exit(kAgain);
    std::fflush(nullptr);
    _exit(verdict.code);
}

Ending endingOf(int status, const std::string& reason) {
    if (WIFSIGNALED(status)) {
        const int signal = WTERMSIG(status);
        const std::string name = std::string(strsignal(signal)) + " (signal " + std::to_string(signal) + ")";
        if (signal == SIGKILL) return {Ending::Kind::Failed, "was killed, as where memory runs out: " + name, true};
        if (signal == SIGTERM || signal == SIGINT) return {Ending::Kind::Failed, "was stopped: " + name, true};
        return {Ending::Kind::Failed, "crashed: " + name, false};
    }
    switch (WEXITSTATUS(status)) {
        case kWell:
            return {};
        case kNoOutput:
            return {Ending::Kind::NoOutput, reason, true};
        case kAgain:
            return {Ending::Kind::Failed, reason, true};
        default:
            break;
    }
    const std::string code = "ended with exit code " + std::to_string(WEXITSTATUS(status));
    return {Ending::Kind::Failed, reason.empty() ? code : reason, false};
}

/// Reads what the process says until it ends. @return false if it was ended by `watch`, in `why`.
bool listen(int in, const Watch& watch, std::string& said, Ending& why) {
    const auto start = Clock::now();
    for (;;) {
        pollfd ready{in, POLLIN, 0};
        const int events = poll(&ready, 1, 1000);
        if (watch.is_over && watch.is_over()) {
            why = {Ending::Kind::Interrupted, "", true};
            return false;
        }
        if (watch.beat) watch.beat();
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
        if (watch.timeout > 0.0 && seconds > watch.timeout) {
            why = {Ending::Kind::Failed, "took longer than --timeout", true};
            return false;
        }
        if (events <= 0) continue;
        std::array<char, 4096> block{};
        const ssize_t count = read(in, block.data(), block.size());
        if (count == 0) return true;
        if (count > 0) said.append(block.data(), static_cast<std::size_t>(count));
    }
}

}  // namespace

Ending runIsolated(const std::function<void()>& work, const Watch& watch) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
    std::fflush(nullptr);  // or the copy prints it once more
    const pid_t parent = getpid();
    const pid_t process = fork();
    if (process == 0) {
        close(ends[0]);
        workAndExit(work, ends[1], parent);
    }
    close(ends[1]);
    if (process < 0) {
        close(ends[0]);
        throw std::runtime_error(std::string("cannot start a process: ") + std::strerror(errno));
    }
    std::string said;
    Ending why;
    const bool has_ended = listen(ends[0], watch, said, why);
    close(ends[0]);
    if (!has_ended) kill(process, SIGKILL);
    int status = 0;
    while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    return has_ended ? endingOf(status, said) : why;
}

}  // namespace lidar_obstacles::fleet
