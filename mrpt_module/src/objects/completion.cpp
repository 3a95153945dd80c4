// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/completion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lidar_obstacles/object_models.h"
#include "objects/box.h"
#include "objects/free_way.h"
#include "objects/rectangle.h"

namespace lidar_obstacles {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kFilled = 0.3;   ///< a body fills its box for so much above its belly [m]
constexpr double kClearly = 0.7;  ///< a better explanation is so much better [m]
constexpr double kTooWide = 3.0;  ///< what is too wide counts so much more than what is missing

/// What sizes and beams say of which axis of a box is the vehicle's length.
enum class LengthAxis {
    Known,   ///< the other one cannot be
    Likely,  ///< it looks like a rear, though it may be a part of a side
    Open
};

/// Its length becomes its width.
void turn(Obstacle& o) {
    turnQuarters(o, 1);
    if (std::abs(o.box.yaw) > M_PI_2) turnQuarters(o, 2);  // told in the direction of travel
}

class Completer {
  public:
    Completer(const PointCloud& cloud, const GroundModel& ground, const CompletionParams& params)
        : cloud_(cloud), ground_(ground), params_(params.box), free_way_(cloud, ground, params.region.max_height) {}

    /// Turns a box whose length can only be along its other axis.
    LengthAxis orient(Obstacle& o) {
        const Ownership own(free_way_, o);
        lookAt(o);
        const double along = missingOf(o, 0);
        const double across = missingOf(o, 1);
        if (along > across + kClearly) turn(o);
        if (std::abs(along - across) > kClearly) return LengthAxis::Known;
        const Eigen::Vector3d& size = o.box.size;
        const bool rear = size.y() > size.x() && size.y() > params_.min_rear_width && size.y() < widest();
        return rear ? LengthAxis::Likely : LengthAxis::Open;
    }

    void grow(Obstacle& o) {
        const Ownership own(free_way_, o);
        lookAt(o);
        o.seen_box = o.box;
        growAxis(o, 0, tall_ ? params_.tall_length : params_.car_length);
        growAxis(o, 1, tall_ ? params_.tall_width : params_.car_width);
        o.box.center.z() = ground_.heightAt(o.box.center.x(), o.box.center.y()) + 0.5 * o.box.size.z();
    }

  private:
    /// Marks an obstacle's own returns for as long as it lives.
    struct Ownership {
        Ownership(FreeWay& way, const Obstacle& o) : free_way(way), points(o.points) { free_way.own(points, 1); }
        ~Ownership() { free_way.own(points, 0); }
        Ownership(const Ownership&) = delete;
        Ownership& operator=(const Ownership&) = delete;
        FreeWay& free_way;
        const std::vector<std::int32_t>& points;
    };

    void lookAt(const Obstacle& o) {
        viewpoint_ = viewpointOf(o.points, cloud_).cast<double>();
        body_.floor = ground_.heightAt(o.box.center.x(), o.box.center.y());
        tall_ = isTall(o);
        roof_ = isRoof(o);
    }

    double widest() const { return tall_ ? params_.max_rear_width : params_.max_car_width; }

    bool isTall(const Obstacle& o) const {
        constexpr double kWide = 1.9;  // a car is narrower, so that its roof may be higher than what was hit [m]
        return o.box.size.z() > params_.tall || (o.max_height > params_.tall && o.box.size.y() > kWide);
    }

    /// Above the ground, of the face at one end of an axis: its lowest return [m]. The bed of a truck is higher than
    /// the belly of a car.
    double lowestOf(const Obstacle& o, int k, double sense) const {
        constexpr double kFace = 0.4;  // so deep is what lies on it [m]
        const Vec2 outwards = sense * axisOf(o.box, k);
        const double face = outwards.dot(o.box.center.head<2>()) + 0.5 * o.box.size[k] - kFace;
        float lowest = std::numeric_limits<float>::infinity();
        for (const std::int32_t i : o.points)
            if (outwards.dot(cloud_.xyz[i].head<2>().cast<double>()) > face)
                lowest = std::min(lowest, ground_.height[i]);
        return std::isfinite(lowest) ? lowest : 0.0;
    }

