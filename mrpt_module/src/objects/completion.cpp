// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/completion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "lidar_obstacles/object_models.h"
#include "objects/rectangle.h"
#include "scan/column_map.h"

namespace lidar_obstacles {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kFilled = 0.3;   ///< a body fills its box for so much above its belly [m]
constexpr double kClearly = 0.7;  ///< a better explanation is so much better [m]
constexpr double kTooWide = 3.0;  ///< what is too wide counts so much more than what is missing
constexpr double kQuarter = 1.57079632679489661923;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// The strip that a face of a box would sweep when it moves outwards.
struct Strip {
    Vec2 from;            ///< middle of the face where it is [m]
    Vec2 outwards;        ///< unit length
    double length = 0.0;  ///< how far it is to move [m]
    double half = 0.0;    ///< half the face's width, less a margin [m]

    Vec2 local(const Vec2& p) const {
        return {outwards.dot(p - from), outwards.x() * (p - from).y() - outwards.y() * (p - from).x()};
    }
};

/// How far along the strip a beam between two places (in the strip's own frame) enters it: infinite if it does not.
double entryOf(const Strip& strip, const Vec2& from, const Vec2& to) {
    const Vec2 d = to - from;
    double in = 0.0;
    double out = 1.0;
    const double low[2] = {0.0, -strip.half};
    const double high[2] = {strip.length, strip.half};
    for (int k = 0; k < 2; ++k) {
        if (std::abs(d[k]) < 1e-9) {
            if (from[k] < low[k] || from[k] > high[k]) return kNever;
            continue;
        }
        const double s = (low[k] - from[k]) / d[k];
        const double t = (high[k] - from[k]) / d[k];
        in = std::max(in, std::min(s, t));
        out = std::min(out, std::max(s, t));
    }
    if (in >= out) return kNever;
    return std::min(from.x() + in * d.x(), from.x() + out * d.x());
}

class Completer {
  public:
    Completer(const PointCloud& cloud, const GroundModel& ground, const BoxParams& params)
        : cloud_(cloud), ground_(ground), params_(params) {
        if (!cloud.view.empty() && !cloud.empty()) columns_.emplace(cloud);
        for (const SensorRays& sensor : cloud.allSensors()) sensors_.push_back(sensor);
        own_.assign(cloud.size(), 0);
    }

    void grow(Obstacle& o) {
        const Ownership own(*this, o);
        viewpoint_ = viewpointOf(o.points, cloud_).cast<double>();
        floor_ = ground_.heightAt(o.box.center.x(), o.box.center.y());
        tall_ = isTall(o);
        const double missing = missingOf(o, 0);
        if (missing > kClearly && missingOf(o, 1) + kClearly < missing) {  // mostly there is nothing to ask
            turn(o);
            tall_ = isTall(o);
        }
        o.seen_box = o.box;
        growAxis(o, 0, tall_ ? params_.tall_length : params_.car_length);
        growAxis(o, 1, tall_ ? params_.tall_width : params_.car_width);
        o.box.center.z() = ground_.heightAt(o.box.center.x(), o.box.center.y()) + 0.5 * o.box.size.z();
    }

  private:
    /// Marks an obstacle's own returns for as long as it lives.
    struct Ownership {
        Ownership(Completer& c, const Obstacle& o) : completer(c), points(o.points) { mark(1); }
        ~Ownership() { mark(0); }
        Ownership(const Ownership&) = delete;
        Ownership& operator=(const Ownership&) = delete;
        void mark(std::uint8_t value) {
            for (const std::int32_t i : points) completer.own_[i] = value;
        }
        Completer& completer;
        const std::vector<std::int32_t>& points;
    };

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

    static Vec2 axisOf(const OrientedBox& box, int k) {
        const Vec2 forward(std::cos(box.yaw), std::sin(box.yaw));
        return k == 0 ? forward : Vec2(-forward.y(), forward.x());
    }

    /// How far the sensor lies along an axis from the box's centre [m], positive in the sense of the axis.
    double sensorAlong(const OrientedBox& box, int k) const {
        return axisOf(box, k).dot(viewpoint_ - box.center.head<2>());
    }

    /// How far the face of a box at one end of an axis (0: length, 1: width; sense +1 or -1) may move outwards.
    double room(const Obstacle& o, int k, double sense, double wanted) const {
        constexpr double kMargin = 0.2;
        const Vec2 outwards = sense * axisOf(o.box, k);
        const Vec2 face = o.box.center.head<2>() + 0.5 * o.box.size[k] * outwards;
        return freeWay({face, outwards, wanted, std::max(0.1, 0.5 * o.box.size[1 - k] - kMargin)}, o);
    }

