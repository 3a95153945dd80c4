// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Puts texts on the screen where none covers another.
#pragma once

#include <string>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/scene_layers.h"
#include "projection.h"

namespace lidar_obstacles::apps {

struct PlacedLabel {
    std::string text;
    mrpt::img::TColor color;
    ScreenRect at;
    Eigen::Vector2f anchor;  ///< what it belongs to [pixels]
};

/// Where labels may be.
struct LabelSpace {
    ScreenRect scene;
    std::vector<ScreenRect> taken;  ///< places in it that are not free
};

/// The texts that find a free place in the space: above what they belong to, else a few lines higher or lower. The
/// heavier ones and, of these, the nearer ones choose first; one that finds none is left out.
/// @param letter  width and height of a letter [pixels].
std::vector<PlacedLabel> placeLabels(std::vector<SceneText> texts, const Projection& projection,
                                     const LabelSpace& space, const Eigen::Vector2f& letter);

}  // namespace lidar_obstacles::apps
