// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The look of the panels, and the colours of what is drawn beside Dear ImGui's own widgets.
#pragma once

#include <imgui.h>

#include "look.h"

namespace lidar_obstacles::apps {

/// Sets colours, sizes and letters. Between frames.
void applyLook(const Look& look);

/// Sizes in pixels are told for a scale of 1 and take this factor.
float textScale();
bool isLight();
/// Of texts and of what must be seen best.
ImU32 ink();
/// Under texts that lie over the scene. @param alpha  0 .. 255.
ImU32 paper(int alpha);
/// A colour that was chosen for a dark ground; on a light one it is as dark as it takes to be seen.
ImU32 shade(ImU32 color);

}  // namespace lidar_obstacles::apps
