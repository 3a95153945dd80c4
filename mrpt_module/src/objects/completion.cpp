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
        constexpr double kWide = 1.9;  // a car is narrower, so that its roof may be higher than what was hit [m]
        const bool tall = o.box.size.z() > params_.tall || (o.max_height > params_.tall && o.box.size.y() > kWide);
        growAxis(o, 0, tall ? params_.tall_length : params_.car_length);
        growAxis(o, 1, tall ? params_.tall_width : params_.car_width);
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

    void growAxis(Obstacle& o, int k, double usual) const {
        if (usual <= o.box.size[k]) return;
        const double way = roomAway(o, k, usual - o.box.size[k]);
        const double sense = sensorAlong(o.box, k) > 0.0 ? -1.0 : 1.0;
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
        const double windows = std::min(kVehicleWindows, way.top - 0.2);
        const Vec2 end = way.strip.local(cloud_.xyz[i].head<2>().cast<double>());
        const bool ends_there = end.x() < way.strip.length && std::abs(end.y()) < way.strip.half;
        if (ends_there && ground_.height[i] > kVehicleBelly) return end.x();
        const double entry = entryOf(way.strip, way.sensor, end);
        if (!(entry < way.strip.length)) return entry;
        const double share = (way.sensor.x() - entry) / (way.sensor.x() - end.x());
        const double sensor_height = way.height - cloud_.xyz[i].z() + ground_.height[i];
        const double height = sensor_height + share * (ground_.height[i] - sensor_height);
        if (height <= kVehicleBelly) return kNever;  // it went through below
        return ends_there ? end.x() : height < windows ? entry : kNever;
    }

    const PointCloud& cloud_;
    const GroundModel& ground_;
    const BoxParams& params_;
    std::optional<ColumnMap> columns_;
    std::vector<SensorRays> sensors_;
    Vec2 viewpoint_ = Vec2::Zero();  ///< that sees the obstacle at hand
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
