// SPDX-License-Identifier: BSD-3-Clause
#include "line_output.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace lidar_obstacles::apps {
bool writeToStdout(const std::string& line, const std::atomic<bool>& stop) {
    for (std::size_t done = 0; done < line.size();) {
        pollfd ready{STDOUT_FILENO, POLLOUT, 0};
        if (poll(&ready, 1, 100) <= 0) {  // a signal, or nobody reads
            if (stop) return false;
            continue;
        }
        // A pipe that can take anything takes PIPE_BUF bytes without waiting.
        const ssize_t n = ::write(STDOUT_FILENO, line.data() + done, std::min<std::size_t>(line.size() - done, 4096));
        if (n < 0 && errno == EINTR) continue;
        if (n < 0)
            throw std::runtime_error(std::string("cannot write to the standard output: ") + std::strerror(errno));
        done += static_cast<std::size_t>(n);
    }
    return true;
}

}  // namespace lidar_obstacles::apps
