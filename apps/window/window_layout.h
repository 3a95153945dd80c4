// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Where the parts of a window are.
#pragma once

#include "projection.h"

namespace lidar_obstacles::apps {

/// What a window has to find a place for.
struct WindowParts {
    int width = 0, height = 0;  ///< of the window [pixels]
    bool side = false;          ///< panels beside the scene
    bool timeline = false;
    float image = 0.F;  ///< of a camera: its width by its height; 0: none
    float scale = 1.F;  ///< of texts, and of the panels as far as the scene keeps its share
};

/// Where the parts of a window are.
struct WindowLayout {
    ScreenRect scene;
    ScreenRect side;      ///< panels; no width: none is open
    ScreenRect timeline;  ///< no height: there is none
    ScreenRect image;     ///< no height: there is none
};
/// The scene has at least two thirds of the window. The image is at the top of the side panels, or below the scene
/// where there are none and it is half as wide again as it is high.
WindowLayout layoutOf(const WindowParts& parts);

}  // namespace lidar_obstacles::apps
