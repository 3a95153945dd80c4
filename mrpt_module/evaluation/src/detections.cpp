#include "lidar_obstacles/evaluation/detections.h"

#include "lidar_obstacles/evaluation/box_overlap.h"
#include "lidar_obstacles/evaluation/csv_table.h"

namespace lidar_obstacles::evaluation {

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
        detections.push_back(std::move(d));
    }
    return detections;
}

}  // namespace lidar_obstacles::evaluation