    /// Only its roof was hit, over the edge of the field of view: its sides may be nearer, below the lowest ring.
    bool isRoof(const Obstacle& o) const {
        constexpr float kFlat = 0.4f;  // so high is the arch of a roof [m]
        if (cloud_.ring.empty()) return false;
        float low = std::numeric_limits<float>::infinity();
        float high = -low;
        bool at_edge = false;
        for (const std::int32_t i : o.points) {
            if (ground_.height[i] <= kVehicleWindows) return false;
            low = std::min(low, ground_.height[i]);
            high = std::max(high, ground_.height[i]);
            at_edge = at_edge || cloud_.ring[i] == cloud_.firstRing(cloud_.ring[i]);
        }
        return at_edge && high < low + kFlat;
    }

    /// How far the sensor lies along an axis from the box's centre [m], positive in the sense of the axis.
    double sensorAlong(const OrientedBox& box, int k) const {
        return axisOf(box, k).dot(viewpoint_ - box.center.head<2>());
    }

    /// What the face of a box at one end of an axis (0: length, 1: width; sense +1 or -1) sweeps as it moves outwards.
    static Strip stripOf(const Obstacle& o, int k, double sense, double wanted) {
        constexpr double kMargin = 0.2;
        const Vec2 outwards = sense * axisOf(o.box, k);
        const Vec2 face = o.box.center.head<2>() + 0.5 * o.box.size[k] * outwards;
        return {face, outwards, wanted, std::max(0.1, 0.5 * o.box.size[1 - k] - kMargin)};
    }

    /// How far that face may move outwards.
    double room(const Obstacle& o, int k, double sense, double wanted) const {
        return free_way_(stripOf(o, k, sense, wanted), body_);
    }

    /// Is that face no end of the body: what lies beside it hides where the body may go on?
    bool isHidden(const Obstacle& o, int k, double sense) const {
        constexpr double kBeside = 0.6;  // [m]
        return free_way_.hiddenShare(stripOf(o, k, sense, kBeside), o.points) > 0.5;
    }

    /// How far the faces at both ends of an axis may move outwards [m]: those turned away from the sensor, and those
    /// beside which something hides the rest; not what is seen to end there. Of a roof at the edge of view, both.
    struct Room {
        double ahead = 0.0;   ///< sense +1
        double behind = 0.0;  ///< sense -1
    };
    Room roomOf(const Obstacle& o, int k, double wanted) const {
        const double along = sensorAlong(o.box, k);
        const bool beyond = std::abs(along) > 0.5 * o.box.size[k];  // the sensor sees one of the two faces
        const auto toward = [&](double sense) {
            const bool turned_away = beyond && (along > 0.0) != (sense > 0.0);
            return roof_ || turned_away || isHidden(o, k, sense) ? room(o, k, sense, wanted) : 0.0;
        };
        return {toward(1.0), toward(-1.0)};
    }

    /// How much smaller than a vehicle it would be, and how much wider, if its length were along an axis: what beams
    /// do not let it be [m]. A rear in a row of parked cars shows no side; a side goes on where one can look.
    double missingOf(const Obstacle& o, int length_axis) {
        const int width_axis = 1 - length_axis;
        return shortOf(o, length_axis, params_.min_vehicle_length) + shortOf(o, width_axis, params_.min_rear_width) +
               kTooWide * std::max(0.0, o.box.size[width_axis] - widest());
    }

    double shortOf(const Obstacle& o, int k, double least) {
        const double missing = least - o.box.size[k];
        if (missing <= 0.0) return 0.0;
        aimAt(o, k);
        const double along = sensorAlong(o.box, k);
        if (!roof_ && std::abs(along) > 0.5 * o.box.size[k])
            return missing - room(o, k, along > 0.0 ? -1.0 : 1.0, missing);
        return std::max(0.0, missing - room(o, k, 1.0, missing) - room(o, k, -1.0, missing));
    }

    /// Gets ready for looking along an axis.
    void aimAt(const Obstacle& o, int k) {
        body_.belly =
            tall_ ? std::max(kVehicleBelly, lowestOf(o, k, sensorAlong(o.box, k) > 0.0 ? 1.0 : -1.0)) : kVehicleBelly;
        body_.windows = std::max(kVehicleWindows, body_.belly + kFilled);
        body_.top = o.box.size.z();
    }

