// SPDX-License-Identifier: BSD-3-Clause
#include "common/obstacles_csv.h"

#include <cmath>

#include "common/number_text.h"
#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles::apps {
namespace {

/// That it is of its class; empty where classes were told by size.
std::string probabilityText(const Obstacle& o) {
    const float p = probabilityOf(o);
    return p > 0.0f ? fixedText(p, 4) : "";
}

/// The cells that a tracker fills, each after a comma; empty where nothing is known.
std::string trackCells(const Obstacle& o) {
    std::string cells = ',' + probabilityText(o);
    if (!o.track) return cells + ",,,,,,,,,,,,";
    const TrackState& t = *o.track;
    cells += ',' + fixedText(t.age, 3) + (t.seen ? ",1" : ",0");
    if (t.velocity) {
        for (const Eigen::Vector2d& pair : {*t.velocity, t.velocity_std})
            cells += ',' + fixedText(pair.x(), 3) + ',' + fixedText(pair.y(), 3);
        cells += t.moving ? ",1" : ",0";
    } else {
        cells += ",,,,,";
    }
    cells += (t.direction_known ? ",1," : ",0,") + fixedText(t.yaw_std, 5);
    return cells + ',' + fixedText(t.center_std.x(), 4) + ',' + fixedText(t.center_std.y(), 4) + ',' +
           fixedText(t.time_offset, 6);
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
        rows += fixedText(timestamp, 6) + ',' + std::to_string(scan_index) + ',' + std::to_string(o.id) + ',' +
                toString(o.cls);
        for (int k = 0; k < 3; ++k) rows += ',' + fixedText(o.box.center[k], 4);
        for (int k = 0; k < 3; ++k) rows += ',' + fixedText(o.box.size[k], 4);
        rows += ',' + fixedText(o.box.yaw, 5) + (o.heading_valid ? ",1," : ",0,") + std::to_string(o.num_points);
        rows += ',' + fixedText(o.heading_std, 5) + ',' + std::to_string(o.num_rings) + ',' +
                fixedText(distanceTo(o.box), 4);
        rows += std::string(",") + toString(o.rule) + ',' + facesText(o.faces) + ',' +
                (std::isfinite(o.max_height) ? fixedText(o.max_height, 4) : "inf") + ',' +
                fixedText(o.seen_box.size.x(), 4) + ',' + fixedText(o.seen_box.size.y(), 4) + trackCells(o) + '\n';
    }
    return rows;
}

}  // namespace lidar_obstacles::apps
