// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// From counted rows to the figures of a table; several sets give one table.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lidar_obstacles/evaluation/bootstrap.h"
#include "lidar_obstacles/evaluation/evaluate.h"

namespace lidar_obstacles::evaluation {

/// Of a list of errors; `count == 0`: there were none and the others mean nothing.
struct ErrorStatistics {
    std::size_t count = 0;
    double mean = 0.0;  ///< of the signed errors, as the paper tells them (Sec. V)
    double mean_abs = 0.0;
    double median_abs = 0.0;
    double p95_abs = 0.0;
    double rmse = 0.0;
};

ErrorStatistics statisticsOf(const std::vector<double>& errors);

/// Figures of some rows: of a group, of a range bin, of the target. Means over no rows are 0 and mean nothing.
struct GroupMetrics {
    std::size_t asked = 0;  ///< rows counted: an object in a scan
    std::size_t found = 0;
    std::size_t objects = 0;  ///< different ones
    ErrorStatistics face;     ///< [m], as those below; see BoxErrors
    ErrorStatistics centre;
    ErrorStatistics dz;
    ErrorStatistics heading_180;  ///< [deg], of detections with a heading
    ErrorStatistics heading_90;   ///< [deg]
    ErrorStatistics length;
    ErrorStatistics width;
    ErrorStatistics height;
    ErrorStatistics velocity;  ///< along the vehicle's x axis [m/s], of detections that tell one
    double bev_iou_mean = 0.0;
    double bev_iou_median = 0.0;
    double iou_3d_mean = 0.0;
    double iou_3d_median = 0.0;
    double heading_valid = 0.0;  ///< share of the found with a heading; the next four: shares of those
    double over_20_deg = 0.0;    ///< off by more than 20 degrees, modulo 180
    double swap_rate = 0.0;      ///< length and width exchanged
    double flip_rate = 0.0;      ///< front and rear exchanged
    Intervals intervals;         ///< 95 %

    /// found / asked; 0 if nothing was asked for.
    double recall() const { return asked > 0 ? static_cast<double>(found) / static_cast<double>(asked) : 0.0; }
};

/// Distance of the nearest face [m]: from <= d < to; the last bin takes what is farther.
struct RangeBin {
    int from = 0;
    int to = 0;
};
constexpr std::array<RangeBin, 7> kRangeBins = {{{0, 5}, {5, 10}, {10, 15}, {15, 20}, {20, 30}, {30, 50}, {50, 100}}};

/// The bin that holds a range.
const RangeBin& rangeBinOf(double range);

struct BinMetrics {
    RangeBin bin;
    GroupMetrics metrics;
};

/// How well ids last over time.
struct TrackMetrics {
    std::size_t objects = 0;                 ///< found at least once
    std::optional<std::size_t> id_switches;  ///< nullopt: no id was seen in two scans
    std::size_t fragmentations = 0;          ///< found, lost, found again
};

struct Metrics {
    std::size_t scans = 0;
    std::size_t detections = 0;  ///< inside the region
    std::size_t detections_without_scan = 0;
    std::map<std::string, std::size_t> unmatched;              ///< by cause
    std::map<std::string, std::size_t> classified_on_nothing;  ///< `cause:group`, detections with a class
    std::map<std::string, std::pair<std::size_t, std::size_t>> found_by_type;    ///< (asked, found)
    std::map<std::string, std::map<std::string, std::size_t>> class_of_matched;  ///< type -> class -> rows
    TrackMetrics tracks;
    TrackingResult tracking;                        ///< classes, tracks and velocities as they were told
    std::map<Group, GroupMetrics> groups;           ///< all three
    std::map<Group, std::vector<BinMetrics>> bins;  ///< those with rows, by range
    std::optional<GroupMetrics> target;             ///< where the sets have one

    /// Unmatched detections on nothing at all (phantom, overhead) per scan.
    double falsePerScan() const;
};

/// The figures of all sets together. An object is one of (set, object_id).
Metrics summarise(const std::vector<SetResult>& sets, const BootstrapOptions& bootstrap);

/// The figures of rows that are chosen by the caller, e.g. those of one object.
GroupMetrics summariseRows(const std::vector<CountedRow>& rows, const BootstrapOptions& bootstrap);

}  // namespace lidar_obstacles::evaluation
