// SPDX-License-Identifier: BSD-3-Clause
#include "tracking_text.h"

#include <cstdio>
#include <vector>

#include "common/number_text.h"
#include "lidar_obstacles/evaluation/metrics.h"
#include "report.h"

namespace lidar_obstacles::apps {
namespace {

using evaluation::GroupTracking;
using evaluation::TrackingResult;

/// A table: the names of its columns, and rows that begin with the name of a group.
struct Table {
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};

std::string numberOr(const std::optional<double>& value, int decimals) {
    return value ? fixedText(*value, decimals) : "-";
}

std::string percentOr(const std::optional<double>& share) { return share ? percentText(*share) : "-"; }

std::optional<double> shareOf(std::size_t part, std::size_t whole) {
    if (whole == 0) return std::nullopt;
    return static_cast<double>(part) / static_cast<double>(whole);
}

/// "median / p95" of errors that are not negative.
std::string quantiles(const std::vector<double>& errors, int decimals) {
    const evaluation::ErrorStatistics s = evaluation::statisticsOf(errors);
    return s.count > 0 ? fixedText(s.median_abs, decimals) + " / " + fixedText(s.p95_abs, decimals) : "-";
}

Table classesTable(const TrackingResult& result) {
    Table table{
        {"classes", "asked", "precision", "recall", "F1", "AP", "ECE", "wrong boxes per scan, by what they are on"},
        {}};
    const auto scans = static_cast<double>(std::max<std::size_t>(result.scans, 1));
    for (const auto& [group, g] : result.groups) {
        const evaluation::ClassCounts& c = g.classes;
        std::string wrong;
        for (const auto& [on, n] : c.wrong)
            wrong += (wrong.empty() ? "" : ", ") + on + ' ' + fixedText(static_cast<double>(n) / scans, 3);
        table.rows.push_back({toString(group), std::to_string(c.asked), fixedText(c.precision(), 3),
                              fixedText(c.recall(), 3), fixedText(c.f1(), 3), numberOr(c.averagePrecision(), 3),
                              numberOr(c.calibrationError(), 3), wrong.empty() ? "none" : wrong});
    }
    return table;
}

Table tracksTable(const TrackingResult& result) {
    Table table{{"tracks", "objects", "HOTA", "DetA", "AssA", "MOTA", "id switches", "fragments", "mostly tracked",
                 "standing, scan to scan: yaw [deg]", "length [m]"},
                {}};
    for (const auto& [group, g] : result.groups) {
        table.rows.push_back({toString(group), std::to_string(g.clear.objects), fixedText(g.hota.hota(), 3),
                              fixedText(g.hota.detection(), 3), fixedText(g.hota.associationAccuracy(), 3),
                              fixedText(g.clear.mota(), 3), std::to_string(g.clear.id_switches),
                              std::to_string(g.clear.fragmentations),
                              percentOr(shareOf(g.clear.mostly_tracked, g.clear.objects)),
                              quantiles(g.jitter.yaw_deg, 2), quantiles(g.jitter.length, 3)});
    }
    return table;
}

Table velocityTable(const TrackingResult& result) {
    Table table{{"velocities", "told", "moving: error", "standing: speed", "> .5 m/s", "told to move: moving",
                 "standing", "direction known", "error [deg]", "reversed"},
                {}};
    for (const auto& [group, g] : result.groups) {
        const evaluation::VelocityCounts& v = g.velocity;
        table.rows.push_back({toString(group), percentOr(shareOf(v.told, v.asked)), quantiles(v.moving, 2),
                              quantiles(v.standing, 2), percentOr(v.ghosts()),
                              percentOr(evaluation::shareOf(v.moving_called)),
                              percentOr(evaluation::shareOf(v.standing_called)),
                              percentOr(shareOf(v.heading_360_deg.size(), v.headings_asked)),
                              quantiles(v.heading_360_deg, 1), percentOr(v.reversed())});
    }
    return table;
}

std::vector<Table> tablesOf(const TrackingResult& result) {
    std::vector<Table> tables = {classesTable(result)};
    if (!result.repeated_id.empty()) return tables;
    tables.push_back(tracksTable(result));
    tables.push_back(velocityTable(result));
    return tables;
}

std::string plain(const Table& table) {
    std::vector<std::size_t> widths;
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
        widths.push_back(table.columns[k].size());
        for (const auto& row : table.rows) widths[k] = std::max(widths[k], row[k].size());
    }
    const auto line = [&](const std::vector<std::string>& cells) {
        std::string text;
        for (std::size_t k = 0; k + 1 < cells.size(); ++k)
            text += cells[k] + std::string(widths[k] - cells[k].size() + 2, ' ');
        return text + cells.back() + '\n';
    };
    std::string text = '\n' + line(table.columns);
    for (const auto& row : table.rows) text += line(row);
    return text;
}

std::string html(const Table& table) {
    std::string text = "<table><tr>";
    for (const std::string& c : table.columns) text += "<th>" + escaped(c) + "</th>";
    text += "</tr>\n";
    for (const auto& row : table.rows) {
        text += "<tr>";
        for (const std::string& c : row) text += "<td>" + escaped(c) + "</td>";
        text += "</tr>\n";
    }
    return text + "</table>\n";
}

std::string blindText(const evaluation::BlindCounts& b) {
    std::string text = "near objects without any box: " + std::to_string(b.blind) + " of " + std::to_string(b.asked) +
                       " (" + percentText(b.share()) + "), longest run " + std::to_string(b.longestRun()) + " scans";
    if (b.runs.empty()) return text;
    return text + " (" + b.runs.front().set + ", object " + b.runs.front().object_id + "), " +
           std::to_string(b.objectsBlindFor(3)) + " objects for 3 scans or more";
}

}  // namespace

std::string trackingText(const TrackingResult& result) {
    if (result.groups.empty()) return "";
    std::string text;
    for (const Table& table : tablesOf(result)) text += plain(table);
    if (!result.repeated_id.empty()) text += "no figures of tracks: " + result.repeated_id + '\n';
    return text + '\n' + blindText(result.blind) + '\n';
}

std::string trackingHtml(const TrackingResult& result) {
    if (result.groups.empty()) return "";
    std::string text =
        "<h2>Classes and tracks</h2>\n<p><small>Boxes as they were told, class included. Person: pedestrians and "
        "cyclists together, either class accepted. Two numbers: median / 95th percentile; velocities in m/s, of tracks "
        "that are 1 s old; moving: faster than 1 m/s, standing: slower than .1 m/s.</small></p>\n";
    for (const Table& table : tablesOf(result)) text += html(table);
    if (!result.repeated_id.empty()) text += "<p>No figures of tracks: " + escaped(result.repeated_id) + ".</p>\n";
    return text + "<p>" + escaped(blindText(result.blind)) + ".</p>\n";
}

}  // namespace lidar_obstacles::apps
