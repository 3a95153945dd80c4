// SPDX-License-Identifier: BSD-3-Clause
#include "plots.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "common/number_text.h"
#include "gnuplot.h"
#include "lidar_obstacles/evaluation/box_overlap.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;
using evaluation::BoxErrors;
using evaluation::Group;
using evaluation::GroupMetrics;
using evaluation::ObjectRecord;

constexpr double kDegrees = 180.0 / M_PI;

const char* colorOf(Group group) {
    return group == Group::Vehicle ? "#d95f02" : group == Group::Pedestrian ? "#1b7fa8" : "#7a4fb5";
}

/// Between single quotes gnuplot reads two of them as one.
std::string quoted(const std::string& name) {
    std::string text;
    for (const char c : name) text += c == '\'' ? "''" : std::string(1, c);
    return text;
}

std::string svgTerminal(int width, int height) {
    return "set terminal svg size " + std::to_string(width) + ',' + std::to_string(height) +
           " dynamic font 'sans-serif,13' background '#ffffff'\n";
}

/// The svg element of a file, without the XML header, which has no place within HTML.
std::string svgElement(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const auto begin = text.find("<svg");
    if (begin == std::string::npos) throw std::runtime_error(file.string() + ": gnuplot wrote no SVG");
    return text.substr(begin);
}

Plot draw(const fs::path& stem, const std::string& title, const std::string& body) {
    const std::string head =
        svgTerminal(640, 360) + "set output '" + stem.filename().string() + ".svg'\n" +
        "set grid lc rgb '#dddddd'\nset border 3\nset tics nomirror\nset key outside top right horizontal\n";
    plot(stem, head + body);
    return {title, svgElement(stem.string() + ".svg"), false};
}

/// A figure of range bins with its interval.
struct BinFigure {
    const char* interval;  ///< its name among the intervals
    double (*value)(const GroupMetrics&);
    std::size_t (*count)(const GroupMetrics&);  ///< rows behind it
};

/// A data block with "middle of the bin, value, low, high" of one group.
std::string binBlock(const std::vector<evaluation::BinMetrics>& bins, const std::string& name,
                     const BinFigure& figure) {
    std::string block = '$' + name + " << EOD\n";
    for (const auto& [bin, m] : bins) {
        if (figure.count(m) == 0) continue;
        const double value = figure.value(m);
        const auto it = m.intervals.find(figure.interval);
        const bool known = it != m.intervals.end();
        block += fixedText(0.5 * (bin.from + bin.to), 2) + ' ' + fixedText(value, 5) + ' ' +
                 fixedText(known ? it->second.low : value, 5) + ' ' + fixedText(known ? it->second.high : value, 5) +
                 '\n';
    }
    return block + "EOD\n";
}

/// Lines with error bars, one per group with rows.
std::string binScript(const evaluation::Metrics& metrics, const BinFigure& figure) {
    std::string blocks;
    std::string curves;
    double shift = 0.0;  // so that error bars of groups do not lie on one another
    for (const auto& [group, bins] : metrics.bins) {
        const std::string name = toString(group);
        blocks += binBlock(bins, name, figure);
        const std::string x = "($1+" + fixedText(shift, 1) + ')';
        curves += std::string(curves.empty() ? "plot " : ", ") + '$' + name + " using " + x +
                  ":2:3:4 with yerrorbars lw 1.5 pt 7 ps 0.7 lc rgb '" + colorOf(group) + "' title '" + name + "', $" +
                  name + " using " + x + ":2 with lines lw 1.5 lc rgb '" + colorOf(group) + "' notitle";
        shift += 0.3;
    }
    return blocks + "set xlabel 'distance of the nearest face [m]'\n" + curves + '\n';
}

using ErrorOf = std::optional<double> (*)(const BoxErrors&);

/// "distance, error" of every found row of a group.
std::string scatterRows(const std::vector<evaluation::SetResult>& sets, Group group, ErrorOf error) {
    std::string rows;
    for (const auto& set : sets) {
        for (const ObjectRecord& r : set.records) {
            if (!r.counted || !r.errors || r.object.group != group) continue;
            const std::optional<double> value = error(*r.errors);
            if (value) rows += fixedText(r.object.range, 2) + ' ' + fixedText(*value, 4) + '\n';
        }
    }
    return rows;
}

