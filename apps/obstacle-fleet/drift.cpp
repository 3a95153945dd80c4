// SPDX-License-Identifier: BSD-3-Clause
#include "drift.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "common/number_text.h"
#include "database.h"
#include "lidar_obstacles/obstacle.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;

struct Box {
    std::string cls;
    double x, y, z, length, width, height, yaw;
};

bool isMoved(const Box& a, const Box& b) {
    constexpr double kFar = 0.1;                  // [m]
    constexpr double kTurned = 5.0 * M_PI / 180;  // [rad]
    const double size =
        std::max({std::abs(a.length - b.length), std::abs(a.width - b.width), std::abs(a.height - b.height)});
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) > kFar || size > kFar ||
           std::abs(normalizeAngle(a.yaw - b.yaw)) > kTurned;
}

BoxChanges changesOf(const std::vector<Box>& before, std::vector<Box> now) {
    constexpr double kSame = 1.0;  // [m]
    BoxChanges changes;
    for (const Box& b : before) {
        auto nearest = now.end();
        double least = kSame;
        for (auto n = now.begin(); n != now.end(); ++n) {
            const double distance = std::hypot(b.x - n->x, b.y - n->y);
            if (n->cls != b.cls || distance > least) continue;
            nearest = n;
            least = distance;
        }
        if (nearest == now.end()) {
            ++changes.gone;
            continue;
        }
        changes.moved += isMoved(b, *nearest) ? 1 : 0;
        now.erase(nearest);
    }
    changes.fresh = now.size();
    return changes;
}

/// The boxes of a result, scan by scan.
class Boxes {
  public:
    Boxes(const Database& database, std::int64_t result)
        : rows_(database.prepare("SELECT scan_index, class, x, y, z, length, width, height, yaw FROM obstacles "
                                 "WHERE result = ? ORDER BY scan_index, rowid")) {
        rows_.bind(0, result);
        more_ = rows_.step();
    }

    /// The next scan that has boxes; -1: none.
    std::int64_t scan() const { return more_ ? rows_.integer(0) : -1; }
    /// Its boxes, and goes on.
    std::vector<Box> take() {
        std::vector<Box> boxes;
        for (const std::int64_t at = scan(); more_ && rows_.integer(0) == at; more_ = rows_.step())
            boxes.push_back({rows_.text(1), rows_.real(2), rows_.real(3), rows_.real(4), rows_.real(5), rows_.real(6),
                             rows_.real(7), rows_.real(8)});
        return boxes;
    }

  private:
    Statement rows_;
    bool more_ = false;
};

/// Goes through both in step.
void compareBoxes(Boxes before, Boxes now, Change& change) {
    std::size_t worst = 0;
    while (before.scan() >= 0 || now.scan() >= 0) {
        std::int64_t at = before.scan() < 0 ? now.scan() : before.scan();
        if (now.scan() >= 0) at = std::min(at, now.scan());
        const std::vector<Box> then = before.scan() == at ? before.take() : std::vector<Box>();
        const BoxChanges c = changesOf(then, now.scan() == at ? now.take() : std::vector<Box>());
        change.scans_changed += c.sum() > 0 ? 1 : 0;
        change.boxes.gone += c.gone;
        change.boxes.fresh += c.fresh;
        change.boxes.moved += c.moved;
        if (c.sum() <= worst) continue;
        worst = c.sum();
        change.worst_scan = static_cast<std::size_t>(at);
    }
}

std::string aboutOf(const Database& database, const std::string& name) {
    auto row = database.prepare("SELECT value FROM about WHERE name = ?");
    row.bind(0, name);
    return row.step() ? row.text(0) : "";
}

std::size_t countOf(const Database& database, const std::string& sql) {
    auto row = database.prepare(sql);
    row.step();
    return static_cast<std::size_t>(row.integer(0));
}

/// "section.key" and value of each line of a config file, without what is a comment.
std::map<std::string, std::string> valuesIn(const std::string& config) {
    std::map<std::string, std::string> values;
    std::istringstream in(config);
    std::string section;
    for (std::string line; std::getline(in, line);) {
        line = apps::trimmed(line.substr(0, std::min(line.find('#'), line.find("//"))));
        const auto equals = line.find('=');
        if (!line.empty() && line.front() == '[')
            section = line.substr(1, line.size() - 2);
        else if (equals != std::string::npos)
            values[section + '.' + apps::trimmed(line.substr(0, equals))] = apps::trimmed(line.substr(equals + 1));
    }
    return values;
}

