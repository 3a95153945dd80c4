// SPDX-License-Identifier: BSD-3-Clause
#include "report.h"

#include "common/number_text.h"
#include "common/text_file.h"
#include "database.h"
#include "html.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;
using apps::fixedText;

constexpr int kMostRows = 2000;  // of recordings, failures and changes: a page that a browser still opens
constexpr int kStrangest = 30;
constexpr int kSlowest = 30;

std::string count(std::size_t number) { return std::to_string(number); }

/// How often an SQL question's rows are shown as a table; each column is text.
std::string tableOf(const Database& database, const std::vector<std::string>& head, const std::string& sql) {
    auto rows = database.prepare(sql + " LIMIT " + std::to_string(kMostRows));
    std::string table = tableHead(head);
    int shown = 0;
    for (; rows.step(); ++shown) {
        std::vector<std::string> cells;
        cells.reserve(head.size());
        for (int k = 0; k < static_cast<int>(head.size()); ++k) cells.push_back(escaped(rows.text(k)));
        table += tableRow(cells);
    }
    table += "</table>\n";
    if (shown == 0) return "<p>None.</p>\n";
    if (shown == kMostRows) table += "<p>The first " + std::to_string(kMostRows) + " only; the database has all.</p>\n";
    return table;
}

std::string overAll(const Database& d) {
    return tableOf(d, {"status", "recordings", "pieces of work", "GB"},
                   "SELECT coalesce(s.status, 'missing or not readable'), count(*), count(DISTINCT r.result), "
                   "printf('%.3f', sum(r.bytes) / 1e9) FROM recordings r LEFT JOIN results s USING(result) "
                   "GROUP BY 1 ORDER BY 1") +
           tableOf(
               d,
               {"scans", "hours", "returns", "vehicles", "pedestrians", "cyclists", "structure", "unknown", "tracks"},
               "SELECT count(*), printf('%.3f', (SELECT sum(t) FROM (SELECT max(timestamp) - min(timestamp) AS t "
               "FROM scans GROUP BY result)) / 3600.0), coalesce(sum(returns), 0), coalesce(sum(vehicles), 0), "
               "coalesce(sum(pedestrians), 0), coalesce(sum(cyclists), 0), coalesce(sum(structure), 0), "
               "coalesce(sum(unknown), 0), (SELECT count(*) FROM tracks) FROM scans") +
           "<p><small>Obstacles are counted in every scan that has them, tracks once. Tracks by class:</small></p>\n" +
           tableOf(d, {"class", "tracks", "scans of each", "nearest [m]", "fastest [m/s]"},
                   "SELECT class, count(*), printf('%.1f', avg(scans)), printf('%.1f', min(nearest)), "
                   "printf('%.1f', max(fastest)) FROM tracks GROUP BY class ORDER BY count(*) DESC, class");
}

std::string failures(const Database& d) {
    return "<h2>Failures</h2>\n<div class=\"words\">" +
           tableOf(d, {"recording", "status", "reason"},
                   "SELECT name, status, reason FROM failures ORDER BY status, name") +
           "</div>\n";
}

std::string strangest(const Database& d) {
    return "<h2>Strangest scans</h2>\n<p><small>How far one of a scan's numbers is from the median of its recording, "
           "in "
           "robust standard deviations; of each recording the strangest scan.</small></p>\n" +
           tableOf(d,
                   {"recording", "scan", "by", "strangeness", "returns", "ground [%]", "road users", "structure",
                    "fastest [m/s]"},
                   "SELECT * FROM (SELECT (SELECT min(name) FROM recordings r WHERE r.result = s.result), scan_index, "
                   "strange_by, printf('%.1f', max(strangeness)), returns, ground_percent, vehicles + pedestrians + "
                   "cyclists, structure, fastest FROM scans s GROUP BY result HAVING max(strangeness) > 0 "
                   "ORDER BY max(strangeness) DESC, result LIMIT " +
                       std::to_string(kStrangest) + ")");
}

std::string eachRecording(const Database& d) {
    return "<h2>Recordings</h2>\n" +
           tableOf(d,
                   {"recording", "status", "scans", "vehicles", "pedestrians", "cyclists", "structure", "unknown",
                    "tracks", "nearest road user [m]"},
                   "SELECT r.name, coalesce(s.status, 'missing'), s.scans, v.vehicles, v.pedestrians, v.cyclists, "
                   "v.structure, v.unknown, s.tracks, (SELECT round(min(nearest), 1) FROM tracks t WHERE "
                   "t.result = r.result AND class IN ('vehicle', 'pedestrian', 'cyclist')) FROM recordings r LEFT JOIN "
                   "results s USING(result) LEFT JOIN (SELECT result, sum(vehicles) vehicles, sum(pedestrians) "
                   "pedestrians, sum(cyclists) cyclists, sum(structure) structure, sum(unknown) unknown FROM scans "
                   "GROUP BY result) v USING(result) ORDER BY r.name");
}

