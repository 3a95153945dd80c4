// SPDX-License-Identifier: BSD-3-Clause
#include "objects/free_way.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "lidar_obstacles/joined_cloud.h"
#include "lidar_obstacles/object_models.h"

namespace lidar_obstacles {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kNever = std::numeric_limits<double>::infinity();

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

}  // namespace

/// What was found on the way of a face.
struct FreeWay::Way {
    Strip strip;
    Body body;
    Vec2 sensor = Vec2::Zero();  ///< that is looked from, in the strip's frame
    float height = 0.0f;         ///< of it, in the cloud's frame [m]
    /// Where the nearest beams enter the strip that show that no vehicle stands there; the nearest first.
    std::array<double, 3> entries{kNever, kNever, kNever};
};

FreeWay::FreeWay(const PointCloud& cloud, const GroundModel& ground, double ceiling)
    : cloud_(cloud), ground_(ground), ceiling_(ceiling) {
    if (!cloud.view.empty() && !cloud.empty()) columns_.emplace(cloud);
    for (const SensorRays& sensor : cloud.allSensors()) sensors_.push_back(sensor);
    own_.assign(cloud.size(), 0);
}

void FreeWay::own(const std::vector<std::int32_t>& returns, std::uint8_t value) {
    for (const std::int32_t i : returns) own_[i] = value;
}

double FreeWay::operator()(const Strip& strip, const Body& body) const {
    Way way{strip, body};
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

double FreeWay::hiddenShare(const Strip& strip, const std::vector<std::int32_t>& body) const {
    constexpr double kFar = 1e3;  // so many times as long: a beam that nothing stops
    if (!columns_ || body.empty()) return 0.0;
    const std::size_t s = sensorThatSaw(body, cloud_);
    int lowest = std::numeric_limits<int>::max(), highest = -1;
    for (const std::int32_t i : body) {
        if (cloud_.sensorOf(i) != s) continue;
        lowest = std::min<int>(lowest, cloud_.ring[i]);
        highest = std::max<int>(highest, cloud_.ring[i]);
    }
    const Vec2 sensor = strip.local(sensors_[s].origin.head<2>().cast<double>());
    int beams = 0;
    int stopped = 0;
    const auto look = [&](std::int32_t i) {
        if (cloud_.ring[i] < lowest || cloud_.ring[i] > highest) return;
        const Vec2 end = strip.local(cloud_.xyz[i].head<2>().cast<double>());
        if (entryOf(strip, sensor, sensor + kFar * (end - sensor)) == kNever) return;
        ++beams;
        stopped += static_cast<int>(entryOf(strip, sensor, end) == kNever);
    };
    lookAlongColumns(strip, s, look, [] { return false; });
    return beams == 0 ? 0.0 : static_cast<double>(stopped) / beams;
}

/// Notes where the beam of a return enters the strip, if it does.
void FreeWay::enter(Way& way, std::int32_t i) const {
    double entry = std::max(0.0, stopAt(way, i));
    for (double& nearer : way.entries)
        if (entry < nearer) std::swap(entry, nearer);
}

/// Looks at a sensor's returns of the columns that a strip covers until it is blocked.
template <class Look, class Blocked>
void FreeWay::lookAlongColumns(const Strip& strip, std::size_t s, const Look& look, const Blocked& blocked) const {
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
    const int columns = 1 + static_cast<int>((high - low) * view.columns / (2.0 * M_PI));
    const int first = columns_->columnOf(middle + low);
    for (int k = 0; k < columns && !blocked(); ++k) {
        const int column = view.wrap(first + columns_->sense() * k);
        for (int ring = sensors_[s].first_ring; ring < sensors_[s].end_ring; ++ring)
            if (const std::int32_t i = view.at(ring, column); i >= 0) look(i);
    }
}

/// Where along the strip the return or its beam shows that no vehicle stands; infinite if it does not.
double FreeWay::stopAt(const Way& way, std::int32_t i) const {
    const double windows = std::min(way.body.windows, way.body.top);
    const Vec2 end = way.strip.local(cloud_.xyz[i].head<2>().cast<double>());
    const bool ends_there = end.x() < way.strip.length && std::abs(end.y()) < way.strip.half;
    const bool stands_there = ends_there && !(ground_.height[i] > ceiling_);
    if (stands_there && ground_.height[i] > way.body.belly) return end.x();
    const double entry = entryOf(way.strip, way.sensor, end);
    if (!(entry < way.strip.length)) return entry;
    const double share = (way.sensor.x() - entry) / (way.sensor.x() - end.x());
    const double height = way.height + share * (cloud_.xyz[i].z() - way.height) - way.body.floor;
    if (height <= way.body.belly) return kNever;  // it went through below
    return stands_there ? end.x() : height < windows ? entry : kNever;
}

}  // namespace lidar_obstacles
