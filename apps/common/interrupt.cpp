// SPDX-License-Identifier: BSD-3-Clause
#include "common/interrupt.h"

#include <csignal>
#include <cstdio>

namespace lidar_obstacles::apps {
namespace {

std::atomic<bool> signalled{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set in a signal handler");

void onSignal(int) { signalled = true; }

}  // namespace

void catchInterrupts() {
    struct sigaction action{};
    action.sa_handler = onSignal;
    // a write that is under way goes on; the signal that comes next has its usual effect
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    for (const int signal : {SIGINT, SIGTERM}) sigaction(signal, &action, nullptr);
}

const std::atomic<bool>& interruption() { return signalled; }

int exitCode(const char* tool, const std::optional<std::size_t>& interrupted_at) {
    if (!interrupted_at) return 0;
    std::fprintf(stderr, "%s: interrupted at scan %zu\n", tool, *interrupted_at);
    return kInterruptedCode;
}

}  // namespace lidar_obstacles::apps
