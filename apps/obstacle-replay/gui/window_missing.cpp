// SPDX-License-Identifier: BSD-3-Clause
#include "window.h"

namespace lidar_obstacles::apps {

void showWindow(const Options&, const DetectorParams&) {
    throw UsageError(
        "--gui: this obstacle-replay was built without Dear ImGui and GLFW (libimgui-dev, libglfw3-dev); "
        "--record DIR or --record FILE.mp4 needs none");
}

}  // namespace lidar_obstacles::apps
