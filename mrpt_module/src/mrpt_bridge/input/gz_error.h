// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zlib.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace lidar_obstacles {

/// Why a compressed stream is broken; empty if it is not.
inline std::string gzErrorOf(gzFile file) {
    int code = Z_OK;
    const char* text = gzerror(file, &code);
    if (code == Z_BUF_ERROR) return "the compressed file is cut off";
    if (code == Z_OK || code == Z_STREAM_END) return "";
    return code == Z_ERRNO ? std::strerror(errno) : std::string("the compressed file is damaged: ") + text;
}

}  // namespace lidar_obstacles
