// SPDX-License-Identifier: BSD-3-Clause
#include "table.h"

#include <cstdio>

#include "common/number_text.h"
#include "tracking_text.h"

namespace lidar_obstacles::apps {
namespace {

using evaluation::ErrorStatistics;
using evaluation::GroupMetrics;

std::string padded(const std::string& text, int width) {
    char buffer[160];
    std::snprintf(buffer, sizeof buffer, "%-*s", width, text.c_str());
    return buffer;
}

std::string errorText(const ErrorStatistics& s, int decimals) {
    if (s.count == 0) return "-";
    return signedText(s.mean, decimals) + " / " + fixedText(s.mean_abs, decimals) + " / " +
           fixedText(s.median_abs, decimals) + " / " + fixedText(s.p95_abs, decimals);
}

/// One line; columns as in header().
std::string row(const std::string& name, const GroupMetrics& m) {
    std::string line = padded(name, 10) + padded(std::to_string(m.asked), 7);
    line += padded(m.asked > 0 ? fixedText(m.recall(), 3) : "-", 8);
    line += padded(errorText(m.face, 2), 30) + padded(errorText(m.centre, 2), 30);
    line += padded(errorText(m.heading_180, 1), 29) + padded(errorText(m.heading_90, 1), 28);
    const bool any = m.found > 0;
    line += padded(any ? fixedText(m.bev_iou_mean, 2) + ' ' + fixedText(m.bev_iou_median, 2) : "-", 10);
    return line + (any ? fixedText(m.iou_3d_mean, 2) : "-") + '\n';
}

std::string header() {
    return padded("", 10) + padded("asked", 7) + padded("recall", 8) + padded("nearest face [m]", 30) +
           padded("centre [m]", 30) + padded("heading mod 180 [deg]", 29) + padded("mod 90 [deg]", 28) +
           padded("BEV IoU", 10) + "3D IoU\n";
}

std::string rangeText(const GroupMetrics& m, const char* name, int decimals) {
    const auto it = m.intervals.find(name);
    if (it == m.intervals.end()) return "-";
    return fixedText(it->second.low, decimals) + " .. " + fixedText(it->second.high, decimals);
}

std::string details(const GroupMetrics& m) {
    if (m.found == 0) return "";
    std::string text = "   sizes (mean signed / abs): length " + signedText(m.length.mean, 2) + " / " +
                       fixedText(m.length.mean_abs, 2) + ", width " + signedText(m.width.mean, 2) + " / " +
                       fixedText(m.width.mean_abs, 2) + ", height " + signedText(m.height.mean, 2) + " / " +
                       fixedText(m.height.mean_abs, 2) + '\n';
    text += "   headings: valid " + percentText(m.heading_valid) + ", off by more than 20 deg " +
            percentText(m.over_20_deg) + ", swapped " + percentText(m.swap_rate) + ", flipped " +
            percentText(m.flip_rate) + '\n';
    if (m.intervals.empty()) return text;
    return text + "   95 % over " + std::to_string(m.objects) + " objects: recall " + rangeText(m, "recall", 3) +
           ", mean abs face " + rangeText(m, "face_mae", 3) + " m, heading " + rangeText(m, "h180_mae", 2) +
           " deg, BEV IoU " + rangeText(m, "iou_mean", 3) + '\n';
}

std::string groupTable(const std::string& name, const GroupMetrics& m,
                       const std::vector<evaluation::BinMetrics>& bins) {
    std::string text = '\n' + name + '\n' + header() + row("all", m);
    for (const auto& [bin, metrics] : bins)
        text += row(std::to_string(bin.from) + '-' + std::to_string(bin.to) + " m", metrics);
    return text + details(m);
}

std::string counts(const std::map<std::string, std::size_t>& by_name, std::size_t scans) {
    std::string text;
    for (const auto& [name, n] : by_name) {
        const double per_scan = static_cast<double>(n) / static_cast<double>(std::max<std::size_t>(scans, 1));
        text += (text.empty() ? "" : ", ") + name + ' ' + fixedText(per_scan, 3);
    }
    return text.empty() ? "none" : text;
}

std::string typesText(const evaluation::Metrics& m) {
    std::string text = "\nfound by type:";
    for (const auto& [type, n] : m.found_by_type)
        text += ' ' + type + ' ' + std::to_string(n.second) + '/' + std::to_string(n.first);
    text += "\nclass given:";
    for (const auto& [type, classes] : m.class_of_matched) {
        text += ' ' + type + " (";
        const char* comma = "";
        for (const auto& [cls, n] : classes) {
            text += comma + cls + ' ' + std::to_string(n);
            comma = ", ";
        }
        text += ')';
    }
    return text + '\n';
}

}  // namespace

std::string tableText(const evaluation::Metrics& m) {
    const double per_scan = static_cast<double>(m.detections) / static_cast<double>(std::max<std::size_t>(m.scans, 1));
    std::string text = std::to_string(m.scans) + " scans, " + fixedText(per_scan, 2) +
                       " detections per scan in the region, " + std::to_string(m.detections_without_scan) +
                       " of no scan\nunmatched per scan: " + counts(m.unmatched, m.scans) +
                       "\nerrors: mean signed / mean abs / median abs / p95 abs\n";
    for (const auto& [group, metrics] : m.groups) {
        if (metrics.asked == 0) continue;
        text += groupTable(toString(group), metrics, m.bins.at(group));
    }
    if (m.target) text += groupTable("target", *m.target, {});
    return text + typesText(m) + trackingText(m.tracking);
}

}  // namespace lidar_obstacles::apps
