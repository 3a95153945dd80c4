// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What is told to people.
#pragma once

#include <mrpt/system/COutputLogger.h>

#include <cstdio>
#include <string>
#include <string_view>

namespace lidar_obstacles::apps {

/// MRPT's logger of a program that runs for long: each message is a line on the standard error. Tools that do one thing
/// and end print to the standard error without a logger.
class Log : public mrpt::system::COutputLogger {
  public:
    Log() : COutputLogger("obstacle-live") {
        logging_enable_console_output = false;  // that is the standard output, where the results go
        logRegisterCallback([](std::string_view text, auto, auto, auto) {
            std::fprintf(stderr, "obstacle-live: %s\n", std::string(text).c_str());
        });
    }

    void say(const std::string& text) const { logStr(mrpt::system::LVL_INFO, text); }
    void warn(const std::string& text) const { logStr(mrpt::system::LVL_WARN, text); }
};

}  // namespace lidar_obstacles::apps
