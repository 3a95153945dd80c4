// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What clients may ask for: one line of JSON each, read strictly.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "lidar_obstacles/motion.h"
#include "parts.h"

namespace lidar_obstacles::apps {

/// {"subscribe": ["tracks", "grid"]}: the lines that follow have these parts, and no others.
struct Subscribe {
    Parts parts;
};
/// {"detection": "start"} or "stop".
struct Detection {
    bool on = true;
};
/// {"set": ["grid.resolution=0.2"]}: all of them, or none.
struct SetParameters {
    std::vector<std::string> assignments;
};
/// {"pose": {"timestamp": s, "x": m, "y": m, "yaw": rad}}, see parsePoseLine().
struct GivePose {
    StampedPose pose;
};
using Request = std::variant<Subscribe, Detection, SetParameters, GivePose>;

/// @param line  without its end. @throws std::invalid_argument saying what is wrong with it and what was expected.
Request parseRequest(const std::string& line);

/// True for the first line of an HTTP request: a page in a browser of this machine that tries its luck.
bool isHttp(const std::string& line);

/// `{"ok":REQUEST}` and a line end.
std::string okLine(const std::string& request);
/// `{"error":"..","request":".."}` and a line end; a long request is cut. Bytes that are no UTF-8 are replaced.
std::string errorLine(const std::string& error, const std::string& request);

}  // namespace lidar_obstacles::apps
