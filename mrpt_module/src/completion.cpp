#include "lidar_obstacles/completion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "column_map.h"

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
        own_.assign(cloud.size(), 0);
    }

    void grow(Obstacle& o) {
        const Ownership own(*this, o);
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
        return axisOf(box, k).dot(cloud_.sensor_origin.head<2>().cast<double>() - box.center.head<2>());
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

    /// How far a face turned away from the sensor may move: up to the third nearest beam that crosses its way.
    double freeWay(const Strip& strip, const Obstacle& o) const {
        constexpr std::size_t kIgnored = 2;
        const Vec2 sensor = strip.local(cloud_.sensor_origin.head<2>().cast<double>());
        std::vector<double> entries;
        std::size_t at_once = 0;
        const auto look = [&](std::int32_t i) {
            if (own_[i] != 0) return;
            const Vec2 end = strip.local(cloud_.xyz[i].head<2>().cast<double>());
            if (end.x() <= 0.0) return;  // most beams end before the strip
            const double entry = stopAt(strip, sensor, end, {i, o.box.size.z()});
            if (entry >= strip.length) return;
            entries.push_back(std::max(0.0, entry));
            at_once += entry <= 0.0;
        };
        const auto blocked = [&] { return at_once > kIgnored; };
        if (columns_)
            lookAlongColumns(strip, look, blocked);
        else
            for (std::size_t i = 0; i < cloud_.size() && !blocked(); ++i) look(static_cast<std::int32_t>(i));
        if (entries.size() <= kIgnored) return strip.length;
        std::nth_element(entries.begin(), entries.begin() + kIgnored, entries.end());
        return entries[kIgnored];
    }

    /// Looks at the returns of the columns that a strip covers until it is blocked.
    template <class Look, class Blocked>
    void lookAlongColumns(const Strip& strip, const Look& look, const Blocked& blocked) const {
        const Vec2 sensor = cloud_.sensor_origin.head<2>().cast<double>();
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
        const double step = 6.283185307179586 / view.columns;
        for (double a = low; a <= high && !blocked(); a += step) {
            const int column = columns_->columnOf(middle + a);
            for (int ring = 0; ring < view.rings; ++ring)
                if (const std::int32_t i = view.at(ring, column); i >= 0) look(i);
        }
    }

    /// A return, and how high the obstacle is that its beam may cross [m].
    struct Crossing {
        std::int32_t i = 0;
        double top = 0.0;
    };

    /// Where along the strip the return or its beam shows that no vehicle stands; infinite if it does not.
    double stopAt(const Strip& strip, const Vec2& sensor, const Vec2& end, const Crossing& c) const {
        constexpr double kBelly = 0.3;
        const double windows = std::min(0.8, c.top - 0.2);
        if (end.x() < strip.length && std::abs(end.y()) < strip.half) return end.x();
        const double entry = entryOf(strip, sensor, end);
        if (!(entry < strip.length)) return entry;
        const double share = (sensor.x() - entry) / (sensor.x() - end.x());
        const double sensor_height = cloud_.sensor_origin.z() - cloud_.xyz[c.i].z() + ground_.height[c.i];
        const double height = sensor_height + share * (ground_.height[c.i] - sensor_height);
        return height > kBelly && height < windows ? entry : kNever;
    }

    const PointCloud& cloud_;
    const GroundModel& ground_;
    const BoxParams& params_;
    std::optional<ColumnMap> columns_;
    std::vector<std::uint8_t> own_;  ///< returns of the obstacle at hand
};

}  // namespace

std::vector<Obstacle> completeBoxes(std::vector<Obstacle> obstacles, const PointCloud& cloud, const GroundModel& ground,
                                    const BoxParams& params) {
    Completer completer(cloud, ground, params);
    for (Obstacle& o : obstacles) {
        const bool vehicle = o.cls == ObstacleClass::Vehicle && o.heading_valid;
        o.seen_box = o.box;
        if (vehicle && params.completion == Completion::Prior) completer.grow(o);
    }
    return obstacles;
}

}  // namespace lidar_obstacles