std::string pair(const std::string& before, const std::string& now) {
    return before == now ? escaped(now) : escaped(before) + " &rarr; <b>" + escaped(now) + "</b>";
}

std::string changeRow(const Change& c, bool has_boxes) {
    const std::string replay = !c.replay.empty() ? link(c.replay, "side by side") : escaped(c.no_replay);
    std::vector<std::string> cells = {escaped(c.name), pair(c.before, c.now),
                                      pair(count(c.scans_before), count(c.scans_now)),
                                      pair(count(c.tracks_before), count(c.tracks_now))};
    if (has_boxes)
        for (const std::size_t n : {c.scans_changed, c.boxes.gone, c.boxes.fresh, c.boxes.moved, c.worst_scan})
            cells.push_back(count(n));
    cells.push_back(replay);
    return tableRow(cells);
}

std::string driftText(const Drift& drift) {
    std::string text = "<h2>Against the baseline</h2>\n<p>" + escaped(drift.baseline) + ", version " +
                       escaped(drift.version) + ": of the recordings with the same content " + count(drift.same) +
                       " have the same bytes, <b>" + count(drift.changes.size()) + " changed</b>; " +
                       count(drift.only_now) + " are new, " + count(drift.only_before) +
                       " are not there any more.</p>\n";
    if (!drift.parameters_changed.empty()) {
        text += "<p>Parameters that changed:</p>\n<ul>";
        for (const std::string& line : drift.parameters_changed) text += "<li>" + escaped(line) + "</li>";
        text += "</ul>\n";
    }
    if (drift.changes.empty()) return text;
    std::vector<std::string> head = {"recording", "status", "scans", "tracks"};
    if (drift.has_boxes)
        for (const char* cell : {"scans changed", "boxes gone", "new", "moved", "most in scan"})
            head.emplace_back(cell);
    else
        text += "<p>One of the two has no rows of obstacles: boxes are not compared.</p>\n";
    head.emplace_back("replay");
    text +=
        "<p><small>A box is gone or new where the other run has none of its class within 1 m, moved where its place or "
        "size differs by more than .1 m, its heading by more than 5 degrees.</small></p>\n" +
        tableHead(head);
    std::size_t shown = 0;
    for (const Change& c : drift.changes)
        if (shown++ < kMostRows) text += changeRow(c, drift.has_boxes);
    return text + "</table>\n";
}

std::string timings(Database& d, const fs::path& all) {
    auto attach = d.prepare("ATTACH ? AS fleet");
    attach.bind(0, std::string_view(all.native()));
    attach.run();
    const std::string name = "(SELECT min(name) FROM fleet.recordings r WHERE r.result = t.result)";
    const std::string total = "(decode_ms + detect_ms)";
    return "<p>" + link("report.html", "What was seen") +
           "</p>\n<p><small>These figures differ from run to run; reading "
           "is what passes between two scans, with poses and what else the file holds.</small></p>\n<h2>Slowest "
           "scans</h2>\n" +
           tableOf(d, {"recording", "scan", "ms", "decoding", "detecting", "slowest stage", "its ms", "read"},
                   "SELECT * FROM (SELECT " + name + ", scan_index, printf('%.2f', " + total +
                       "), printf('%.2f', decode_ms), "
                       "printf('%.2f', detect_ms), slowest_stage, printf('%.2f', slowest_stage_ms), printf('%.2f', "
                       "read_ms) "
                       "FROM timings t ORDER BY " +
                       total + " DESC LIMIT " + std::to_string(kSlowest) + ")") +
           "<h2>Recordings, slowest first</h2>\n" +
           tableOf(d, {"recording", "scans", "ms per scan", "slowest [ms]", "reading, per scan", "in all [s]"},
                   "SELECT " + name + ", count(*), printf('%.2f', avg" + total + "), printf('%.2f', max" + total +
                       "), printf('%.2f', avg(read_ms)), printf('%.1f', sum(read_ms + decode_ms + detect_ms) / 1e3) "
                       "FROM timings t GROUP BY result ORDER BY avg" +
                       total + " DESC");
}

}  // namespace

void writeReports(const fs::path& folder, const Drift* drift) {
    const Database all(folder / "fleet.sqlite", Database::Mode::Read);
    apps::writeTextFile(folder / "report.html",
                        page("What the fleet saw", "<p>" + link("timings.html", "How long it took") + "</p>\n" +
                                                       overAll(all) + (drift != nullptr ? driftText(*drift) : "") +
                                                       failures(all) + strangest(all) + eachRecording(all)));
    Database times(folder / "timings.sqlite", Database::Mode::Read);
    apps::writeTextFile(folder / "timings.html",
                        page("How long the fleet took", timings(times, folder / "fleet.sqlite")));
}

}  // namespace lidar_obstacles::fleet
