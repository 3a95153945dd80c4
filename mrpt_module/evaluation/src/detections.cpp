// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/evaluation/detections.h"

#include "lidar_obstacles/evaluation/box_overlap.h"
#include "lidar_obstacles/evaluation/csv_table.h"

namespace lidar_obstacles::evaluation {
namespace {

/// The number in a column that a file need not have.
double optionalCell(const CsvReader& csv, const char* column) {
    return csv.has(column) ? csv.numberOrNan(column) : ToldTrack::kUnknown;
}

ToldTrack trackOf(const CsvReader& csv) {
    ToldTrack t;
    t.probability = optionalCell(csv, "probability");
    t.velocity = {optionalCell(csv, "vx"), optionalCell(csv, "vy")};
    t.moving = optionalCell(csv, "moving");
    t.direction_known = optionalCell(csv, "direction_known");
    t.age = optionalCell(csv, "age");
    t.seen = optionalCell(csv, "seen");
    return t;
}

}  // namespace

std::vector<Detection> readDetections(const std::string& file) {
    CsvReader csv(file, {"timestamp", "scan_index", "id", "class", "x", "y", "z", "length", "width", "height", "yaw",
                         "heading_valid", "num_points"});
    std::vector<Detection> detections;
    while (csv.next()) {
        Detection d;
        d.timestamp = csv.number("timestamp");
        d.scan_index = csv.integer("scan_index");
        d.id = csv.text("id");
        d.cls = csv.lowerText("class");
        d.group = groupOf(d.cls);
        d.box.center = {csv.number("x"), csv.number("y"), csv.number("z")};
        d.box.size = {csv.nonNegative("length"), csv.nonNegative("width"), csv.nonNegative("height")};
        d.box.yaw = csv.number("yaw");
        d.heading_valid = csv.flag("heading_valid");
        d.num_points = csv.integer("num_points");
        d.range = nearestFaceDistance(d.box);
        d.track = trackOf(csv);
        detections.push_back(std::move(d));
    }
    return detections;
}

}  // namespace lidar_obstacles::evaluation
