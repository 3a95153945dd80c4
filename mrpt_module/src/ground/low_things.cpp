// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/low_things.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "ground/low_marks.h"
#include "lidar_obstacles/types.h"
#include "scan/label_sets.h"

namespace lidar_obstacles {
namespace {

/// Sets of marks of one kind, side by side on a ring or on neighbouring ones.
LabelSets groupsOf(const std::vector<LowMark>& marks, const NearGround& near) {
    constexpr int kColumns = 6;      // beside each other at most
    constexpr float kAlong = 0.4f;   // on a ring [m]
    constexpr float kAcross = 1.0f;  // from ring to ring [m]
    LabelSets groups(static_cast<int>(marks.size()));
    std::vector<int> number(static_cast<std::size_t>(near.rings()) * near.columns(), -1);
    for (int k = 0; k < static_cast<int>(marks.size()); ++k) {
        const LowMark& m = marks[k];
        const Eigen::Vector2f place = near.place(m.column, m.to);
        for (int up = 0; up <= std::min(2, m.ring); ++up)
            for (int step = -kColumns; step <= kColumns; ++step) {
                const int column = near.wrap(m.column + step);
                const int other = number[static_cast<std::size_t>(m.ring - up) * near.columns() + column];
                if (other < 0 || marks[other].kind != m.kind) continue;
                const float apart = (near.place(column, marks[other].to) - place).norm();
                if (apart <= (up == 0 ? kAlong : kAcross)) groups.join(k, other);
            }
        number[static_cast<std::size_t>(m.ring) * near.columns() + m.column] = k;
    }
    return groups;
}

/// Box around the spans, seen from above.
OrientedBox boxAroundSpans(const LowThing& thing, double ground_z) {
    constexpr float kThin = 0.02f;  // [m]
    std::vector<cv::Point2f> corners;
    corners.reserve(2 * thing.spans.size());
    for (const LowSpan& s : thing.spans) {
        corners.emplace_back(s.from.x(), s.from.y());
        if (thing.kind != LowKind::Raised) corners.emplace_back(s.to.x(), s.to.y());
    }
    const cv::RotatedRect r = cv::minAreaRect(corners);
    OrientedBox box;
    box.size = {static_cast<double>(std::max(r.size.width, kThin)), static_cast<double>(std::max(r.size.height, kThin)),
                0.0};
    box.yaw = static_cast<double>(r.angle) * M_PI / 180.0;
    if (box.size.x() < box.size.y()) {
        std::swap(box.size.x(), box.size.y());
        box.yaw += 0.5 * M_PI;
    }
    box.yaw = normalizeAngle(box.yaw);
    box.size.z() = std::abs(thing.height);
    box.center = {static_cast<double>(r.center.x), static_cast<double>(r.center.y), ground_z + 0.5 * thing.height};
    return box;
}

/// Fewer beams than that are noise, rain, grass.
bool isEnough(const LowThing& thing) {
    constexpr std::array<std::size_t, 3> kFewest{4, 8, 3};
    constexpr std::array<double, 3> kNarrowest{0.0, 0.25, 0.25};  // [m]
    const auto kind = static_cast<std::size_t>(thing.kind);
    return thing.spans.size() >= kFewest[kind] && thing.box.size.x() >= kNarrowest[kind];
}

void addThings(const NearGround& near, const GroundModel& ground, std::vector<LowThing>& things) {
    const std::vector<LowMark> marks = lowMarks(near);
    LabelSets groups = groupsOf(marks, near);
    std::vector<std::vector<const LowMark*>> members(marks.size());
    for (int k = 0; k < static_cast<int>(marks.size()); ++k) members[groups.find(k)].push_back(&marks[k]);
    for (const auto& group : members) {
        if (group.empty()) continue;
        LowThing thing;
        thing.kind = group.front()->kind;
        thing.spans.reserve(group.size());
        for (const LowMark* m : group) {
            thing.spans.push_back({near.place(m->column, m->from), near.place(m->column, m->to)});
            const NearGround::Cell& cell = near.at(m->ring, m->column);
            if (thing.kind == LowKind::NoGround) continue;
            thing.spans.back() = {near.placeOn(cell, m->from), near.placeOn(cell, m->to)};
            thing.points.push_back(cell.point);
            const auto height = static_cast<double>(cell.height);
            thing.height =
                thing.kind == LowKind::Raised ? std::max(thing.height, height) : std::min(thing.height, height);
        }
        const Eigen::Vector2f& first = thing.spans.front().from;
        thing.box = boxAroundSpans(thing, ground.heightAt(first.x(), first.y()));
        if (isEnough(thing)) things.push_back(std::move(thing));
    }
}

float nearestSpan(const LowThing& thing, const Eigen::Vector2f& sensor) {
    float nearest = std::numeric_limits<float>::infinity();
    for (const LowSpan& s : thing.spans) nearest = std::min(nearest, (s.from - sensor).norm());
    return nearest;
}

}  // namespace

std::vector<LowThing> findLowThings(const PointCloud& cloud, const GroundModel& ground, const DetectorParams& params) {
    std::vector<LowThing> things;
    if (cloud.view.empty() || cloud.empty() || ground.evidence == GroundEvidence::None) return things;
    const std::size_t sensors = cloud.allSensors().size();
    for (std::size_t s = 0; s < sensors; ++s) addThings(NearGround(cloud, ground, params, s), ground, things);
    const Eigen::Vector2f middle = cloud.sensor_origin.head<2>();
    std::stable_sort(things.begin(), things.end(), [&](const LowThing& a, const LowThing& b) {
        return nearestSpan(a, middle) < nearestSpan(b, middle);
    });
    return things;
}

const char* toString(LowKind kind) {
    constexpr std::array<const char*, 3> kNames{"raised", "drop", "no_ground"};
    return kNames[static_cast<std::size_t>(kind)];
}

}  // namespace lidar_obstacles
