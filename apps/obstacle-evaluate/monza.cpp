// SPDX-License-Identifier: BSD-3-Clause
#include "monza.h"

#include <algorithm>
#include <array>

#include "common/number_text.h"
#include "common/text_file.h"
#include "metrics_json.h"
#include "report.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;
using evaluation::GroupMetrics;

/// What the paper reports of its own recording (Sec. V).
struct PaperRow {
    const char* name;
    double distance;     ///< mean distance error [m]
    double heading_deg;  ///< mean heading error
};
constexpr std::array<PaperRow, 2> kPaper = {{{"paper, 16 planes", 0.7, 0.1}, {"paper, 8 planes", 0.8, 0.12}}};

/// Cells of a row: found; mean, mean abs, median and p95 of distance, of heading, of velocity; swapped.
std::vector<std::string> cellsOf(const GroupMetrics& m) {
    std::vector<std::string> cells = {std::to_string(m.asked), m.asked > 0 ? percentText(m.recall()) : "-"};
    for (const auto& [s, decimals] : {std::pair(m.face, 3), std::pair(m.heading_180, 2), std::pair(m.velocity, 2)}) {
        if (s.count == 0) {
            cells.insert(cells.end(), {"-", "-", "-", "-"});
            continue;
        }
        cells.push_back(signedText(s.mean, decimals));
        for (const double value : {s.mean_abs, s.median_abs, s.p95_abs}) cells.push_back(fixedText(value, decimals));
    }
    cells.push_back(m.heading_180.count > 0 ? percentText(m.swap_rate) : "-");
    return cells;
}

std::vector<std::string> cellsOf(const PaperRow& row) {
    return {"-",
            "-",
            fixedText(row.distance, 1),
            "-",
            "-",
            "-",
            fixedText(row.heading_deg, 2),
            "-",
            "-",
            "-",
            "-",
            "-",
            "-",
            "-",
            "-"};
}

const std::vector<std::string>& columnNames() {
    static const std::vector<std::string> names = {"scans",
                                                   "found",
                                                   "distance: mean [m]",
                                                   "mean abs",
                                                   "median abs",
                                                   "p95 abs",
                                                   "heading: mean [deg]",
                                                   "mean abs",
                                                   "median abs",
                                                   "p95 abs",
                                                   "velocity: mean [m/s]",
                                                   "mean abs",
                                                   "median abs",
                                                   "p95 abs",
                                                   "swapped"};
    return names;
}

std::string htmlRow(const std::string& name, const std::vector<std::string>& cells, const char* tag) {
    const std::string open = std::string("<") + tag + ">";
    const std::string close = std::string("</") + tag + ">";
    std::string row = "<tr>" + open + escaped(name) + close;
    for (const std::string& c : cells) row += open + c + close;
    return row + "</tr>\n";
}

std::string htmlTable(const std::vector<MonzaResult>& results) {
    std::string table = "<table>" + htmlRow("", columnNames(), "th");
    for (const MonzaResult& r : results) table += htmlRow(r.variant, cellsOf(r.target), "td");
    for (const PaperRow& row : kPaper) table += htmlRow(row.name, cellsOf(row), "td");
    return table + "</table>\n";
}

std::string page(const std::vector<MonzaResult>& results, const EvaluateOptions& options) {
    std::string text = pageHead("Distance and relative heading of one vehicle over a lap");
    text += "<p>The experiment of Mentasti et al., Sec. V. Scans count in which the target (" +
            escaped(options.evaluation.target) + ") has at least " + std::to_string(options.evaluation.min_points) +
            " returns and is within " + fixedText(options.evaluation.max_range, 0) +
            " m. Distance: of the nearest face; heading: modulo 180&deg;; velocity: relative to the vehicle, along its "
            "x axis. The paper's means are of signed errors on a "
            "recording that is not public; they cannot be held against ours number by number.</p>\n" +
            htmlTable(results) + "<div class=\"plots\">\n";
    for (const MonzaResult& r : results) {
        for (const Plot& p : r.figures)
            text +=
                "<figure class=\"wide\"><figcaption>" + escaped(p.title) + "</figcaption>\n" + p.svg + "</figure>\n";
    }
    text += "</div>\n";
    for (const MonzaResult& r : results) {
        text += "<h2>" + escaped(r.variant) + "</h2>\n<p><a href=\"" + r.variant +
                "/report.html\">Its own report</a>, with everything else that was seen on the way.</p>\n" +
                r.worst_scans;
    }
    return text + pageEnd();
}

}  // namespace

std::vector<Plot> plotFigures(const std::string& variant, const std::vector<evaluation::SetResult>& results,
                              const fs::path& folder) {
    std::vector<Plot> plots;
    for (const evaluation::SetResult& set : results) {
        const std::string name = variant + (results.size() > 1 ? '_' + set.name : "");
        if (auto figure = plotTarget(set, name, folder / ("fig_" + name))) plots.push_back(std::move(*figure));
    }
    return plots;
}

void writeMonza(const std::vector<MonzaResult>& results, const EvaluateOptions& options) {
    nlohmann::ordered_json json;
    for (const MonzaResult& r : results) json["variants"][r.variant] = toJson(r.target);
    for (const PaperRow& row : kPaper)
        json["paper"][row.name] = {{"mean_distance_error_m", row.distance},
                                   {"mean_heading_error_deg", row.heading_deg}};
    writeTextFile(fs::path(options.output) / "monza.json", json.dump(2) + "\n");
    if (options.report) writeTextFile(fs::path(options.output) / "monza.html", page(results, options));
}

std::string monzaTable(const std::vector<MonzaResult>& results) {
    const auto row = [](const std::string& name, const std::vector<std::string>& cells) {
        std::string line = name + std::string(name.size() < 18 ? 18 - name.size() : 0, ' ');
        for (std::size_t k = 0; k < cells.size(); ++k) {
            const std::size_t width = k == 0 ? 7 : k % 4 == 2 ? 11 : 9;  // the figures stand in groups of four
            line += std::string(width - std::min(width, cells[k].size()), ' ') + cells[k];
        }
        return line + '\n';
    };
    std::string text = "\n" +
                       row("", {"", "", "distance", "[m]", "", "", "heading", "[deg]", "", "", "velocity", "[m/s]"}) +
                       row("", {"scans", "found", "mean", "abs", "median", "p95", "mean", "abs", "median", "p95",
                                "mean", "abs", "median", "p95", "swapped"});
    for (const MonzaResult& r : results) text += row(r.variant, cellsOf(r.target));
    for (const PaperRow& p : kPaper) text += row(p.name, cellsOf(p));
    return text;
}

}  // namespace lidar_obstacles::apps