/// A dot per found row, one colour per group; "" where there is none.
std::string scatterScript(const std::vector<evaluation::SetResult>& sets, ErrorOf error) {
    std::string blocks;
    std::string curves;
    for (const Group group : evaluation::kGroups) {
        const std::string rows = scatterRows(sets, group, error);
        if (rows.empty()) continue;
        const std::string name = toString(group);
        blocks += '$' + name + " << EOD\n" + rows + "EOD\n";
        curves += std::string(curves.empty() ? "plot " : ", ") + '$' + name + " with points pt 7 ps 0.25 lc rgb '" +
                  colorOf(group) + "' title '" + name + "'";
    }
    if (curves.empty()) return "";
    return blocks + "set xlabel 'distance of the nearest face [m]'\nset xzeroaxis lc rgb '#888888'\n" + curves + '\n';
}

std::optional<double> faceOf(const BoxErrors& e) { return e.face; }

std::optional<double> headingOf(const BoxErrors& e) {
    if (!e.heading_valid) return std::nullopt;
    return kDegrees * e.heading_180;
}

std::size_t askedOf(const GroupMetrics& m) { return m.asked; }
std::size_t foundOf(const GroupMetrics& m) { return m.found; }
std::size_t headingsOf(const GroupMetrics& m) { return m.heading_180.count; }

/// Along the vehicle's x axis, relative to the vehicle where its own velocity is known [m/s].
std::string aheadText(const ObjectRecord& r, double over_ground) {
    const double own = r.ego_velocity ? r.ego_velocity->x() : 0.0;
    return std::isfinite(over_ground) ? ' ' + fixedText(over_ground - own, 3) : " ?";
}

bool isAskedTarget(const evaluation::SetResult& set, const ObjectRecord& r) {
    return r.object.object_id == set.target_id && r.counted;
}

/// "time, true distance, true heading, distance, heading, missed, true velocity, velocity" of the target's counted
/// rows; "?" where there is none.
std::string targetBlock(const evaluation::SetResult& set) {
    std::string block = "$target << EOD\n";
    double start = 0.0;
    double last = 0.0;
    bool any = false;
    for (const ObjectRecord& r : set.records) {
        if (!isAskedTarget(set, r)) continue;
        if (!any) start = r.timestamp;
        if (any && r.timestamp - last > 1.0) block += '\n';  // not asked for in between: no line across
        any = true;
        last = r.timestamp;
        const double yaw = evaluation::wrapAngle(r.object.box.yaw, 2.0 * M_PI);
        block +=
            fixedText(r.timestamp - start, 3) + ' ' + fixedText(r.object.range, 3) + ' ' + fixedText(kDegrees * yaw, 3);
        block += r.errors ? ' ' + fixedText(r.detection->range, 3) : " ?";
        const bool heading = r.errors && r.errors->heading_valid;
        block += heading ? ' ' + fixedText(kDegrees * (yaw + r.errors->heading_180), 3) : " ?";
        block += r.errors ? " ?" : " 0";
        block += aheadText(r, r.object.velocity.x());
        block += (r.errors ? aheadText(r, r.detection->track.velocity.x()) : " ?") + '\n';
    }
    return block + "EOD\n";
}

/// Whether the velocities of the target are told relative to the vehicle.
bool knowsOwnVelocity(const evaluation::SetResult& set) {
    return std::all_of(set.records.begin(), set.records.end(),
                       [&](const ObjectRecord& r) { return !isAskedTarget(set, r) || r.ego_velocity; });
}

/// Whether truth or tracks tell a velocity of the target.
bool knowsTargetVelocity(const evaluation::SetResult& set) {
    return std::any_of(set.records.begin(), set.records.end(), [&](const ObjectRecord& r) {
        return isAskedTarget(set, r) &&
               (std::isfinite(r.object.velocity.x()) || (r.errors && std::isfinite(r.detection->track.velocity.x())));
    });
}

