// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The mouse on the outlines of a recording's window.
#pragma once

#include <optional>

#include "controls.h"
#include "outline_editor.h"
#include "player.h"
#include "viewer.h"

namespace lidar_obstacles::apps {

/// Gives the player what the mouse makes of own body, region and zones, as soon as the button is let go.
class OutlineMouse {
  public:
    /// @param player, controls  must outlive this.
    OutlineMouse(Player& player, Controls& controls) : player_(player), controls_(controls) {}

    /// Is there something to grab at a pixel, and is anything edited at all?
    bool wants(const Viewer& viewer, const Eigen::Vector2f& at) const;
    /// Does what the mouse did since the last call. @return true if it did anything.
    bool move(Viewer& viewer);
    /// Takes away the corner that was touched last, or says why not.
    void deleteCorner();

    const OutlineEditor& editor() const { return editor_; }

  private:
    void take(const std::optional<EditedOutline>& outline);
    void refresh();

    Player& player_;
    Controls& controls_;
    OutlineEditor editor_;
};

}  // namespace lidar_obstacles::apps
