// SPDX-License-Identifier: BSD-3-Clause
#include "common/nameless_file.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace lidar_obstacles::apps {

std::string temporaryFolder() {
    std::error_code error;
    const auto path = std::filesystem::temp_directory_path(error);
    return error ? "/tmp" : path.string();
}

int openNamelessFile() {
    const std::string folder = temporaryFolder();
    std::string name = folder + "/lidar_obstacles_XXXXXX";
    const int file = mkstemp(name.data());
    if (file < 0) throw std::runtime_error("temporary file in " + folder + ": cannot be made: " + std::strerror(errno));
    unlink(name.c_str());
    return file;
}

}  // namespace lidar_obstacles::apps
