// SPDX-License-Identifier: BSD-3-Clause
#include "merge.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <unordered_map>

#include "common/csv_cell.h"
#include "common/obstacles_csv.h"
#include "common/text_file.h"
#include "csv_rows.h"
#include "database.h"
#include "drift.h"
#include "manifest.h"
#include "replays.h"
#include "report.h"
#include "scan_rows.h"
#include "store.h"

namespace lidar_obstacles::fleet {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTables =
    "CREATE TABLE about(name TEXT PRIMARY KEY, value TEXT);"
    "CREATE TABLE recordings(name TEXT PRIMARY KEY, bytes INTEGER, sha256 TEXT, result INTEGER);"
    "CREATE TABLE results(result INTEGER PRIMARY KEY, key TEXT, sha256 TEXT, status TEXT, scans INTEGER, "
    "returns INTEGER, tracks INTEGER, obstacles_sha256 TEXT, remarks TEXT);"
    "CREATE TABLE failures(name TEXT, sha256 TEXT, status TEXT, reason TEXT);";
constexpr const char* kIndexes =
    "CREATE INDEX results_by_content ON results(sha256); CREATE INDEX scans_by_result ON scans(result, scan_index);"
    "CREATE INDEX obstacles_by_result ON obstacles(result, scan_index); CREATE INDEX tracks_by_result ON "
    "tracks(result);"
    "CREATE INDEX recordings_by_result ON recordings(result);";

/// What came of a piece of work, as far as it is known.
struct Known {
    std::int64_t result = 0;  ///< its number; 0: nothing came of it yet
    std::string status;
    std::string reason;
};

class Merge {
  public:
    Merge(const MergeOptions& options, const Manifest& manifest)
        : options_(options),
          manifest_(manifest),
          store_(options.output),
          all_(options.into / "fleet.sqlite.part", Database::Mode::New),
          times_(options.into / "timings.sqlite.part", Database::Mode::New) {}

    MergeReport run() {
        begin();
        tables_.emplace(all_, times_);
        auto recording = all_.prepare("INSERT INTO recordings VALUES(?,?,?,?)");
        for (const Recording& r : manifest_.recordings) {
            const Known known = r.error.empty() ? knownOf(r) : Known{0, "failed", r.error};
            recording.bind(0, r.name);
            recording.bind(1, static_cast<std::int64_t>(r.stamp.bytes));
            recording.bind(2, r.sha256);
            known.result == 0 ? recording.bindNull(3) : recording.bind(3, known.result);
            recording.run();
            if (known.status != "done") addFailure(r, known);
        }
        report_.recordings = manifest_.recordings.size();
        tables_.reset();
        all_.run(kIndexes);
        all_.run("COMMIT");
        times_.run("CREATE INDEX timings_by_result ON timings(result, scan_index); COMMIT");
        apps::writeTextFile(options_.into / "failures.csv", failures_csv_);
        return report_;
    }

  private:
    void begin() {
        all_.run(std::string("BEGIN;") + kTables);
        createTable(all_, "scans", scansCsv({}));
        createTable(all_, "obstacles", apps::csvHeader());
        createTable(all_, "tracks", tracksCsv({}));
        times_.run("BEGIN");
        createTable(times_, "timings", timingsCsv({}));
        auto about = all_.prepare("INSERT INTO about VALUES(?,?)");
        const Settings& s = manifest_.settings;
        std::string words;
        for (const std::string& word : s.input_options) words += word + '\n';
        for (const auto& [name, value] : {std::pair<std::string, std::string>("version", s.version),
                                          {"files", s.files},
                                          {"options", words},
                                          {"parameters", s.parameters}}) {
            about.bind(0, name);
            about.bind(1, value);
            about.run();
        }
    }

    /// Each piece of work comes into the tables once, however many recordings have its content.
    const Known& knownOf(const Recording& r) {
        const auto [at, is_new] = known_.try_emplace(r.key);
        if (is_new) at->second = read(r);
        return at->second;
    }