/// Distance, heading and, where one is known, velocity over time, one below the other.
std::string targetScript(const evaluation::SetResult& set) {
    const auto points = [](const char* columns) {
        return "plot $target using " + std::string(columns) +
               " with points pt 7 ps 0.3 lc rgb '#d95f02' title 'measured', ";
    };
    const auto truth = [](const char* columns) {
        return "$target using " + std::string(columns) + " with lines lw 1.3 lc rgb '#1b4f72' title 'truth'";
    };
    const bool with_velocity = knowsTargetVelocity(set);
    const std::string time = "\nset xlabel 'time [s]'\n";
    const std::string velocity = knowsOwnVelocity(set) ? "relative velocity [m/s]" : "velocity over ground [m/s]";
    return "set grid lc rgb '#dddddd'\nset border 3\nset tics nomirror\nset datafile missing '?'\n"
           "set key outside top right horizontal\nset lmargin 9\n"
           "set multiplot layout " +
           std::string(with_velocity ? "3" : "2") +
           ",1\n"
           "set ylabel 'distance [m]'\nset yrange [0:*]\n" +
           points("1:4") + truth("1:2") +
           ", $target using 1:6 with points pt 2 ps 0.5 lc rgb '#c0392b' title 'not found'\n"
           "set ylabel 'relative heading [deg]'\nset yrange [*:*]\nset xzeroaxis lc rgb '#aaaaaa'\n" +
           (with_velocity ? "" : time) + points("1:5") + truth("1:3") +
           (with_velocity ? "\nset ylabel '" + velocity + "'" + time + points("1:8") + truth("1:7") : "") +
           "\nunset multiplot\nunset output\n";
}

}  // namespace

std::vector<Plot> plotMetrics(const std::vector<evaluation::SetResult>& sets, const evaluation::Metrics& metrics,
                              const fs::path& folder) {
    std::vector<Plot> plots;
    if (metrics.bins.empty()) return plots;
    const BinFigure recall{"recall", [](const GroupMetrics& m) { return m.recall(); }, askedOf};
    const BinFigure face{"face_mae", [](const GroupMetrics& m) { return m.face.mean_abs; }, foundOf};
    const BinFigure heading{"h180_mae", [](const GroupMetrics& m) { return m.heading_180.mean_abs; }, headingsOf};
    plots.push_back(draw(folder / "recall_by_range", "Recall by range",
                         "set ylabel 'recall'\nset yrange [0:1.05]\n" + binScript(metrics, recall)));
    const std::string faces = scatterScript(sets, faceOf);
    if (faces.empty()) return plots;  // nothing was found: there are no errors to draw
    plots.push_back(draw(folder / "face_by_range", "Mean absolute error of the nearest face by range",
                         "set ylabel '[m]'\nset yrange [0:*]\n" + binScript(metrics, face)));
    plots.push_back(draw(folder / "face_errors", "Errors of the nearest face", "set ylabel '[m]'\n" + faces));
    const std::string headings = scatterScript(sets, headingOf);
    if (headings.empty()) return plots;
    plots.push_back(draw(folder / "heading_by_range", "Mean absolute heading error modulo 180 degrees by range",
                         "set ylabel '[deg]'\nset yrange [0:*]\n" + binScript(metrics, heading)));
    plots.push_back(draw(folder / "heading_errors", "Heading errors modulo 180 degrees",
                         "set ylabel '[deg]'\nset yrange [-95:95]\nset ytics 30\n" + headings));
    return plots;
}

std::optional<Plot> plotTarget(const evaluation::SetResult& set, const std::string& title, const fs::path& stem) {
    if (std::none_of(set.records.begin(), set.records.end(), [&](const auto& r) { return isAskedTarget(set, r); }))
        return std::nullopt;
    const std::string name = quoted(stem.filename().string());
    const std::string body = targetScript(set);
    const std::string reset = "reset\n";
    plot(stem, targetBlock(set) + svgTerminal(900, 780) + "set output '" + name + ".svg'\n" + body + reset +
                   "set terminal pngcairo size 1800,1560 font 'sans,22' pointscale 1.6 linewidth 2 background "
                   "'#ffffff'\nset output '" +
                   name + ".png'\n" + body);
    return Plot{title, svgElement(stem.string() + ".svg"), true};
}

}  // namespace lidar_obstacles::apps
