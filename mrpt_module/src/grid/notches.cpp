// SPDX-License-Identifier: BSD-3-Clause
#include "grid/notches.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "scan/label_sets.h"
#include "scan/listed.h"
#include "scan/ring_profile.h"

namespace lidar_obstacles {
namespace {

constexpr std::size_t kFewest = 5;
constexpr float kRider = 2.5f;  ///< people, and bicycles with who rides them, are smaller and have notches [m]

/// A return of a piece.
struct Seen {
    std::int32_t index;
    int ring;
    int column;   ///< counted from opposite the piece's first return
    bool low;     ///< below windows
    bool listed;  ///< see isListed()
    ProfilePoint at;
    int run = 0;  ///< returns of one ring without a cut between them
};

/// A piece's returns by ring and column; of one beam's the listed one comes first.
std::vector<std::int32_t> inRows(const std::vector<std::int32_t>& points, const PointCloud& cloud, int first_column) {
    std::vector<std::pair<std::int32_t, std::int32_t>> keys;
    keys.reserve(points.size());
    for (const std::int32_t i : points) {
        const int column = cloud.view.wrap(cloud.view.column_of[i] - first_column);
        const int place = cloud.ring[i] * cloud.view.columns + column;
        keys.emplace_back(2 * place + static_cast<int>(!isListed(cloud, i)), i);
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::int32_t> rows;
    rows.reserve(keys.size());
    for (const auto& [key, i] : keys) rows.push_back(i);
    return rows;
}

/// By ring and column. Empty where the piece goes too far around the sensor to be looked at as a whole.
std::vector<Seen> seenFrom(const std::vector<std::int32_t>& points, const PointCloud& cloud,
                           const std::vector<float>& height) {
    Eigen::Vector2f ahead = Eigen::Vector2f::Zero();
    for (const std::int32_t i : points) ahead += (cloud.xyz[i] - cloud.originOf(i)).head<2>();
    ahead.normalize();
    const int behind = cloud.view.wrap(cloud.view.column_of[points.front()] - cloud.view.columns / 2);
    std::vector<Seen> seen;
    seen.reserve(points.size());
    for (const std::int32_t i : inRows(points, cloud, behind)) {
        const auto point = profilePointOf((cloud.xyz[i] - cloud.originOf(i)).head<2>(), ahead);
        if (!point) return {};
        const int column = cloud.view.wrap(cloud.view.column_of[i] - behind);
        seen.push_back({i, cloud.ring[i], column, height[i] < kBelowWindows, isListed(cloud, i), *point});
    }
    return seen;
}

using Iterator = std::vector<Seen>::iterator;

/// Numbers the runs of one ring, from `next` on; notes pairs of runs with a cut between them that is believed. A
/// further return of a beam, through leaves or off an edge, is of the run of the one that is
/// listed, or of the one before where that is not in the piece.
int cutRing(Iterator begin, Iterator end, int next, std::vector<std::pair<int, int>>& cuts) {
    std::vector<Seen*> line;
    for (Iterator k = begin; k != end; ++k) {
        k->run = next;
        if (k->listed) line.push_back(&*k);
    }
    const auto jumps = [](const Seen* a, const Seen* b) { return std::abs(a->at.range - b->at.range) > kNotchDepth; };
    if (std::adjacent_find(line.begin(), line.end(), jumps) == line.end()) return next + 1;
    std::vector<ProfilePoint> profile;
    profile.reserve(line.size());
    for (const Seen* s : line) profile.push_back(s->at);
    const std::vector<float> depth = depthsOf(profile);
    for (std::size_t k = 1; k < line.size(); ++k) {
        const Seen& before = *line[k - 1];
        Seen& here = *line[k];
        const bool cut =
            here.column - before.column <= kNeighbourColumns && notchBetween(profile, depth, k) > kNotchDepth;
        if (cut && before.low && here.low) cuts.emplace_back(next, next + 1);
        here.run = cut ? ++next : next;
    }
    for (Iterator k = std::next(begin); k != end; ++k)
        if (!k->listed) k->run = std::prev(k)->run;
    return next + 1;
}

/// Joins runs of different rings that are above each other: where most of the columns that both hit show one surface.
void joinUpright(std::vector<Seen> seen, LabelSets& sets) {
    std::sort(seen.begin(), seen.end(), [](const Seen& a, const Seen& b) {
        return a.column != b.column ? a.column < b.column : a.ring != b.ring ? a.ring < b.ring : a.index < b.index;
    });
    std::map<std::pair<int, int>, std::pair<int, int>> columns;  // of two runs: that both hit, that show one surface
    for (std::size_t k = 1; k < seen.size(); ++k) {
        const Seen &a = seen[k - 1], &b = seen[k];
        if (a.column != b.column || a.run == b.run) continue;
        auto& [both, one] = columns[std::minmax(a.run, b.run)];
        ++both;
        one += static_cast<int>(std::abs(a.at.range - b.at.range) <= kNotchDepth);
    }
    for (const auto& [runs, count] : columns)
        if (2 * count.second >= count.first) sets.join(runs.first, runs.second);
}

/// The parts of a piece; those that are few or have no cut beside them go to the nearest other one.
std::vector<std::vector<Seen>> partsOf(const std::vector<Seen>& seen, const std::vector<std::pair<int, int>>& cuts,
                                       LabelSets& sets) {
    std::map<int, std::vector<Seen>> of_set;
    for (const Seen& s : seen) of_set[sets.find(s.run)].push_back(s);
    std::map<int, bool> cut;
    for (const auto& [a, b] : cuts)
        if (const int p = sets.find(a), q = sets.find(b); p != q) cut[p] = cut[q] = true;
    std::vector<std::vector<Seen>> parts, loose;
    for (auto& [set, members] : of_set)
        (cut.count(set) > 0 && members.size() >= kFewest ? parts : loose).push_back(std::move(members));
    if (parts.size() < 2) return {};
    const std::vector<std::vector<Seen>> cores = parts;
    for (const std::vector<Seen>& l : loose) {
        const ProfilePoint& a = l[l.size() / 2].at;
        const auto distance = [&a](const std::vector<Seen>& core) {
            constexpr std::size_t kLooked = 4096;  // of more, every k-th: pieces of leaves have thousands of parts
            const std::size_t stride = 1 + core.size() / kLooked;
            float least = std::numeric_limits<float>::max();
            for (std::size_t k = 0; k < core.size(); k += stride)
                least = std::min(least, std::abs(a.range - core[k].at.range) + a.range * std::abs(a.u - core[k].at.u));
            return least;
        };
        std::size_t nearest = 0;
        float least = distance(cores[0]);
        for (std::size_t k = 1; k < cores.size(); ++k)
            if (const float d = distance(cores[k]); d < least) least = d, nearest = k;
        parts[nearest].insert(parts[nearest].end(), l.begin(), l.end());
    }
    return parts;
}

/// Diagonal of its bounds, seen from above [m].
float extentOf(const Cluster& piece, const PointCloud& cloud) {
    Eigen::AlignedBox2f box;
    for (const std::int32_t i : piece.points) box.extend(cloud.xyz[i].head<2>());
    return box.diagonal().norm();
}

/// Which pieces have a ring that jumps below windows: only these may have a notch.
std::vector<bool> withJumps(const std::vector<Cluster>& pieces, const PointCloud& cloud,
                            const std::vector<float>& height) {
    std::vector<std::int32_t> piece_of(cloud.size(), -1);
    std::vector<float> range(cloud.size(), 0.0f);
    for (std::size_t k = 0; k < pieces.size(); ++k)
        for (const std::int32_t i : pieces[k].points) {
            if (height[i] >= kBelowWindows) continue;
            piece_of[i] = static_cast<std::int32_t>(k);
            range[i] = (cloud.xyz[i] - cloud.originOf(i)).head<2>().norm();
        }
    std::vector<bool> jumps(pieces.size(), false);
    const int columns = cloud.view.columns;
    for (int ring = 0; ring < cloud.view.rings; ++ring) {
        std::int32_t before = -1;
        int at = -kNeighbourColumns - 1;
        for (int column = 0; column < columns + kNeighbourColumns; ++column) {
            const std::int32_t i = cloud.view.at(ring, cloud.view.wrap(column));
            if (i < 0 || piece_of[i] < 0) continue;
            if (column - at <= kNeighbourColumns && piece_of[i] == piece_of[before] &&
                std::abs(range[i] - range[before]) > kNotchDepth)
                jumps[static_cast<std::size_t>(piece_of[i])] = true;
            before = i;
            at = column;
        }
    }
    return jumps;
}

/// Did one sensor see all of it? Ranges of several are from different places.
bool isOfOneSensor(const Cluster& piece, const PointCloud& cloud) {
    if (cloud.sensors.empty()) return true;
    const std::size_t first = cloud.sensorOf(piece.points.front());
    return std::all_of(piece.points.begin(), piece.points.end(),
                       [&](std::int32_t i) { return cloud.sensorOf(i) == first; });
}

/// Empty: it is one.
std::vector<std::vector<Seen>> partsOf(const Cluster& piece, const PointCloud& cloud,
                                       const std::vector<float>& height) {
    if (piece.points.size() < 2 * kFewest || extentOf(piece, cloud) < kRider || !isOfOneSensor(piece, cloud)) return {};
    std::vector<Seen> seen = seenFrom(piece.points, cloud, height);
    std::vector<std::pair<int, int>> cuts;
    int runs = 0;
    for (auto begin = seen.begin(); begin != seen.end();) {
        const auto end =
            std::find_if(begin, seen.end(), [ring = begin->ring](const Seen& s) { return s.ring != ring; });
        runs = cutRing(begin, end, runs, cuts);
        begin = end;
    }
    if (cuts.empty()) return {};
    LabelSets sets(runs);
    joinUpright(seen, sets);
    return partsOf(seen, cuts, sets);
}

}  // namespace

std::vector<Cluster> partedAtNotches(std::vector<Cluster> pieces, const PointCloud& cloud,
                                     const std::vector<float>& height) {
    if (cloud.view.empty()) return pieces;
    std::vector<Cluster> parted;
    parted.reserve(pieces.size());
    const std::vector<bool> jumps = withJumps(pieces, cloud, height);
    for (std::size_t k = 0; k < pieces.size(); ++k) {
        std::vector<std::vector<Seen>> parts;
        if (jumps[k]) parts = partsOf(pieces[k], cloud, height);
        if (parts.empty()) parted.push_back(std::move(pieces[k]));
        for (const std::vector<Seen>& part : parts) {
            parted.emplace_back();
            for (const Seen& s : part) parted.back().points.push_back(s.index);
            std::sort(parted.back().points.begin(), parted.back().points.end());
        }
    }
    return parted;
}

}  // namespace lidar_obstacles
