#include "lidar_obstacles/completion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "column_map.h"

namespace lidar_obstacles {
namespace {

using Vec2 = Eigen::Vector2d;

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

/// How far along the strip the beam of a return enters it where a vehicle would have stopped it: infinite if it does
/// not.
double entryOf(const Strip& strip, const Vec2& sensor, const Vec2& end) {
    const Vec2 a = strip.local(sensor);
    const Vec2 d = strip.local(end) - a;
    double in = 0.0;
    double out = 1.0;
    const double low[2] = {0.0, -strip.half};
    const double high[2] = {strip.length, strip.half};
    for (int k = 0; k < 2; ++k) {
        if (std::abs(d[k]) < 1e-9) {
            if (a[k] < low[k] || a[k] > high[k]) return std::numeric_limits<double>::infinity();
            continue;
        }
        const double s = (low[k] - a[k]) / d[k];
        const double t = (high[k] - a[k]) / d[k];
        in = std::max(in, std::min(s, t));
        out = std::min(out, std::max(s, t));
    }
    if (in >= out) return std::numeric_limits<double>::infinity();
    return std::min(a.x() + in * d.x(), a.x() + out * d.x());
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

    /// How far the face may move: up to the third nearest beam that crosses its way.
    double freeWay(const Strip& strip, const Obstacle& o) const {
        constexpr std::size_t kIgnored = 2;
        const float reach = nearestCorner(strip);
        const Eigen::Vector2f sensor = cloud_.sensor_origin.head<2>();
        std::vector<double> entries;
        const auto look = [&](std::int32_t i) {
            // most beams end before the strip
            if (i < 0 || (cloud_.xyz[i].head<2>() - sensor).squaredNorm() < reach * reach || own_[i] != 0) return;
            const double entry = stopAt(strip, i, o.box.size.z());
            if (entry < strip.length) entries.push_back(std::max(0.0, entry));
        };
        if (columns_)
            lookAlongColumns(strip, look);
        else
            for (std::size_t i = 0; i < cloud_.size(); ++i) look(static_cast<std::int32_t>(i));
        if (entries.size() <= kIgnored) return strip.length;
        std::nth_element(entries.begin(), entries.begin() + kIgnored, entries.end());
        return entries[kIgnored];
    }

    /// A distance from the sensor within which no point of the strip lies [m].
    float nearestCorner(const Strip& strip) const {
        const Vec2 sensor = strip.local(cloud_.sensor_origin.head<2>().cast<double>());
        const double along = std::max({0.0, -sensor.x(), sensor.x() - strip.length});
        const double across = std::max(0.0, std::abs(sensor.y()) - strip.half);
        return static_cast<float>(std::hypot(along, across));
    }

    template <class Look>
    void lookAlongColumns(const Strip& strip, const Look& look) const {
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
        for (double a = low; a <= high; a += step) {
            const int column = columns_->columnOf(middle + a);
            for (int ring = 0; ring < view.rings; ++ring) look(view.at(ring, column));
        }
    }

    /// Where along the strip the return or its beam shows that no vehicle stands; infinite if it does not.
    double stopAt(const Strip& strip, std::int32_t i, double top) const {
        constexpr double kBelly = 0.3;
        const double windows = std::min(0.8, top - 0.2);
        const Vec2 sensor = cloud_.sensor_origin.head<2>().cast<double>();
        const Vec2 end = cloud_.xyz[i].head<2>().cast<double>();
        const double entry = entryOf(strip, sensor, end);
        if (!(entry < strip.length)) return entry;
        const Vec2 e = strip.local(end);
        const bool ends_inside = e.x() > 0.0 && e.x() < strip.length && std::abs(e.y()) < strip.half;
        if (ends_inside) return e.x();
        const double share = (strip.local(sensor).x() - entry) / (strip.local(sensor).x() - e.x());
        const double sensor_height = cloud_.sensor_origin.z() - cloud_.xyz[i].z() + ground_.height[i];
        const double height = sensor_height + share * (ground_.height[i] - sensor_height);
        return height > kBelly && height < windows ? entry : std::numeric_limits<double>::infinity();
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
