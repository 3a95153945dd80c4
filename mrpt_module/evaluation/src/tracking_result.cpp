// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/evaluation/tracking_result.h"

#include <algorithm>
#include <tuple>

namespace lidar_obstacles::evaluation {
namespace {

template <class T>
void append(const std::vector<T>& from, std::vector<T>& to) {
    to.insert(to.end(), from.begin(), from.end());
}

template <std::size_t N>
void addTo(const std::array<double, N>& from, std::array<double, N>& to) {
    for (std::size_t k = 0; k < N; ++k) to[k] += from[k];
}

void addTo(const ClassCounts& from, ClassCounts& to) {
    to.asked += from.asked;
    append(from.claims, to.claims);
    for (const auto& [on, n] : from.wrong) to.wrong[on] += n;
}

void addTo(const HotaCounts& from, HotaCounts& to) {
    addTo(from.found, to.found);
    addTo(from.missed, to.missed);
    addTo(from.invented, to.invented);
    addTo(from.association, to.association);
}

void addTo(const ClearCounts& from, ClearCounts& to) {
    to.found += from.found;
    to.missed += from.missed;
    to.invented += from.invented;
    to.id_switches += from.id_switches;
    to.fragmentations += from.fragmentations;
    to.objects += from.objects;
    to.mostly_tracked += from.mostly_tracked;
}

void addTo(const VelocityCounts& from, VelocityCounts& to) {
    to.asked += from.asked;
    to.told += from.told;
    to.headings_asked += from.headings_asked;
    append(from.moving, to.moving);
    append(from.standing, to.standing);
    append(from.moving_called, to.moving_called);
    append(from.standing_called, to.standing_called);
    append(from.heading_360_deg, to.heading_360_deg);
}

void addTo(const GroupTracking& from, GroupTracking& to) {
    addTo(from.classes, to.classes);
    addTo(from.hota, to.hota);
    addTo(from.clear, to.clear);
    addTo(from.velocity, to.velocity);
    append(from.jitter.yaw_deg, to.jitter.yaw_deg);
    append(from.jitter.length, to.jitter.length);
}

std::optional<double> shareAbove(const std::vector<double>& values, double limit) {
    if (values.empty()) return std::nullopt;
    const auto n = std::count_if(values.begin(), values.end(), [&](double v) { return v > limit; });
    return static_cast<double>(n) / static_cast<double>(values.size());
}

}  // namespace

const char* toString(JudgedGroup group) {
    switch (group) {
        case JudgedGroup::Vehicle:
            return "vehicle";
        case JudgedGroup::Pedestrian:
            return "pedestrian";
        case JudgedGroup::Cyclist:
            return "cyclist";
        case JudgedGroup::Person:
            break;
    }
    return "person";
}

bool belongsTo(Group group, JudgedGroup judged) {
    switch (judged) {
        case JudgedGroup::Vehicle:
            return group == Group::Vehicle;
        case JudgedGroup::Pedestrian:
            return group == Group::Pedestrian;
        case JudgedGroup::Cyclist:
            return group == Group::Cyclist;
        case JudgedGroup::Person:
            break;
    }
    return group == Group::Pedestrian || group == Group::Cyclist;
}

bool isLonger(const BlindRun& a, const BlindRun& b) {
    return std::tie(a.scans, a.object_id, a.set) > std::tie(b.scans, b.object_id, b.set);
}

std::optional<double> shareOf(const std::vector<bool>& answers) {
    if (answers.empty()) return std::nullopt;
    return static_cast<double>(std::count(answers.begin(), answers.end(), true)) / static_cast<double>(answers.size());
}

std::optional<double> VelocityCounts::ghosts() const { return shareAbove(standing, 0.5); }
std::optional<double> VelocityCounts::reversed() const { return shareAbove(heading_360_deg, 90.0); }

double BlindCounts::share() const {
    return static_cast<double>(blind) / static_cast<double>(std::max<std::size_t>(asked, 1));
}

std::size_t BlindCounts::objectsBlindFor(std::size_t scans) const {
    const auto n = std::count_if(runs.begin(), runs.end(), [&](const BlindRun& r) { return r.scans >= scans; });
    return static_cast<std::size_t>(n);
}

void TrackingResult::add(const TrackingResult& other) {
    scans += other.scans;
    for (const auto& [cls, n] : other.boxes) boxes[cls] += n;
    blind.asked += other.blind.asked;
    blind.blind += other.blind.blind;
    append(other.blind.runs, blind.runs);
    std::sort(blind.runs.begin(), blind.runs.end(), isLonger);
    for (const auto& [group, counts] : other.groups) addTo(counts, groups[group]);
    if (repeated_id.empty()) repeated_id = other.repeated_id;
}

}  // namespace lidar_obstacles::evaluation
