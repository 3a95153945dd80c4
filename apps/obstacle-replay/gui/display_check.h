// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace lidar_obstacles::apps {

/// True if the X display that $DISPLAY names answers. MRPT's windows wait 5 s to find out.
bool displayAnswers();

}  // namespace lidar_obstacles::apps