    /// The same for the face turned away from the sensor; 0 where both ends of the axis are seen.
    double roomAway(const Obstacle& o, int k, double wanted) const {
        const double along = sensorAlong(o.box, k);
        return std::abs(along) <= 0.5 * o.box.size[k] ? 0.0 : room(o, k, along > 0.0 ? -1.0 : 1.0, wanted);
    }

    /// How much smaller than a vehicle it would be, and how much wider, if its length were along an axis: what beams
    /// do not let it be [m]. A rear in a row of parked cars shows no side; a side goes on where one can look.
    double missingOf(const Obstacle& o, int length_axis) {
        const int width_axis = 1 - length_axis;
        const double widest = tall_ ? params_.max_rear_width : params_.max_car_width;
        return shortOf(o, length_axis, params_.min_vehicle_length) + shortOf(o, width_axis, params_.min_rear_width) +
               kTooWide * std::max(0.0, o.box.size[width_axis] - widest);
    }

    double shortOf(const Obstacle& o, int k, double least) {
        const double missing = least - o.box.size[k];
        if (missing <= 0.0) return 0.0;
        aimAt(o, k);
        if (std::abs(sensorAlong(o.box, k)) > 0.5 * o.box.size[k]) return missing - roomAway(o, k, missing);
        return std::max(0.0, missing - room(o, k, 1.0, missing) - room(o, k, -1.0, missing));
    }

    /// Its length becomes its width.
    static void turn(Obstacle& o) {
        std::swap(o.box.size.x(), o.box.size.y());
        o.box.yaw = normalizeAngle(o.box.yaw + kQuarter);
        const auto has = [faces = o.faces](Face f) { return (faces & f) != 0; };
        std::array<bool, 4> on{has(kLeft), has(kBack), has(kRight),
                               has(kFront)};   // counter-clockwise from the new front
        if (std::abs(o.box.yaw) > kQuarter) {  // told in the direction of travel
            o.box.yaw = normalizeAngle(o.box.yaw + 2.0 * kQuarter);
            std::rotate(on.begin(), on.begin() + 2, on.end());
        }
        o.faces = static_cast<std::uint8_t>((on[0] ? kFront : 0) | (on[1] ? kLeft : 0) | (on[2] ? kBack : 0) |
                                            (on[3] ? kRight : 0));
    }

    /// Gets ready for looking along an axis.
    void aimAt(const Obstacle& o, int k) {
        belly_ =
            tall_ ? std::max(kVehicleBelly, lowestOf(o, k, sensorAlong(o.box, k) > 0.0 ? 1.0 : -1.0)) : kVehicleBelly;
        windows_ = std::max(kVehicleWindows, belly_ + kFilled);
    }

    void growAxis(Obstacle& o, int k, double usual) {
        if (usual <= o.box.size[k]) return;
        aimAt(o, k);
        const double sense = sensorAlong(o.box, k) > 0.0 ? -1.0 : 1.0;
        const double way = roomAway(o, k, usual - o.box.size[k]);
        o.box.center.head<2>() += 0.5 * way * sense * axisOf(o.box, k);
        o.box.size[k] += way;
    }

    /// What was found on the way of a face.
    struct Way {
        Strip strip;
        double top = 0.0;            ///< how high the obstacle is [m]
        Vec2 sensor = Vec2::Zero();  ///< that is looked from, in the strip's frame
        float height = 0.0f;         ///< of it, in the cloud's frame [m]
        /// Where the nearest beams enter the strip that show that no vehicle stands there; the nearest first.
        std::array<double, 3> entries{kNever, kNever, kNever};
    };

    /// How far a face turned away from the sensor may move: up to the third nearest beam that crosses its way.
    double freeWay(const Strip& strip, const Obstacle& o) const {
        Way way{strip, o.box.size.z()};
        const Eigen::Vector2f outwards = strip.outwards.cast<float>();
        const auto begin = static_cast<float>(strip.outwards.dot(strip.from));
        const auto look = [&](std::int32_t i) {  // most beams end before the strip
            if (outwards.dot(cloud_.xyz[i].head<2>()) > begin && own_[i] == 0) enter(way, i);
        };
        const auto blocked = [&] { return way.entries.back() <= 0.0; };
        for (std::size_t s = 0; s < sensors_.size(); ++s) {
            way.sensor = strip.local(sensors_[s].origin.head<2>().cast<double>());
            way.height = sensors_[s].origin.z();
            if (columns_)
                lookAlongColumns(strip, s, look, blocked);
            else
                for (std::int32_t i = s > 0 ? sensors_[s - 1].end : 0; i < sensors_[s].end && !blocked(); ++i) look(i);
        }
        return std::min(way.entries.back(), strip.length);
    }