std::vector<std::string> changedParameters(const std::string& before, const std::string& now) {
    const auto old_values = valuesIn(before);
    auto new_values = valuesIn(now);
    std::vector<std::string> changed;
    for (const auto& [name, value] : old_values) {
        const auto at = new_values.find(name);
        if (at == new_values.end())
            changed.push_back(name + ": " + value + " -> not there any more");
        else if (at->second != value)
            changed.push_back(name + ": " + value + " -> " + at->second);
    }
    for (const auto& [name, value] : new_values)
        if (old_values.count(name) == 0) changed.push_back(name + ": not there -> " + value);
    return changed;
}

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

/// The columns of a pair of results of the same content.
constexpr const char* kPairs =
    "SELECT n.result, o.result, (SELECT min(name) FROM main.recordings r WHERE r.result = n.result), o.status, "
    "n.status, o.scans, n.scans, o.tracks, n.tracks, n.obstacles_sha256 = o.obstacles_sha256 AND n.status = o.status "
    "FROM main.results n JOIN old.results o USING(sha256) ORDER BY n.result";

Change changeOf(const Statement& pair) {
    const auto count = [&](int column) { return static_cast<std::size_t>(pair.integer(column)); };
    Change change;
    change.name = pair.text(2);
    change.before = pair.text(3);
    change.now = pair.text(4);
    change.scans_before = count(5);
    change.scans_now = count(6);
    change.tracks_before = count(7);
    change.tracks_now = count(8);
    return change;
}

/// What is said of the two as a whole. @param both  the run of now, with the baseline attached as `old`.
Drift overview(const Database& both, const Database& before) {
    Drift drift;
    drift.baseline = before.file().string();
    drift.version = aboutOf(before, "version");
    drift.parameters = aboutOf(before, "parameters");
    drift.options = linesOf(aboutOf(before, "options"));
    drift.parameters_changed = changedParameters(drift.parameters, aboutOf(both, "parameters"));
    drift.only_now =
        countOf(both, "SELECT count(*) FROM main.results WHERE sha256 NOT IN (SELECT sha256 FROM old.results)");
    drift.only_before =
        countOf(both, "SELECT count(*) FROM old.results WHERE sha256 NOT IN (SELECT sha256 FROM main.results)");
    drift.has_boxes =
        countOf(both, "SELECT EXISTS(SELECT 1 FROM main.obstacles) AND EXISTS(SELECT 1 FROM old.obstacles)") > 0;
    return drift;
}

}  // namespace

void requireBaseline(const fs::path& baseline) {
    try {
        const Database database(baseline, Database::Mode::Read);
        for (const char* table : {"about", "recordings", "results", "obstacles"})
            database.prepare(std::string("SELECT * FROM ") + table);
    } catch (const std::exception& e) {
        throw std::runtime_error(std::string(e.what()) + ": --baseline wants fleet.sqlite of another `merge`");
    }
}

Drift driftBetween(const fs::path& now, const fs::path& baseline) {
    const Database before(baseline, Database::Mode::Read);
    const Database both(now, Database::Mode::Read);
    auto attach = both.prepare("ATTACH ? AS old");
    attach.bind(0, std::string_view(baseline.native()));
    attach.run();
    Drift drift = overview(both, before);
    auto pair = both.prepare(kPairs);
    while (pair.step()) {
        if (pair.integer(9) != 0) {
            ++drift.same;
            continue;
        }
        Change change = changeOf(pair);
        if (drift.has_boxes) compareBoxes({before, pair.integer(1)}, {both, pair.integer(0)}, change);
        drift.changes.push_back(change);
    }
    std::stable_sort(drift.changes.begin(), drift.changes.end(), [](const Change& a, const Change& b) {
        return std::make_tuple(b.before != b.now, b.boxes.gone + b.boxes.fresh, b.boxes.moved) <
               std::make_tuple(a.before != a.now, a.boxes.gone + a.boxes.fresh, a.boxes.moved);
    });
    return drift;
}

}  // namespace lidar_obstacles::fleet
