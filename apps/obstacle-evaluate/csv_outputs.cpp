// SPDX-License-Identifier: BSD-3-Clause
#include "csv_outputs.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/csv_cell.h"
#include "common/number_text.h"
#include "lidar_obstacles/evaluation/metrics.h"

namespace lidar_obstacles::apps {
namespace {

using evaluation::CountedRow;
using evaluation::GroupMetrics;
using evaluation::ObjectRecord;

constexpr double kDegrees = 180.0 / M_PI;

/// The counted rows of each object of a set, objects in order of appearance.
std::vector<std::vector<CountedRow>> rowsByObject(const evaluation::SetResult& set) {
    std::vector<std::vector<CountedRow>> rows;
    std::map<std::string, std::size_t> place;
    for (const ObjectRecord& r : set.records) {
        if (!r.counted) continue;
        const std::size_t k = place.try_emplace(r.object.object_id, rows.size()).first->second;
        if (k == rows.size()) rows.emplace_back();
        rows[k].push_back({&r, k});
    }
    return rows;
}

std::string objectRow(const std::string& set, const std::vector<CountedRow>& rows) {
    const evaluation::TruthObject& o = rows.front().record->object;
    const GroupMetrics m = evaluation::summariseRows(rows, {0, 0});
    double nearest = o.range;
    double farthest = o.range;
    for (const CountedRow& row : rows) {
        nearest = std::min(nearest, row.record->object.range);
        farthest = std::max(farthest, row.record->object.range);
    }
    std::string text = csvCell(set) + ',' + csvCell(o.object_id) + ',' + csvCell(o.type) + ',' +
                       std::to_string(m.asked) + ',' + std::to_string(m.found) + ',' + fixedText(m.recall(), 4) + ',' +
                       fixedText(nearest, 3) + ',' + fixedText(farthest, 3);
    const auto mean = [&](bool any, double value, int decimals) {
        text += any ? ',' + fixedText(value, decimals) : ",";
    };
    mean(m.found > 0, m.face.mean, 4);
    mean(m.found > 0, m.face.mean_abs, 4);
    mean(m.found > 0, m.centre.mean_abs, 4);
    mean(m.heading_180.count > 0, m.heading_180.mean, 3);
    mean(m.heading_180.count > 0, m.heading_180.mean_abs, 3);
    mean(m.found > 0, m.bev_iou_mean, 4);
    mean(m.found > 0, m.iou_3d_mean, 4);
    return text + '\n';
}

std::string matchRow(const std::string& set, const ObjectRecord& r) {
    const evaluation::TruthObject& o = r.object;
    std::string text = csvCell(set) + ',' + fixedText(r.timestamp, 6) + ',' + std::to_string(o.scan_index) + ',' +
                       csvCell(o.object_id) + ',' + csvCell(o.type) + (r.counted ? ",1," : ",0,") +
                       std::to_string(o.num_points) + ',' + fixedText(o.occluded, 3) + ',' + fixedText(o.range, 4) +
                       ',' + fixedText(o.box.center.x(), 4) + ',' + fixedText(o.box.center.y(), 4) + ',' +
                       fixedText(kDegrees * o.box.yaw, 3);
    if (!r.detection) return text + ",,,,,,,,,,,,\n";
    const evaluation::Detection& d = *r.detection;
    const evaluation::BoxErrors& e = *r.errors;
    return text + ',' + d.id + ',' + d.cls + ',' + fixedText(d.box.center.x(), 4) + ',' +
           fixedText(d.box.center.y(), 4) + ',' + fixedText(kDegrees * d.box.yaw, 3) +
           (d.heading_valid ? ",1," : ",0,") + fixedText(d.range, 4) + ',' + fixedText(e.face, 4) + ',' +
           fixedText(e.centre, 4) + ',' + fixedText(kDegrees * e.heading_180, 3) + ',' + fixedText(e.bev_iou, 4) + ',' +
           fixedText(e.iou_3d, 4) + '\n';
}

}  // namespace

std::string objectsCsv(const std::vector<evaluation::SetResult>& sets) {
    std::string text =
        "set,object_id,type,asked,found,recall,range_min,range_max,face_mean,face_mae,centre_mae,h180_mean_deg,"
        "h180_mae_deg,bev_iou,iou_3d\n";
    for (const auto& set : sets) {
        for (const auto& rows : rowsByObject(set)) text += objectRow(set.name, rows);
    }
    return text;
}

std::string matchesCsv(const std::vector<evaluation::SetResult>& sets) {
    std::string text =
        "set,timestamp,scan_index,object_id,type,counted,num_points,occluded,range,x,y,yaw_deg,det_id,det_class,det_x,"
        "det_y,det_yaw_deg,heading_valid,det_range,face,centre,h180_deg,bev_iou,iou_3d\n";
    for (const auto& set : sets) {
        for (const ObjectRecord& r : set.records) text += matchRow(set.name, r);
    }
    return text;
}

}  // namespace lidar_obstacles::apps
