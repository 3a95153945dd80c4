#include "scan_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lidar_obstacles::evaluation {
namespace {

std::vector<double> scanTimes(const LabelledSet& set) {
    std::vector<double> times;
    for (const TruthObject& o : set.truth) times.push_back(o.timestamp);
    for (const EgoPose& p : set.ego) times.push_back(p.timestamp);
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
    return times;
}

std::size_t placeOf(const std::vector<double>& times, double time) {
    return static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time) - times.begin());
}

std::optional<std::size_t> nearestScan(const std::vector<double>& times, double time, double tolerance) {
    std::size_t k = std::min(placeOf(times, time), times.size() - 1);
    if (k > 0 && std::abs(times[k - 1] - time) <= std::abs(times[k] - time)) --k;
    if (std::abs(times[k] - time) > tolerance) return std::nullopt;
    return k;
}

}  // namespace

ScanTable tabulateScans(const LabelledSet& set, const EvaluationOptions& options) {
    const std::vector<double> times = scanTimes(set);
    if (times.empty()) throw std::runtime_error(set.name + ": the truth has no scans");
    ScanTable table;
    table.scans.resize(times.size());
    std::map<int, std::size_t> place_of_index;
    const auto name = [&](int scan_index, std::size_t k) {
        place_of_index[scan_index] = k;
        table.scans[k].scan_index = scan_index;
    };
    for (const TruthObject& o : set.truth) {
        const std::size_t k = placeOf(times, o.timestamp);
        table.scans[k].objects.push_back(o);
        name(o.scan_index, k);
    }
    for (const EgoPose& p : set.ego) {
        if (place_of_index.count(p.scan_index) == 0) name(p.scan_index, placeOf(times, p.timestamp));
    }
    for (std::size_t k = 0; k < times.size(); ++k) table.scans[k].timestamp = times[k];
    for (const Detection& d : set.detections) {
        if (!options.structure && d.cls == lidar_obstacles::toString(ObstacleClass::Structure)) continue;
        std::optional<std::size_t> k;
        const auto named = place_of_index.find(d.scan_index);
        if (!options.match_by_index) {
            k = nearestScan(times, d.timestamp, options.time_tolerance);
        } else if (named != place_of_index.end()) {
            k = named->second;
        }
        if (k)
            table.scans[*k].detections.push_back(d);
        else
            ++table.lost;
    }
    return table;
}

}  // namespace lidar_obstacles::evaluation
