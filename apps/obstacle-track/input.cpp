// SPDX-License-Identifier: BSD-3-Clause
#include "input.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "lidar_obstacles/evaluation/csv_table.h"
#include "lidar_obstacles/evaluation/truth.h"
#include "lidar_obstacles/tracking.h"

namespace lidar_obstacles::apps {
namespace {

using evaluation::CsvReader;

/// Classes as obstacles.csv has them, or as a data set calls its objects.
ObstacleClass classOf(const std::string& word) {
    if (word == toString(ObstacleClass::Structure)) return ObstacleClass::Structure;
    return evaluation::classOf(evaluation::groupOf(word));
}

std::uint8_t facesOf(const CsvReader& csv) {
    if (!csv.has("faces") || csv.text("faces") == "-") return 0;
    std::uint8_t faces = 0;
    for (const char letter : csv.text("faces")) {
        const std::string_view letters = "FBLR";
        const auto at = letters.find(letter);
        if (at == std::string_view::npos)
            csv.fail("faces: '" + csv.text("faces") + "' holds other letters than F B L R");
        faces = static_cast<std::uint8_t>(faces | (1U << at));
    }
    return faces;
}

/// The part that was seen: the faces turned to the vehicle are where they are.
OrientedBox seenPart(const OrientedBox& box, double length, double width) {
    OrientedBox seen = box;
    const Eigen::Vector2d ahead(std::cos(box.yaw), std::sin(box.yaw));
    const std::array<Eigen::Vector2d, 2> axes{ahead, Eigen::Vector2d(-ahead.y(), ahead.x())};
    seen.size.head<2>() = Eigen::Vector2d(length, width);
    for (int k = 0; k < 2; ++k) {
        const Eigen::Vector2d& axis = axes[static_cast<std::size_t>(k)];
        const double towards = axis.dot(box.center.head<2>()) > 0.0 ? -1.0 : 1.0;
        seen.center.head<2>() += 0.5 * (box.size[k] - seen.size[k]) * towards * axis;
    }
    return seen;
}

double optionalNumber(const CsvReader& csv, const std::string& column, double otherwise) {
    return csv.has(column) && !csv.text(column).empty() ? csv.number(column) : otherwise;
}

Obstacle boxOfRow(const CsvReader& csv) {
    Obstacle o;
    o.cls = classOf(csv.lowerText("class"));
    o.box.center = {csv.number("x"), csv.number("y"), csv.number("z")};
    o.box.size = {csv.nonNegative("length"), csv.nonNegative("width"), csv.nonNegative("height")};
    o.box.yaw = csv.number("yaw");
    o.heading_valid = csv.flag("heading_valid");
    o.num_points = csv.integer("num_points");
    if (csv.has("num_rings") && !csv.text("num_rings").empty()) o.num_rings = csv.integer("num_rings");
    o.faces = facesOf(csv);
    o.heading_std = optionalNumber(csv, "heading_std", 0.0);
    o.seen_box = seenPart(o.box, optionalNumber(csv, "seen_length", o.box.size.x()),
                          optionalNumber(csv, "seen_width", o.box.size.y()));
    const bool open_above = !csv.has("max_height") || csv.text("max_height").empty() || csv.text("max_height") == "inf";
    o.max_height = open_above ? std::numeric_limits<double>::infinity() : csv.nonNegative("max_height");
    const double probability = optionalNumber(csv, "probability", -1.0);
    if (probability > 1.0) csv.fail("probability: '" + csv.text("probability") + "' is above 1");
    if (probability >= 0.0) o.probability = classesOfLabel(o.cls, probability);
    return o;
}

}  // namespace

EgoRows readEgo(const std::string& file) {
    CsvReader csv(file, {"scan_index", "timestamp", "x", "y", "z", "roll", "pitch", "yaw"});
    EgoRows ego;
    while (csv.next()) {
        ScanRows scan;
        scan.scan_index = csv.integer("scan_index");
        scan.timestamp = csv.number("timestamp");
        if (!ego.scans.empty() && scan.timestamp <= ego.scans.back().timestamp) csv.fail("timestamp does not rise");
        StampedPose pose;
        pose.time = scan.timestamp;
        pose.position = {csv.number("x"), csv.number("y"), csv.number("z")};
        pose.orientation = Eigen::AngleAxisd(csv.number("yaw"), Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(csv.number("pitch"), Eigen::Vector3d::UnitY()) *
                           Eigen::AngleAxisd(csv.number("roll"), Eigen::Vector3d::UnitX());
        ego.scans.push_back(std::move(scan));
        ego.poses.push_back(pose);
    }
    return ego;
}

std::vector<ScanRows> readDetections(const std::string& file, std::vector<ScanRows> scans) {
    CsvReader csv(file, {"timestamp", "scan_index", "class", "x", "y", "z", "length", "width", "height", "yaw",
                         "heading_valid", "num_points"});
    const bool fixed_scans = !scans.empty();
    std::map<int, std::size_t> place;
    for (std::size_t k = 0; k < scans.size(); ++k) place[scans[k].scan_index] = k;
    while (csv.next()) {
        const int index = csv.integer("scan_index");
        auto at = place.find(index);
        if (at == place.end()) {
            if (fixed_scans) csv.fail("scan_index: the poses have no scan " + std::to_string(index));
            at = place.emplace(index, scans.size()).first;
            scans.push_back({index, csv.number("timestamp"), {}, {}, 0});
        }
        ScanRows& scan = scans[at->second];
        if (std::abs(csv.number("timestamp") - scan.timestamp) > 0.05)
            csv.fail("timestamp: not that of scan " + std::to_string(index));
        if (csv.has("seen") && !csv.text("seen").empty() && !csv.flag("seen")) {
            ++scan.unseen;
            continue;
        }
        scan.boxes.push_back(boxOfRow(csv));
        scan.time_offsets.push_back(optionalNumber(csv, "time_offset", 0.0));
    }
    std::sort(scans.begin(), scans.end(), [](const auto& a, const auto& b) { return a.timestamp < b.timestamp; });
    return scans;
}

}  // namespace lidar_obstacles::apps
