// SPDX-License-Identifier: BSD-3-Clause
#include "outline_editor.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "lidar_obstacles/mrpt_bridge/zone_scene.h"
#include "lidar_obstacles/own_body.h"

namespace lidar_obstacles::apps {
namespace {

constexpr float kCorner = 10.F;      ///< [pixels]
constexpr float kSide = 5.F;         ///< [pixels]
constexpr double kFarthest = 500.0;  ///< [m]

double toCentimetres(double metres) { return std::round(100.0 * metres) / 100.0; }

double within(double low, double value, double high) { return std::clamp(value, low, high); }

Outline boxOf(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
    return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

/// How far a pixel is from the line between two others.
float distanceToLine(const Eigen::Vector2f& p, const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
    const Eigen::Vector2f way = b - a;
    const float share = std::clamp((p - a).dot(way) / std::max(1e-6F, way.squaredNorm()), 0.F, 1.F);
    return (a + share * way - p).norm();
}

/// A box along the axes with one corner somewhere else, the opposite one stays. Corners as boxOf() has them.
void moveBoxCorner(Outline& box, std::size_t corner, const Eigen::Vector2d& to) {
    Eigen::Vector2d& next = box[(corner + 1) % 4];
    Eigen::Vector2d& before = box[(corner + 3) % 4];
    const bool even = corner % 2 == 0;
    (even ? next : before).y() = to.y();
    (even ? before : next).x() = to.x();
    box[corner] = to;
}

/// The region reaches as far to the left as to the right, and its sides are within what the parameters may be.
void moveRegionCorner(Outline& region, std::size_t corner, const Eigen::Vector2d& to) {
    constexpr double kLeast = 1.0, kMost = 300.0;
    const bool front = region[corner].x() > 0.0;
    const double lateral = within(kLeast, std::abs(to.y()), kMost);
    const double rear = front ? region[0].x() : -within(kLeast, -to.x(), kMost);
    const double ahead = front ? within(kLeast, to.x(), kMost) : region[2].x();
    region = boxOf({rear, -lateral}, {ahead, lateral});
}

void require(const Outline& corners, const std::string& name) {
    const std::string fault = faultOf(corners);
    if (!fault.empty()) throw std::invalid_argument(name + ": " + fault);
}

/// Is it the one from before, with the same corners, wherever they are now?
bool isSame(const EditedOutline& now, const EditedOutline& before) {
    return now.kind == before.kind && now.place == before.place && now.name == before.name &&
           now.corners.size() == before.corners.size();
}

OwnPart partOf(const EditedOutline& outline, OwnPart part) {
    if (part.is_box && !outline.is_box && (std::isfinite(part.z_min) || std::isfinite(part.z_max)))
        throw std::invalid_argument("a part of the own body with heights stays a box: polygons have none");
    part.outline = outline.corners;
    part.is_box = outline.is_box;
    if (!part.is_box) return part;
    Eigen::Vector2d low = outline.corners[0], high = low;
    for (const Eigen::Vector2d& p : outline.corners) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    part.outline = boxOf(low, high);
    return part;
}

/// The other way than seenFromVehicle(). @param before  on the map: which of them were not moved.
Outline toMap(const Outline& corners, const Eigen::Isometry3d& T_map_vehicle, const Outline& before) {
    constexpr double kSame = 1e-6;  // [m]
    const Eigen::Matrix2d turned = T_map_vehicle.linear().transpose().topLeftCorner<2, 2>().inverse();
    Outline map;
    map.reserve(corners.size());
    for (const Eigen::Vector2d& corner : corners) {
        const Eigen::Vector2d p = turned * corner + T_map_vehicle.translation().head<2>();
        const auto same = std::find_if(before.begin(), before.end(),
                                       [&](const Eigen::Vector2d& b) { return (b - p).norm() < kSame; });
        map.push_back(same != before.end() ? *same : Eigen::Vector2d(toCentimetres(p.x()), toCentimetres(p.y())));
    }
    return map;
}

}  // namespace

std::vector<EditedOutline> outlinesOf(const DetectorParams& params, const ZoneSet& zones,
                                      const std::optional<Eigen::Isometry3d>& T_map_vehicle) {
    std::vector<EditedOutline> all;
    const OwnBody body(params.region.own_body);
    all.reserve(body.parts().size() + zones.zones.size() + 2);
    for (std::size_t k = 0; k < body.parts().size(); ++k)
        all.push_back({OutlineKind::OwnBody, k, "own body", body.parts()[k].outline, body.parts()[k].is_box});
    const RegionParams& r = params.region;
    all.push_back({OutlineKind::Region, 0, "region", boxOf({-r.rear, -r.lateral}, {r.front, r.lateral}), true});
    if (!zones.vehicle.empty()) all.push_back({OutlineKind::Vehicle, 0, "vehicle", zones.vehicle, false});
    for (std::size_t k = 0; k < zones.zones.size(); ++k) {
        const Zone& zone = zones.zones[k];
        const std::string name = "zone " + zone.name;
        if (zone.frame == ZoneFrame::Vehicle)
            all.push_back({OutlineKind::Zone, k, name, zone.polygon, false});
        else if (T_map_vehicle)
            all.push_back(
                {OutlineKind::Zone, k, name, seenFromVehicle(zone.polygon, *T_map_vehicle), false, T_map_vehicle});
    }
    return all;
}

OutlineSetup withOutline(const EditedOutline& outline, OutlineSetup setup) {
    require(outline.corners, outline.name);
    switch (outline.kind) {
        case OutlineKind::OwnBody: {
            std::vector<OwnPart> parts = OwnBody(setup.params.region.own_body).parts();
            parts.at(outline.place) = partOf(outline, parts.at(outline.place));
            setup.params.region.own_body = toText(OwnBody(std::move(parts)));
            break;
        }
        case OutlineKind::Region:
            setup.params.region.rear = -outline.corners[0].x();
            setup.params.region.front = outline.corners[2].x();
            setup.params.region.lateral = outline.corners[2].y();
            break;
        case OutlineKind::Vehicle:
            setup.zones.vehicle = outline.corners;
            break;
        case OutlineKind::Zone: {
            Outline& polygon = setup.zones.zones.at(outline.place).polygon;
            polygon = outline.T_map_vehicle ? toMap(outline.corners, *outline.T_map_vehicle, polygon) : outline.corners;
            break;
        }
    }
    return setup;
}

std::optional<Eigen::Vector2f> GroundView::pixelOf(const Eigen::Vector2d& p) const {
    return projection_.pixelOf({p.x(), p.y(), ground_.heightAt(p.x(), p.y())});
}

std::optional<Eigen::Vector2d> GroundView::placeAt(const Eigen::Vector2f& pixel) const {
    const Eigen::Vector3d ray = projection_.rayThrough(pixel.x(), pixel.y());
    const Eigen::Vector3d& eye = projection_.eye();
    if (ray.z() > -1e-6) return std::nullopt;
    double height = ground_.heightAt(0.0, 0.0);
    Eigen::Vector3d place = eye;
    for (int k = 0; k < 10; ++k) {  // the ground is nearly flat: it settles at once
        place = eye + ray * ((height - eye.z()) / ray.z());
        if (!(place.head<2>().norm() < kFarthest)) return std::nullopt;
        height = ground_.heightAt(place.x(), place.y());
    }
    return place.head<2>();
}

void OutlineEditor::take(const DetectorParams& params, const ZoneSet& zones,
                         const std::optional<Eigen::Isometry3d>& T_map_vehicle) {
    if (dragging_) return;
    const std::vector<EditedOutline> before = std::exchange(outlines_, outlinesOf(params, zones, T_map_vehicle));
    if (!chosen_) return;
    const EditedOutline& touched = before[chosen_->outline];
    const auto same =
        std::find_if(outlines_.begin(), outlines_.end(), [&](const EditedOutline& o) { return isSame(o, touched); });
    if (same == outlines_.end()) return chosen_.reset();
    chosen_->outline = static_cast<std::size_t>(same - outlines_.begin());
}

std::optional<OutlineEditor::Corner> OutlineEditor::cornerAt(const Eigen::Vector2f& pixel,
                                                             const GroundView& view) const {
    std::optional<Corner> nearest;
    float least = kCorner;
    for (std::size_t o = 0; o < outlines_.size(); ++o)
        for (std::size_t k = 0; k < outlines_[o].corners.size(); ++k) {
            const auto at = view.pixelOf(outlines_[o].corners[k]);
            const float away = at ? (*at - pixel).norm() : least;
            if (away >= least) continue;
            least = away;
            nearest = Corner{o, k};
        }
    return nearest;
}

std::optional<OutlineEditor::Corner> OutlineEditor::sideAt(const Eigen::Vector2f& pixel, const GroundView& view) const {
    std::optional<Corner> nearest;
    float least = kSide;
    for (std::size_t o = 0; o < outlines_.size(); ++o) {
        const Outline& corners = outlines_[o].corners;
        for (std::size_t k = 0; k < corners.size() && outlines_[o].kind != OutlineKind::Region; ++k) {
            const auto a = view.pixelOf(corners[k]), b = view.pixelOf(corners[(k + 1) % corners.size()]);
            const float away = a && b ? distanceToLine(pixel, *a, *b) : least;
            if (away >= least) continue;
            least = away;
            nearest = Corner{o, k};
        }
    }
    return nearest;
}

bool OutlineEditor::wants(const Eigen::Vector2f& pixel, const GroundView& view) const {
    return cornerAt(pixel, view) || sideAt(pixel, view);
}

void OutlineEditor::grab(const Eigen::Vector2f& pixel, const GroundView& view) {
    chosen_ = cornerAt(pixel, view);
    const auto side = chosen_ ? std::nullopt : sideAt(pixel, view);
    const auto place = side ? view.placeAt(pixel) : std::nullopt;
    if (side && place) {
        EditedOutline& outline = outlines_[side->outline];
        outline.corners.insert(outline.corners.begin() + static_cast<std::ptrdiff_t>(side->corner + 1),
                               {toCentimetres(place->x()), toCentimetres(place->y())});
        outline.is_box = false;
        chosen_ = Corner{side->outline, side->corner + 1};
    }
    dragging_ = chosen_.has_value();
}

void OutlineEditor::dragTo(const Eigen::Vector2f& pixel, const GroundView& view) {
    const auto place = view.placeAt(pixel);
    if (!dragging_ || !place) return;
    const Eigen::Vector2d to(toCentimetres(place->x()), toCentimetres(place->y()));
    EditedOutline& outline = outlines_[chosen_->outline];
    if (outline.kind == OutlineKind::Region) return moveRegionCorner(outline.corners, chosen_->corner, to);
    if (outline.is_box) return moveBoxCorner(outline.corners, chosen_->corner, to);
    outline.corners[chosen_->corner] = to;
}

std::optional<EditedOutline> OutlineEditor::release() {
    if (!std::exchange(dragging_, false)) return std::nullopt;
    return outlines_[chosen_->outline];
}

std::optional<EditedOutline> OutlineEditor::withoutCorner() {
    if (!chosen_ || dragging_) return std::nullopt;
    EditedOutline outline = outlines_[chosen_->outline];
    if (outline.kind == OutlineKind::Region) throw std::invalid_argument("the region has four corners");
    if (outline.corners.size() <= 3) throw std::invalid_argument(outline.name + " has three corners, the fewest");
    outline.corners.erase(outline.corners.begin() + static_cast<std::ptrdiff_t>(chosen_->corner));
    outline.is_box = false;
    chosen_.reset();
    return outline;
}

}  // namespace lidar_obstacles::apps
