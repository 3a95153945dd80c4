// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/evaluation/metrics.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "quantile.h"
#include "tracks.h"

namespace lidar_obstacles::evaluation {
namespace {

constexpr double kDegrees = 180.0 / M_PI;

double share(std::size_t part, std::size_t whole) {
    return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

/// Collects one number of each row that was found.
template <class Get>
std::vector<double> collect(const std::vector<const BoxErrors*>& errors, Get&& get) {
    std::vector<double> values;
    values.reserve(errors.size());
    for (const BoxErrors* e : errors) values.push_back(get(*e));
    return values;
}

template <class Is>
double shareOf(const std::vector<const BoxErrors*>& errors, Is&& is) {
    const auto n = std::count_if(errors.begin(), errors.end(), [&](const BoxErrors* e) { return is(*e); });
    return share(static_cast<std::size_t>(n), errors.size());
}

std::pair<double, double> meanAndMedian(std::vector<double> values) {
    if (values.empty()) return {0.0, 0.0};
    std::sort(values.begin(), values.end());
    double sum = 0.0;
    for (const double v : values) sum += v;
    return {sum / static_cast<double>(values.size()), sortedQuantile(values, 0.5)};
}

void addHeadings(const std::vector<const BoxErrors*>& found, GroupMetrics& m) {
    std::vector<const BoxErrors*> headings;
    std::copy_if(found.begin(), found.end(), std::back_inserter(headings),
                 [](const BoxErrors* e) { return e->heading_valid; });
    m.heading_valid = share(headings.size(), found.size());
    m.heading_180 = statisticsOf(collect(headings, [](const BoxErrors& e) { return kDegrees * e.heading_180; }));
    m.heading_90 = statisticsOf(collect(headings, [](const BoxErrors& e) { return kDegrees * e.heading_90; }));
    m.over_20_deg = shareOf(headings, [](const BoxErrors& e) { return std::abs(e.heading_180) > 20.0 / kDegrees; });
    m.swap_rate = shareOf(headings, [](const BoxErrors& e) { return e.swapped; });
    m.flip_rate = shareOf(headings, [](const BoxErrors& e) { return e.flipped; });
}

void addVelocities(const std::vector<const BoxErrors*>& found, GroupMetrics& m) {
    std::vector<double> errors;
    for (const BoxErrors* e : found)
        if (e->velocity) errors.push_back(*e->velocity);
    m.velocity = statisticsOf(errors);
}

/// All counted rows, with objects numbered over all sets.
struct Rows {
    std::map<Group, std::vector<CountedRow>> by_group;
    std::map<Group, std::map<int, std::vector<CountedRow>>> by_bin;  ///< key: RangeBin::from
    std::vector<CountedRow> target;
};

Rows collectRows(const std::vector<SetResult>& sets) {
    Rows rows;
    std::map<std::pair<std::size_t, std::string>, std::size_t> numbers;
    for (std::size_t s = 0; s < sets.size(); ++s) {
        for (const ObjectRecord& r : sets[s].records) {
            if (!r.counted) continue;
            const std::size_t number = numbers.try_emplace({s, r.object.object_id}, numbers.size()).first->second;
            const CountedRow row{&r, number};
            rows.by_group[r.object.group].push_back(row);
            rows.by_bin[r.object.group][rangeBinOf(r.object.range).from].push_back(row);
            if (!sets[s].target_id.empty() && r.object.object_id == sets[s].target_id) rows.target.push_back(row);
        }
    }
    return rows;
}

void addUnmatched(const SetResult& set, Metrics& m) {
    for (const UnmatchedDetection& u : set.unmatched) {
        ++m.unmatched[u.cause];
        const bool on_nothing = u.cause != "ignored" && u.cause != "fragment";
        if (on_nothing && u.detection.group != Group::Other) {
            ++m.classified_on_nothing[u.cause + ':' + toString(u.detection.group)];
        }
    }
}

void addTypes(const SetResult& set, Metrics& m) {
    for (const ObjectRecord& r : set.records) {
        if (!r.counted) continue;
        auto& [asked, found] = m.found_by_type[r.object.type];
        ++asked;
        if (!r.detection) continue;
        ++found;
        ++m.class_of_matched[r.object.type][r.detection->cls];
    }
}

}  // namespace

ErrorStatistics statisticsOf(const std::vector<double>& errors) {
    ErrorStatistics s;
    s.count = errors.size();
    if (errors.empty()) return s;
    std::vector<double> absolute;
    double sum_of_squares = 0.0;
    for (const double e : errors) {
        s.mean += e;
        s.mean_abs += std::abs(e);
        sum_of_squares += e * e;
        absolute.push_back(std::abs(e));
    }
    const auto n = static_cast<double>(errors.size());
    s.mean /= n;
    s.mean_abs /= n;
    s.rmse = std::sqrt(sum_of_squares / n);
    std::sort(absolute.begin(), absolute.end());
    s.median_abs = sortedQuantile(absolute, 0.5);
    s.p95_abs = sortedQuantile(absolute, 0.95);
    return s;
}

const RangeBin& rangeBinOf(double range) {
    const auto it = std::find_if(kRangeBins.begin(), kRangeBins.end(),
                                 [&](const RangeBin& b) { return b.from <= range && range < b.to; });
    return it == kRangeBins.end() ? kRangeBins.back() : *it;
}

GroupMetrics summariseRows(const std::vector<CountedRow>& rows, const BootstrapOptions& bootstrap) {
    GroupMetrics m;
    std::set<std::size_t> objects;
    std::vector<const BoxErrors*> found;
    for (const CountedRow& row : rows) {
        objects.insert(row.object);
        if (row.record->errors) found.push_back(&*row.record->errors);
    }
    m.asked = rows.size();
    m.found = found.size();
    m.objects = objects.size();
    m.face = statisticsOf(collect(found, [](const BoxErrors& e) { return e.face; }));
    m.centre = statisticsOf(collect(found, [](const BoxErrors& e) { return e.centre; }));
    m.dz = statisticsOf(collect(found, [](const BoxErrors& e) { return e.dz; }));
    m.length = statisticsOf(collect(found, [](const BoxErrors& e) { return e.length; }));
    m.width = statisticsOf(collect(found, [](const BoxErrors& e) { return e.width; }));
    m.height = statisticsOf(collect(found, [](const BoxErrors& e) { return e.height; }));
    std::tie(m.bev_iou_mean, m.bev_iou_median) =
        meanAndMedian(collect(found, [](const BoxErrors& e) { return e.bev_iou; }));
    std::tie(m.iou_3d_mean, m.iou_3d_median) =
        meanAndMedian(collect(found, [](const BoxErrors& e) { return e.iou_3d; }));
    addHeadings(found, m);
    addVelocities(found, m);
    m.intervals = bootstrapOverObjects(rows, bootstrap);
    return m;
}

double Metrics::falsePerScan() const {
    std::size_t n = 0;
    for (const char* cause : {"phantom", "overhead"}) n += unmatched.count(cause) != 0 ? unmatched.at(cause) : 0;
    return share(n, scans);
}

Metrics summarise(const std::vector<SetResult>& sets, const BootstrapOptions& bootstrap) {
    Metrics m;
    std::size_t with_target = 0;
    for (const SetResult& set : sets) {
        m.scans += set.scans;
        m.detections += set.detections;
        m.detections_without_scan += set.detections_without_scan;
        addUnmatched(set, m);
        addTypes(set, m);
        addTracks(set, m.tracks);
        m.tracking.add(set.tracking);
        if (!set.target_id.empty()) ++with_target;
    }
    const Rows rows = collectRows(sets);
    for (const Group group : kGroups) {
        const auto it = rows.by_group.find(group);
        m.groups[group] = summariseRows(it == rows.by_group.end() ? std::vector<CountedRow>{} : it->second, bootstrap);
    }
    for (const auto& [group, bins] : rows.by_bin) {
        for (const auto& [from, in_bin] : bins) {
            m.bins[group].push_back({rangeBinOf(from), summariseRows(in_bin, bootstrap)});
        }
    }
    if (with_target > 0) m.target = summariseRows(rows.target, bootstrap);
    return m;
}

}  // namespace lidar_obstacles::evaluation
