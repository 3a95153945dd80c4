// SPDX-License-Identifier: BSD-3-Clause
#include "report.h"

#include <algorithm>

#include "common/number_text.h"
#include "tracking_text.h"

namespace lidar_obstacles::apps {
namespace {

using evaluation::ErrorStatistics;
using evaluation::GroupMetrics;

constexpr const char* kStyle =
    "body{font:15px/1.45 sans-serif;max-width:1320px;margin:2em auto;padding:0 1em;color:#222}"
    "h1{font-size:1.6em}h2{margin-top:2em;border-bottom:1px solid #ccc}h3{margin-bottom:.3em}"
    "table{border-collapse:collapse;margin:.6em 0;font-size:12.5px}th,td{border:1px solid #ccc;padding:.2em .5em;"
    "text-align:right}td{white-space:nowrap}th{background:#f2f2f2;font-weight:600}th:first-child,td:first-child{text-"
    "align:left}"
    "small{color:#666}.plots{display:flex;flex-wrap:wrap;gap:1em}.plots figure{margin:0;flex:1 1 560px;max-width:650px}"
    ".plots .wide{max-width:none;flex-basis:100%}.plots svg{width:100%;height:auto}figcaption{font-weight:600}"
    ".pair{display:flex;gap:.5em}.pair img{width:50%}ul{margin:.3em 0}.scan{margin-bottom:2em}"
    ".key b{padding:0 .35em;border-radius:3px;background:#14171c}";

std::string cell(const std::string& text) { return "<td>" + text + "</td>"; }

/// A value with its interval below.
std::string cellWith(const std::string& value, const GroupMetrics& m, const char* interval, int decimals) {
    const auto it = m.intervals.find(interval);
    if (it == m.intervals.end()) return cell(value);
    return cell(value + "<br><small>" + fixedText(it->second.low, decimals) + " .. " +
                fixedText(it->second.high, decimals) + "</small>");
}

std::string errorsText(const ErrorStatistics& s, int decimals) {
    if (s.count == 0) return "-";
    return signedText(s.mean, decimals) + " / <b>" + fixedText(s.mean_abs, decimals) + "</b> / " +
           fixedText(s.median_abs, decimals) + " / " + fixedText(s.p95_abs, decimals);
}

std::string metricsRow(const std::string& name, const GroupMetrics& m) {
    std::string row = "<tr>" + cell(name) + cell(std::to_string(m.asked)) + cell(std::to_string(m.objects));
    row += cellWith(m.asked > 0 ? fixedText(m.recall(), 3) : "-", m, "recall", 3);
    row += cellWith(errorsText(m.face, 2), m, "face_mae", 2) + cellWith(errorsText(m.centre, 2), m, "centre_mae", 2);
    row += cellWith(errorsText(m.heading_180, 1), m, "h180_mae", 1);
    row += cellWith(errorsText(m.heading_90, 1), m, "h90_mae", 1);
    const bool any = m.found > 0;
    row +=
        cellWith(any ? fixedText(m.bev_iou_mean, 2) + " / " + fixedText(m.bev_iou_median, 2) : "-", m, "iou_mean", 2);
    row += cellWith(any ? fixedText(m.iou_3d_mean, 2) + " / " + fixedText(m.iou_3d_median, 2) : "-", m, "iou3_mean", 2);
    return row + "</tr>\n";
}

std::string metricsTable(const GroupMetrics& all, const std::vector<evaluation::BinMetrics>& bins) {
    std::string table =
        "<table><tr><th></th><th>asked for</th><th>objects</th><th>recall</th><th>nearest face [m]</th><th>centre "
        "[m]</th><th>heading mod 180 [deg]</th><th>mod 90 [deg]</th><th>BEV IoU</th><th>3D IoU</th></tr>\n" +
        metricsRow("all", all);
    for (const auto& [bin, m] : bins)
        table += metricsRow(std::to_string(bin.from) + " - " + std::to_string(bin.to) + " m", m);
    table += "</table>\n";
    if (all.found == 0) return table;
    return table + "<p>Sizes (mean signed / abs): length " + signedText(all.length.mean, 2) + " / " +
           fixedText(all.length.mean_abs, 2) + " m, width " + signedText(all.width.mean, 2) + " / " +
           fixedText(all.width.mean_abs, 2) + " m, height " + signedText(all.height.mean, 2) + " / " +
           fixedText(all.height.mean_abs, 2) + " m. Headings: " + percentText(all.heading_valid) + " valid; of these " +
           percentText(all.over_20_deg) + " off by more than 20&deg;, " + percentText(all.swap_rate) +
           " with length and width exchanged, " + percentText(all.flip_rate) + " with front and rear exchanged.</p>\n";
}

std::string countsTable(const evaluation::Metrics& m) {
    const auto scans = static_cast<double>(std::max<std::size_t>(m.scans, 1));
    std::string table = "<table><tr><th>unmatched detections</th><th>in all</th><th>per scan</th></tr>\n";
    for (const auto& [cause, n] : m.unmatched) {
        table += "<tr>" + cell(cause) + cell(std::to_string(n)) + cell(fixedText(static_cast<double>(n) / scans, 3)) +
                 "</tr>\n";
    }
    return table +
           "</table>\n<p><small>fragment: on an object that another box matched (or too small a share of it); "
           "structure, "
           "overhead: on known clutter; ignored: on something neither wanted nor false; phantom: anything else. Sets "
           "without a list of clutter count it as phantoms.</small></p>\n";
}

std::string typesTable(const evaluation::Metrics& m) {
    std::string table = "<table><tr><th>type</th><th>asked for</th><th>found</th><th>class given</th></tr>\n";
    for (const auto& [type, n] : m.found_by_type) {
        std::string classes;
        const auto it = m.class_of_matched.find(type);
        if (it != m.class_of_matched.end()) {
            for (const auto& [cls, count] : it->second)
                classes += (classes.empty() ? "" : ", ") + escaped(cls) + ' ' + std::to_string(count);
        }
        table += "<tr>" + cell(escaped(type)) + cell(std::to_string(n.first)) + cell(std::to_string(n.second)) +
                 "<td style=\"text-align:left\">" + classes + "</td></tr>\n";
    }
    return table + "</table>\n";
}

std::string plotsSection(const std::vector<Plot>& plots) {
    if (plots.empty()) return "";
    std::string text = "<h2>Plots</h2>\n<div class=\"plots\">\n";
    for (const Plot& p : plots)
        text += (p.wide ? "<figure class=\"wide\"><figcaption>" : "<figure><figcaption>") + escaped(p.title) +
                "</figcaption>\n" + p.svg + "</figure>\n";
    return text + "</div>\n";
}

std::string image(const std::string& base64, const char* alt) {
    return "<img alt=\"" + std::string(alt) + "\" src=\"data:image/jpeg;base64," + base64 + "\">";
}

std::string worstScan(const ReportContent& content, std::size_t k, const std::string& folder) {
    const evaluation::WorstScan& scan = content.worst[k];
    std::string text = "<div class=\"scan\"><h3>" + std::to_string(k + 1) + ". " +
                       escaped((*content.results)[scan.set].name) + ", scan " + std::to_string(scan.scan_index) +
                       "</h3>\n<ul>";
    for (const std::string& reason : scan.reasons) text += "<li>" + escaped(reason) + "</li>";
    text += "</ul>\n";
    if (k < content.replays.size() && !content.replays[k].empty())
        text += "<p><a href=\"" + folder + content.replays[k] + "\">Play it, with the scans around it</a></p>\n";
    if (k < content.pictures.size() && !content.pictures[k].remarks.empty()) {
        text += "<p><small>Of the first:";
        for (const std::string& remark : content.pictures[k].remarks) text += ' ' + escaped(remark) + '.';
        text += "</small></p>\n";
    }
    if (k < content.pictures.size() && !content.pictures[k].overview.empty()) {
        text += "<div class=\"pair\">" + image(content.pictures[k].overview, "the scan from behind the vehicle") +
                image(content.pictures[k].close_up, "the object that failed most") + "</div>\n";
    }
    return text + "</div>\n";
}

std::string questionText(const EvaluateOptions& o, const Variant& variant) {
    const evaluation::EvaluationOptions& e = o.evaluation;
    std::string text = "<p>Asked for: objects with at least " + std::to_string(e.min_points) +
                       " returns whose nearest face is within " + fixedText(e.max_range, 0) + " m";
    if (e.fov_deg < 360.0) text += ", within the " + fixedText(e.fov_deg, 0) + "&deg; ahead";
    if (e.roi) text += ", within the region given";
    text += ". Intervals: 95 %, bootstrap over objects (" + std::to_string(o.bootstrap.replicates) +
            " replicates, seed " + std::to_string(o.bootstrap.seed) +
            "). Error columns: mean signed / <b>mean absolute</b> / median absolute / 95th percentile.</p>\n<p>Sets:";
    for (const SetFiles& s : o.sets) text += ' ' + escaped(s.name);
    text += ". Parameters: " + (o.config.empty() ? std::string("built-in defaults") : escaped(o.config));
    for (const std::string& s : o.set) text += ", " + escaped(s);
    for (const std::string& s : variant.set) text += ", " + escaped(s);
    return text + ".</p>\n";
}

}  // namespace

std::string worstScansHtml(const ReportContent& content, const std::string& folder) {
    if (content.worst.empty()) return "";
    std::string text =
        "<h2>The worst scans</h2>\n<p class=\"key\">By missed objects, distance and heading errors. Left: the scan "
        "from "
        "behind the vehicle; right: the object that failed most, from the vehicle's side. Boxes: "
        "<b style=\"color:#3cff3c\">truth</b> <b style=\"color:#ff8c00\">vehicle</b> "
        "<b style=\"color:#00ffff\">pedestrian</b> <b style=\"color:#c878ff\">cyclist</b> "
        "<b style=\"color:#ffffff\">unknown</b>; returns: <b style=\"color:#96754f\">ground</b> "
        "<b style=\"color:#ff00ff\">clusters sorted out</b>, obstacles in one colour each.</p>\n";
    for (std::size_t k = 0; k < content.worst.size(); ++k) text += worstScan(content, k, folder);
    return text;
}

std::string pageHead(const std::string& title) {
    return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + escaped(title) +
           "</title>\n<style>" + kStyle + "</style></head>\n<body>\n<h1>" + escaped(title) + "</h1>\n";
}

const char* const kNoPlots =
    "No plots: the program gnuplot is missing or does not run (Debian: gnuplot-nox; --no-report asks for none).";

std::string pageEnd() { return "</body></html>\n"; }

std::string reportHtml(const ReportContent& content, const EvaluateOptions& options, const Variant& variant) {
    const evaluation::Metrics& m = *content.metrics;
    std::string page = pageHead(content.title) + content.introduction + questionText(options, variant);
    page += "<p>" + std::to_string(m.scans) + " scans, " + std::to_string(m.detections) +
            " detections inside the region, " + std::to_string(m.detections_without_scan) + " of no scan.</p>\n";
    if (m.target) page += "<h2>Target</h2>\n" + metricsTable(*m.target, {});
    for (const auto& [group, metrics] : m.groups) {
        if (metrics.asked == 0) continue;
        page += std::string("<h2>") + toString(group) + "</h2>\n" + metricsTable(metrics, m.bins.at(group));
    }
    page += trackingHtml(m.tracking);
    page += "<h2>Types and leftovers</h2>\n" + typesTable(m) + countsTable(m);
    if (!options.plots) page += std::string("<p><small>") + kNoPlots + "</small></p>\n";
    return page + plotsSection(content.plots) + worstScansHtml(content) + pageEnd();
}

}  // namespace lidar_obstacles::apps
