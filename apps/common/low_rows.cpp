// SPDX-License-Identifier: BSD-3-Clause
#include "common/low_rows.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "common/number_text.h"

namespace lidar_obstacles::apps {
namespace {

/// Of its spans' beginnings the one nearest to the vehicle's origin.
Eigen::Vector2d nearestOf(const LowThing& thing) {
    Eigen::Vector2d nearest = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
    for (const LowSpan& s : thing.spans) {
        const Eigen::Vector2d from = s.from.cast<double>();
        if (!(from.norm() >= nearest.norm())) nearest = from;
    }
    return nearest;
}

}  // namespace

nlohmann::ordered_json lowJson(const std::vector<LowThing>& low) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const LowThing& thing : low) {
        const Eigen::Vector2d nearest = nearestOf(thing);
        all.push_back({{"kind", toString(thing.kind)},
                       {"x", thousandths(thing.box.center.x())},
                       {"y", thousandths(thing.box.center.y())},
                       {"length", thousandths(thing.box.size.x())},
                       {"width", thousandths(thing.box.size.y())},
                       {"yaw", thousandths(thing.box.yaw)},
                       {"height", thousandths(thing.height)},
                       {"nearest", {thousandths(nearest.x()), thousandths(nearest.y())}},
                       {"beams", thing.spans.size()},
                       {"age", thousandths(thing.age)}});
    }
    return all;
}

std::string lowCsvHeader() {
    return "timestamp,scan_index,kind,x,y,length,width,yaw,height,nearest_x,nearest_y,beams,age\n";
}

std::string lowCsvRows(double timestamp, std::size_t scan_index, const std::vector<LowThing>& low) {
    std::string rows;
    for (const LowThing& thing : low) {
        const Eigen::Vector2d nearest = nearestOf(thing);
        rows += fixedText(timestamp, 6) + ',' + std::to_string(scan_index) + ',' + toString(thing.kind);
        for (const double value : {thing.box.center.x(), thing.box.center.y(), thing.box.size.x(), thing.box.size.y(),
                                   thing.box.yaw, thing.height, nearest.x(), nearest.y()})
            rows += ',' + fixedText(value, 3);
        rows += ',' + std::to_string(thing.spans.size()) + ',' + fixedText(thing.age, 3) + '\n';
    }
    return rows;
}

}  // namespace lidar_obstacles::apps
