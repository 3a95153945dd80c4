// SPDX-License-Identifier: BSD-3-Clause
#include "scan_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "asked.h"

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

/// Puts the rows of truth and poses into their scans. @return the place of each scan_index.
std::map<int, std::size_t> placeTruth(const LabelledSet& set, const std::vector<double>& times,
                                      std::vector<Scan>& scans) {
    std::map<int, std::size_t> place_of_index;
    const auto name = [&](int scan_index, std::size_t k) {
        place_of_index[scan_index] = k;
        scans[k].scan_index = scan_index;
    };
    for (const TruthObject& o : set.truth) {
        const std::size_t k = placeOf(times, o.timestamp);
        scans[k].objects.push_back(o);
        name(o.scan_index, k);
    }
    for (const EgoPose& p : set.ego) {
        if (place_of_index.count(p.scan_index) == 0) name(p.scan_index, placeOf(times, p.timestamp));
    }
    for (std::size_t k = 0; k < times.size(); ++k) scans[k].timestamp = times[k];
    return place_of_index;
}

void leaveOut(const EvaluationOptions& options, std::vector<Scan>& scans) {
    const double first = scans.front().timestamp;
    const auto isOut = [&](const Scan& s) {
        const auto claims = [&](const Detection& d) { return isClaim(d, options); };
        const bool any = std::any_of(s.detections.begin(), s.detections.end(), claims);
        return s.timestamp - first < options.skip_first || (options.only_scans_with_detections && !any);
    };
    scans.erase(std::remove_if(scans.begin(), scans.end(), isOut), scans.end());
}

}  // namespace

ScanTable tabulateScans(const LabelledSet& set, const EvaluationOptions& options) {
    const std::vector<double> times = scanTimes(set);
    if (times.empty()) throw std::runtime_error(set.name + ": the truth has no scans");
    ScanTable table;
    table.scans.resize(times.size());
    const std::map<int, std::size_t> place_of_index = placeTruth(set, times, table.scans);
    for (const Detection& d : set.detections) {
        std::optional<std::size_t> k;
        const auto named = place_of_index.find(d.scan_index);
        if (!options.match_by_index) {
            k = nearestScan(times, d.timestamp, options.time_tolerance);
        } else if (named != place_of_index.end()) {
            k = named->second;
        }
        if (k)
            table.scans[*k].detections.push_back(d);
        else if (isClaim(d, options))
            ++table.lost;
    }
    leaveOut(options, table.scans);
    return table;
}

}  // namespace lidar_obstacles::evaluation
