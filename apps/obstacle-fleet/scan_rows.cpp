// SPDX-License-Identifier: BSD-3-Clause
#include "scan_rows.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/number_text.h"
#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"

namespace lidar_obstacles::fleet {
namespace {

using apps::fixedText;

std::size_t indexOf(ObstacleClass cls) { return static_cast<std::size_t>(cls); }

double speedOf(const Obstacle& o) {
    return o.track && o.track->velocity && o.track->moving ? o.track->velocity->norm() : 0.0;
}

/// A number of a scan that may be strange.
struct Measure {
    const char* name;
    double usual;  ///< what two scans of an ordinary recording may differ by, as a share of the median ...
    double least;  ///< ... and at least
    std::function<double(const ScanRow&)> of;
};

double countOf(const ScanRow& row, ObstacleClass cls) { return static_cast<double>(row.obstacles[indexOf(cls)]); }

const std::vector<Measure>& measures() {
    static const std::vector<Measure> kMeasures = {
        {"returns", 0.01, 10.0, [](const ScanRow& s) { return static_cast<double>(s.returns); }},
        {"ground_percent", 0.01, 1.0, [](const ScanRow& s) { return s.ground_percent; }},
        {"road users", 0.05, 1.0,
         [](const ScanRow& s) {
             return countOf(s, ObstacleClass::Vehicle) + countOf(s, ObstacleClass::Pedestrian) +
                    countOf(s, ObstacleClass::Cyclist);
         }},
        {"structure", 0.05, 1.0, [](const ScanRow& s) { return countOf(s, ObstacleClass::Structure); }},
        {"unknown", 0.05, 1.0, [](const ScanRow& s) { return countOf(s, ObstacleClass::Unknown); }},
        {"rejected", 0.05, 1.0, [](const ScanRow& s) { return static_cast<double>(s.rejected); }},
        {"fastest", 0.05, 2.0, [](const ScanRow& s) { return s.fastest; }}};
    return kMeasures;
}

double medianOf(std::vector<double> numbers) {
    const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
    std::nth_element(numbers.begin(), middle, numbers.end());
    return *middle;
}

std::size_t mostFrequent(const std::array<std::size_t, kClassCount>& classes) {
    return static_cast<std::size_t>(std::max_element(classes.begin(), classes.end()) - classes.begin());
}

}  // namespace

ScanRow toRow(std::size_t scan_index, const SequenceResult& found) {
    const DetectionResult& d = found.detection;
    ScanRow row;
    row.scan_index = scan_index;
    row.timestamp = found.cloud.timestamp;
    row.returns = found.cloud.size();
    const auto ground =
        std::count_if(d.ground.is_ground.begin(), d.ground.is_ground.end(), [](auto g) { return g != 0; });
    if (row.returns > 0) row.ground_percent = 100.0 * static_cast<double>(ground) / static_cast<double>(row.returns);
    for (const Obstacle& o : d.obstacles) {
        ++row.obstacles[indexOf(o.cls)];
        row.fastest = std::max(row.fastest, speedOf(o));
    }
    row.rejected = d.clusters.rejected.size();
    return row;
}

ScanTimes toTimes(std::size_t scan_index, const DetectionResult& found) {
    ScanTimes times;
    times.scan_index = scan_index;
    for (const StageTime& t : found.timing) {
        if (t.ms <= times.slowest_stage_ms) continue;
        times.slowest_stage = t.stage;
        times.slowest_stage_ms = t.ms;
    }
    return times;
}

void addTracks(const ScanRow& scan, const std::vector<Obstacle>& obstacles, std::map<int, TrackRow>& tracks) {
    for (const Obstacle& o : obstacles) {
        if (!o.track) continue;
        const auto [at, is_new] = tracks.try_emplace(o.id);
        TrackRow& t = at->second;
        const double distance = distanceTo(o.box);
        if (is_new) {
            t.first_scan = scan.scan_index;
            t.first_time = scan.timestamp;
            t.nearest = distance;
        }
        ++t.classes[indexOf(o.cls)];
        t.last_scan = scan.scan_index;
        t.last_time = scan.timestamp;
        t.scans_seen += o.track->seen ? 1 : 0;
        t.nearest = std::min(t.nearest, distance);
        t.fastest = std::max(t.fastest, speedOf(o));
        t.probability += static_cast<double>(probabilityOf(o));
    }
}

void findStrange(std::vector<ScanRow>& scans) {
    constexpr double kNormal = 1.4826;  // median distance to standard deviation, of the normal distribution
    constexpr std::size_t kFewest = 5;
    if (scans.size() < kFewest) return;
    for (const Measure& m : measures()) {
        std::vector<double> numbers(scans.size());
        std::transform(scans.begin(), scans.end(), numbers.begin(), m.of);
        const double median = medianOf(numbers);
        std::transform(numbers.begin(), numbers.end(), numbers.begin(), [&](double n) { return std::abs(n - median); });
        const double spread = std::max({kNormal * medianOf(numbers), m.least, m.usual * median});
        for (std::size_t k = 0; k < scans.size(); ++k) {
            const double strangeness = numbers[k] / spread;
            if (strangeness <= scans[k].strangeness) continue;
            scans[k].strangeness = strangeness;
            scans[k].strange_by = m.name;
        }
    }
}

std::string scansCsv(const std::vector<ScanRow>& scans) {
    std::string text =
        "scan_index,timestamp,returns,ground_percent,vehicles,pedestrians,cyclists,structure,unknown,rejected,fastest,"
        "strangeness,strange_by\n";
    for (const ScanRow& s : scans) {
        text += std::to_string(s.scan_index) + ',' + fixedText(s.timestamp, 6) + ',' + std::to_string(s.returns) + ',' +
                fixedText(s.ground_percent, 2);
        for (const ObstacleClass cls : {ObstacleClass::Vehicle, ObstacleClass::Pedestrian, ObstacleClass::Cyclist,
                                        ObstacleClass::Structure, ObstacleClass::Unknown})
            text += ',' + std::to_string(s.obstacles[indexOf(cls)]);
        text += ',' + std::to_string(s.rejected) + ',' + fixedText(s.fastest, 2) + ',' + fixedText(s.strangeness, 2) +
                ',' + s.strange_by + '\n';
    }
    return text;
}

std::string tracksCsv(const std::map<int, TrackRow>& tracks) {
    std::string text =
        "id,class,first_scan,last_scan,first_time,last_time,scans,scans_seen,nearest,fastest,probability\n";
    for (const auto& [id, t] : tracks) {
        std::size_t scans = 0;
        for (const std::size_t n : t.classes) scans += n;
        text += std::to_string(id) + ',' + toString(static_cast<ObstacleClass>(mostFrequent(t.classes))) + ',' +
                std::to_string(t.first_scan) + ',' + std::to_string(t.last_scan) + ',' + fixedText(t.first_time, 6) +
                ',' + fixedText(t.last_time, 6) + ',' + std::to_string(scans) + ',' + std::to_string(t.scans_seen) +
                ',' + fixedText(t.nearest, 3) + ',' + fixedText(t.fastest, 2) + ',' +
                fixedText(t.probability / static_cast<double>(scans), 4) + '\n';
    }
    return text;
}

std::string timingsCsv(const std::vector<ScanTimes>& times) {
    std::string text = "scan_index,read_ms,decode_ms,detect_ms,slowest_stage,slowest_stage_ms\n";
    for (const ScanTimes& t : times)
        text += std::to_string(t.scan_index) + ',' + fixedText(t.read_ms, 3) + ',' + fixedText(t.decode_ms, 3) + ',' +
                fixedText(t.detect_ms, 3) + ',' + t.slowest_stage + ',' + fixedText(t.slowest_stage_ms, 3) + '\n';
    return text;
}

}  // namespace lidar_obstacles::fleet
