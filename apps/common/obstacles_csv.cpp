// SPDX-License-Identifier: BSD-3-Clause
#include "common/obstacles_csv.h"

#include <charconv>
#include <cmath>

#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles::apps {
namespace {

/// Fixed decimals, whatever the locale.
std::string fixed(double value, int decimals) {
    char buffer[400];  // the largest double has 309 digits
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr};
}

/// That it is of its class; empty where classes were told by size.
std::string probabilityText(const Obstacle& o) {
    const float p = probabilityOf(o);
    return p > 0.0f ? fixed(p, 4) : "";
}

/// The cells that a tracker fills, each after a comma; empty where nothing is known.
std::string trackCells(const Obstacle& o) {
    std::string cells = ',' + probabilityText(o);
    if (!o.track) return cells + ",,,,,,,,,,,,";
    const TrackState& t = *o.track;
    cells += ',' + fixed(t.age, 3) + (t.seen ? ",1" : ",0");
    if (t.velocity) {
        for (const Eigen::Vector2d& pair : {*t.velocity, t.velocity_std})
            cells += ',' + fixed(pair.x(), 3) + ',' + fixed(pair.y(), 3);
        cells += t.moving ? ",1" : ",0";
    } else {
        cells += ",,,,,";
    }
    cells += (t.direction_known ? ",1," : ",0,") + fixed(t.yaw_std, 5);
    return cells + ',' + fixed(t.center_std.x(), 4) + ',' + fixed(t.center_std.y(), 4) + ',' + fixed(t.time_offset, 6);
}

}  // namespace

std::string csvHeader() {
    return "timestamp,scan_index,id,class,x,y,z,length,width,height,yaw,heading_valid,num_points,"
           "heading_std,num_rings,distance,heading_rule,faces,max_height,seen_length,seen_width,"
           "probability,age,seen,vx,vy,vx_std,vy_std,moving,direction_known,yaw_std,x_std,y_std,time_offset\n";
}

std::string csvRows(double timestamp, std::size_t scan_index, const std::vector<Obstacle>& obstacles) {
    std::string rows;
    for (const Obstacle& o : obstacles) {
        rows +=
            fixed(timestamp, 6) + ',' + std::to_string(scan_index) + ',' + std::to_string(o.id) + ',' + toString(o.cls);
        for (int k = 0; k < 3; ++k) rows += ',' + fixed(o.box.center[k], 4);
        for (int k = 0; k < 3; ++k) rows += ',' + fixed(o.box.size[k], 4);
        rows += ',' + fixed(o.box.yaw, 5) + (o.heading_valid ? ",1," : ",0,") + std::to_string(o.num_points);
        rows += ',' + fixed(o.heading_std, 5) + ',' + std::to_string(o.num_rings) + ',' + fixed(distanceTo(o.box), 4);
        rows += std::string(",") + toString(o.rule) + ',' + facesText(o.faces) + ',' +
                (std::isfinite(o.max_height) ? fixed(o.max_height, 4) : "inf") + ',' + fixed(o.seen_box.size.x(), 4) +
                ',' + fixed(o.seen_box.size.y(), 4) + trackCells(o) + '\n';
    }
    return rows;
}

}  // namespace lidar_obstacles::apps