    /// Notes where the beam of a return enters the strip, if it does.
    void enter(Way& way, std::int32_t i) const {
        double entry = std::max(0.0, stopAt(way, i));
        for (double& nearer : way.entries)
            if (entry < nearer) std::swap(entry, nearer);
    }

    /// Looks at a sensor's returns of the columns that a strip covers until it is blocked.
    template <class Look, class Blocked>
    void lookAlongColumns(const Strip& strip, std::size_t s, const Look& look, const Blocked& blocked) const {
        const Vec2 sensor = sensors_[s].origin.head<2>().cast<double>();
        const Vec2 across(-strip.outwards.y(), strip.outwards.x());
        const Vec2 start = strip.from - sensor;
        const double middle = std::atan2(start.y(), start.x());
        double low = 0.0;
        double high = 0.0;
        for (const double side : {-strip.half, strip.half}) {
            for (const double way : {0.0, strip.length}) {
                const Vec2 p = start + side * across + way * strip.outwards;
                const double a = normalizeAngle(std::atan2(p.y(), p.x()) - middle);
                low = std::min(low, a);
                high = std::max(high, a);
            }
        }
        const OrganizedView& view = cloud_.view;
        const int columns = 1 + static_cast<int>((high - low) * view.columns / 6.283185307179586);
        const int first = columns_->columnOf(middle + low);
        for (int k = 0; k < columns && !blocked(); ++k) {
            const int column = view.wrap(first + columns_->sense() * k);
            for (int ring = sensors_[s].first_ring; ring < sensors_[s].end_ring; ++ring)
                if (const std::int32_t i = view.at(ring, column); i >= 0) look(i);
        }
    }

    /// Where along the strip the return or its beam shows that no vehicle stands; infinite if it does not.
    double stopAt(const Way& way, std::int32_t i) const {
        const double windows = std::min(windows_, way.top - 0.2);
        const Vec2 end = way.strip.local(cloud_.xyz[i].head<2>().cast<double>());
        const bool ends_there = end.x() < way.strip.length && std::abs(end.y()) < way.strip.half;
        if (ends_there && ground_.height[i] > belly_) return end.x();
        const double entry = entryOf(way.strip, way.sensor, end);
        if (!(entry < way.strip.length)) return entry;
        const double share = (way.sensor.x() - entry) / (way.sensor.x() - end.x());
        const double height = way.height + share * (cloud_.xyz[i].z() - way.height) - floor_;
        if (height <= belly_) return kNever;  // it went through below
        return ends_there ? end.x() : height < windows ? entry : kNever;
    }

    const PointCloud& cloud_;
    const GroundModel& ground_;
    const BoxParams& params_;
    std::optional<ColumnMap> columns_;
    std::vector<SensorRays> sensors_;
    Vec2 viewpoint_ = Vec2::Zero();  ///< that sees the obstacle at hand
    bool tall_ = false;              ///< no car
    double floor_ = 0.0;             ///< z of the ground it stands on [m]
    double belly_ = 0.0;             ///< height of its belly: beams go through below [m]
    double windows_ = 0.0;           ///< and above [m]
    std::vector<std::uint8_t> own_;  ///< returns of the obstacle at hand
};

/// Is it a vehicle, or if it is a road user at all, then one?
bool mayBeVehicle(const Obstacle& o) {
    if (o.cls != ObstacleClass::Unknown) return o.cls == ObstacleClass::Vehicle;
    constexpr float kLeast = 0.1f;
    const auto of = [&](ObstacleClass c) { return o.probability[static_cast<std::size_t>(c)]; };
    const float vehicle = of(ObstacleClass::Vehicle);
    return vehicle > kLeast && vehicle > of(ObstacleClass::Pedestrian) && vehicle > of(ObstacleClass::Cyclist);
}

}  // namespace

std::vector<Obstacle> completeBoxes(std::vector<Obstacle> obstacles, const PointCloud& cloud, const GroundModel& ground,
                                    const BoxParams& params) {
    Completer completer(cloud, ground, params);
    for (Obstacle& o : obstacles) {
        o.seen_box = o.box;
        if (mayBeVehicle(o) && o.heading_valid && params.completion == Completion::Prior) completer.grow(o);
    }
    return obstacles;
}

}  // namespace lidar_obstacles
