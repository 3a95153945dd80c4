// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The own body, the region and zones as outlines whose corners are dragged. No window.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lidar_obstacles/params.h"
#include "lidar_obstacles/types.h"
#include "lidar_obstacles/zones.h"
#include "projection.h"

namespace lidar_obstacles::apps {

enum class OutlineKind : std::uint8_t { OwnBody, Region, Vehicle, Zone };

/// An outline that can be edited.
struct EditedOutline {
    OutlineKind kind = OutlineKind::Zone;
    std::size_t place = 0;  ///< of the part of the body, or of the zone
    std::string name;       ///< "own body", "region", "vehicle" or "zone NAME"
    Outline corners;        ///< vehicle frame [m]
    bool is_box = false;    ///< along the vehicle's axes: it stays one while corners are dragged
    std::optional<Eigen::Isometry3d> T_map_vehicle = std::nullopt;  ///< set where it belongs to a zone of the map
};

/// All that can be edited, where it is now. Zones of the map are among them where the vehicle's pose is known.
std::vector<EditedOutline> outlinesOf(const DetectorParams& params, const ZoneSet& zones,
                                      const std::optional<Eigen::Isometry3d>& T_map_vehicle);

/// What the outlines belong to.
struct OutlineSetup {
    DetectorParams params;
    ZoneSet zones;
};
/// The setup with the outline in it; corners of the map are rounded to centimetres there, but those that were not
/// moved.
/// @throws std::invalid_argument if its sides cross, or it has no area.
OutlineSetup withOutline(const EditedOutline& outline, OutlineSetup setup);

/// Places on the ground and their pixels.
class GroundView {
  public:
    /// @param ground  must outlive this.
    GroundView(const Projection& projection, const GroundModel& ground) : projection_(projection), ground_(ground) {}

    std::optional<Eigen::Vector2f> pixelOf(const Eigen::Vector2d& place) const;
    /// None above the horizon, or farther than 500 m.
    std::optional<Eigen::Vector2d> placeAt(const Eigen::Vector2f& pixel) const;

  private:
    const Projection& projection_;
    const GroundModel& ground_;
};

/// One hand on the outlines. Places are rounded to centimetres.
class OutlineEditor {
  public:
    /// Takes over what is now, unless a corner is being dragged. The chosen corner stays chosen as long as its outline
    /// is there with as many corners.
    void take(const DetectorParams& params, const ZoneSet& zones,
              const std::optional<Eigen::Isometry3d>& T_map_vehicle);
    const std::vector<EditedOutline>& outlines() const { return outlines_; }

    /// Is there something to grab: a corner within 10 pixels, or a side within 5?
    bool wants(const Eigen::Vector2f& pixel, const GroundView& view) const;
    /// Grabs it. A side gets a corner where it is grabbed, but for the region's: that has four.
    void grab(const Eigen::Vector2f& pixel, const GroundView& view);
    void dragTo(const Eigen::Vector2f& pixel, const GroundView& view);
    /// Lets go. @return the outline that was dragged; nothing if none was.
    std::optional<EditedOutline> release();

    /// The outline without the corner that was grabbed last; nothing if none was.
    /// @throws std::invalid_argument if it is the region's, or of three.
    std::optional<EditedOutline> withoutCorner();

    /// A corner: places of its outline and in it.
    struct Corner {
        std::size_t outline = 0, corner = 0;
    };
    /// The one that was grabbed last.
    const std::optional<Corner>& chosen() const { return chosen_; }

  private:
    std::optional<Corner> cornerAt(const Eigen::Vector2f& pixel, const GroundView& view) const;
    /// The corner that a side begins with.
    std::optional<Corner> sideAt(const Eigen::Vector2f& pixel, const GroundView& view) const;

    std::vector<EditedOutline> outlines_;
    std::optional<Corner> chosen_;
    bool dragging_ = false;
};

}  // namespace lidar_obstacles::apps