    Known read(const Recording& r) {
        const fs::path folder = store_.resultOf(r.key);
        std::error_code ignored;
        if (!fs::exists(folder / "result.json", ignored)) return {0, "missing", "is not done yet"};
        const Result result = store_.read(r.key);
        Known known{++results_, toString(result.status), result.reason};
        std::ifstream in(folder / "result.json");
        const auto json = nlohmann::json::parse(in);
        auto insert = all_.prepare("INSERT INTO results VALUES(?,?,?,?,?,?,?,?,?)");
        const std::string digest = json.value("obstacles_sha256", "");
        const std::string remarks = json.value("remarks", "");
        insert.bind(0, known.result);
        insert.bind(1, r.key);
        insert.bind(2, r.sha256);
        insert.bind(3, known.status);
        insert.bind(4, json.value("scans", std::int64_t{0}));
        insert.bind(5, json.value("returns", std::int64_t{0}));
        insert.bind(6, json.value("tracks", std::int64_t{0}));
        insert.bind(7, digest);
        insert.bind(8, remarks);
        insert.run();
        if (result.status != Status::Failed) addRows(folder, known.result);
        return known;
    }

    void addRows(const fs::path& folder, std::int64_t result) {
        report_.rows += tables_->scans.add(folder / "scans.csv", result);
        report_.rows += tables_->tracks.add(folder / "tracks.csv", result);
        report_.rows += tables_->timings.add(folder / "timings.csv", result);
        if (options_.with_obstacles) report_.rows += tables_->obstacles.add(folder / "obstacles.csv", result);
    }

    void addFailure(const Recording& r, const Known& known) {
        ++(known.status == "missing" ? report_.missing : report_.failed);
        auto insert = all_.prepare("INSERT INTO failures VALUES(?,?,?,?)");
        insert.bind(0, r.name);
        insert.bind(1, r.sha256);
        insert.bind(2, known.status);
        insert.bind(3, known.reason);
        insert.run();
        failures_csv_ += apps::csvCell(r.name) + ',' + known.status + ',' + apps::csvCell(known.reason) + '\n';
    }

    struct Tables {
        Tables(const Database& all, const Database& times)
            : scans(all, "scans", scansCsv({})),
              obstacles(all, "obstacles", apps::csvHeader()),
              tracks(all, "tracks", tracksCsv({})),
              timings(times, "timings", timingsCsv({})) {}
        RowInserter scans, obstacles, tracks, timings;
    };

    const MergeOptions& options_;
    const Manifest& manifest_;
    Store store_;
    Database all_, times_;
    std::optional<Tables> tables_;
    std::unordered_map<std::string, Known> known_;  ///< by key
    std::int64_t results_ = 0;
    std::string failures_csv_ = "name,status,reason\n";
    MergeReport report_;
};

void giveName(const fs::path& folder, const std::string& name) {
    std::error_code error;
    fs::rename(folder / (name + ".part"), folder / name, error);
    if (error) throw std::runtime_error((folder / name).string() + ": cannot write: " + error.message());
}

}  // namespace

MergeReport merge(const MergeOptions& options) {
    const Manifest manifest = readManifest(options.manifest);
    if (!options.baseline.empty()) requireBaseline(options.baseline);
    std::error_code ignored;
    fs::create_directories(options.into, ignored);  // SQLite says where it cannot write
    MergeReport report = Merge(options, manifest).run();
    giveName(options.into, "fleet.sqlite");
    giveName(options.into, "timings.sqlite");
    std::optional<Drift> drift;
    if (!options.baseline.empty()) {
        drift = driftBetween(options.into / "fleet.sqlite", options.baseline);
        report.changed = drift->changes.size();
        makeReplays(options, manifest.settings, *drift);
    }
    writeReports(options.into, drift ? &*drift : nullptr);
    return report;
}

}  // namespace lidar_obstacles::fleet