    /// By half of what is wanted to either side, or more to one where the other has less room.
    void growAxis(Obstacle& o, int k, double usual) {
        const double wanted = usual - o.box.size[k];
        if (wanted <= 0.0) return;
        aimAt(o, k);
        const Room both = roomOf(o, k, wanted);
        const double first = std::min(both.ahead, std::max(0.5 * wanted, wanted - both.behind));
        const double second = std::min(both.behind, wanted - first);
        o.box.center.head<2>() += 0.5 * (first - second) * axisOf(o.box, k);
        o.box.size[k] += first + second;
    }

    const PointCloud& cloud_;
    const GroundModel& ground_;
    const BoxParams& params_;
    FreeWay free_way_;
    Body body_;                      ///< of the obstacle at hand
    Vec2 viewpoint_ = Vec2::Zero();  ///< that sees it
    bool tall_ = false;              ///< no car
    bool roof_ = false;              ///< only its roof was hit
};

/// Is it a vehicle, or if it is a road user at all, then one?
bool mayBeVehicle(const Obstacle& o) {
    if (o.cls != ObstacleClass::Unknown) return o.cls == ObstacleClass::Vehicle;
    constexpr float kLeast = 0.1f;
    const auto of = [&](ObstacleClass c) { return o.probability[static_cast<std::size_t>(c)]; };
    const float vehicle = of(ObstacleClass::Vehicle);
    return vehicle > kLeast && vehicle > of(ObstacleClass::Pedestrian) && vehicle > of(ObstacleClass::Cyclist);
}

/// Cars park side by side or one behind the other: turns a box to stand as the nearest vehicle does of those that stand
/// along one of its axes.
void standLike(const std::vector<const Obstacle*>& known, Obstacle& o) {
    constexpr double kRow = 12.0;      // so far away is the next but one of a row, with a gap between them [m]
    constexpr double kParallel = 0.3;  // [rad]
    double least = kRow * kRow;
    const Obstacle* nearest = nullptr;
    for (const Obstacle* k : known) {
        if (std::abs(std::sin(2.0 * (k->box.yaw - o.box.yaw))) > std::sin(2.0 * kParallel)) continue;
        const double distance = (k->box.center - o.box.center).head<2>().squaredNorm();
        if (distance >= least) continue;
        least = distance;
        nearest = k;
    }
    if (nearest != nullptr && std::abs(std::sin(nearest->box.yaw - o.box.yaw)) > std::sin(M_PI_4)) turn(o);
}

}  // namespace

std::vector<Obstacle> completeBoxes(std::vector<Obstacle> obstacles, const PointCloud& cloud, const GroundModel& ground,
                                    const CompletionParams& params) {
    for (Obstacle& o : obstacles) o.seen_box = o.box;
    if (params.box.completion == Completion::None) return obstacles;
    Completer completer(cloud, ground, params);
    std::vector<Obstacle*> vehicles, open;
    std::vector<const Obstacle*> known;
    for (Obstacle& o : obstacles) {
        if (!mayBeVehicle(o) || !o.heading_valid) continue;
        vehicles.push_back(&o);
        const LengthAxis axis = completer.orient(o);
        if (axis == LengthAxis::Known && o.cls == ObstacleClass::Vehicle) known.push_back(&o);
        if (axis == LengthAxis::Open) open.push_back(&o);
    }
    for (Obstacle* o : open) standLike(known, *o);
    for (Obstacle* o : vehicles) completer.grow(*o);
    raiseVehicles(obstacles);
    return obstacles;
}

OrientedBox withHeight(OrientedBox box, double height) {
    box.center.z() += 0.5 * (height - box.size.z());
    box.size.z() = height;
    return box;
}

void raiseVehicles(std::vector<Obstacle>& obstacles) {
    for (Obstacle& o : obstacles) {
        if (o.cls != ObstacleClass::Vehicle || o.box.size.z() >= kLeastVehicleHeight) continue;
        o.box = withHeight(o.box, kLeastVehicleHeight);
        o.max_height = std::max(o.max_height, kLeastVehicleHeight);
    }
}

}  // namespace lidar_obstacles
