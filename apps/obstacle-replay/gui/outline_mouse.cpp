// SPDX-License-Identifier: BSD-3-Clause
#include "outline_mouse.h"

#include <stdexcept>

#include "common/message_of.h"

namespace lidar_obstacles::apps {

bool OutlineMouse::wants(const Viewer& viewer, const Eigen::Vector2f& at) const {
    const Projection projection = viewer.projection();
    return controls_.view().outlines && editor_.wants(at, viewer.ground(projection));
}

bool OutlineMouse::move(Viewer& viewer) {
    bool any = false;
    const Projection projection = viewer.projection();
    while (const auto drag = viewer.screen().nextDrag()) {
        const GroundView view = viewer.ground(projection);
        if (drag->phase == Drag::Phase::Begin) editor_.grab(drag->at, view);
        if (drag->phase == Drag::Phase::Move) editor_.dragTo(drag->at, view);
        if (drag->phase == Drag::Phase::End) take(editor_.release());
        any = true;
    }
    refresh();
    return any;
}

void OutlineMouse::deleteCorner() {
    if (!controls_.view().outlines) return controls_.say("F2 edits outlines; then delete takes a corner away");
    try {
        const auto outline = editor_.withoutCorner();
        if (!outline) return controls_.say("no corner was touched");
        take(outline);
    } catch (const std::invalid_argument& e) {
        controls_.say(messageOf(e));
    }
}

/// What is edited is what is drawn: zones of the map lie where the shown scan has them.
void OutlineMouse::refresh() {
    const auto shown = player_.shown();
    editor_.take(player_.setup().params, player_.setup().zones, shown ? shown->T_map_vehicle : std::nullopt);
}

/// The scan is shown with the outline; one that cannot be right is as it was before.
void OutlineMouse::take(const std::optional<EditedOutline>& outline) {
    if (!outline) return;
    try {
        const OutlineSetup setup = withOutline(*outline, {player_.setup().params, player_.setup().zones});
        player_.setOutlines(setup.params, setup.zones);
        const bool zones = outline->kind == OutlineKind::Zone || outline->kind == OutlineKind::Vehicle;
        controls_.say(outline->name + " changed; " + (zones ? "F3 writes the zones" : "w writes config.ini"));
    } catch (const std::exception& e) {  // sides that cross, a map that cannot be read
        controls_.say(messageOf(e));
    }
    refresh();
}

}  // namespace lidar_obstacles::apps
