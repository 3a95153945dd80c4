// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "lidar_obstacles/evaluation/box_overlap.h"
#include "tracking_judge.h"

namespace lidar_obstacles::evaluation {
namespace {

/// Numbers for names, in order of appearance.
class Numbers {
  public:
    Eigen::Index of(const std::string& name) {
        return known_.try_emplace(name, static_cast<Eigen::Index>(known_.size())).first->second;
    }
    Eigen::Index size() const { return static_cast<Eigen::Index>(known_.size()); }

  private:
    std::unordered_map<std::string, Eigen::Index> known_;
};

/// A scan in numbers.
struct ScanNumbers {
    std::vector<Eigen::Index> objects;
    std::vector<Eigen::Index> tracks;
    Eigen::MatrixXd similarity;  ///< objects x tracks
};

double similarityOf(const TruthObject& o, const Detection& d, JudgedGroup group) {
    if (group == JudgedGroup::Vehicle) return bevIou(o.box, d.box);
    return std::max(0.0, 1.0 - (o.box.center - d.box.center).head<2>().norm());
}

ScanNumbers numbersOf(const TrackedScan& scan, JudgedGroup group, Numbers& objects, Numbers& tracks) {
    ScanNumbers n;
    for (const TruthObject* o : scan.objects) n.objects.push_back(objects.of(o->object_id));
    for (const Detection* d : scan.boxes) n.tracks.push_back(tracks.of(d->id));
    n.similarity.resize(static_cast<Eigen::Index>(n.objects.size()), static_cast<Eigen::Index>(n.tracks.size()));
    for (Eigen::Index i = 0; i < n.similarity.rows(); ++i) {
        for (Eigen::Index j = 0; j < n.similarity.cols(); ++j)
            n.similarity(i, j) = similarityOf(*scan.objects[static_cast<std::size_t>(i)],
                                              *scan.boxes[static_cast<std::size_t>(j)], group);
    }
    return n;
}

/// How well each object and each track belong together over the whole recording, 0 .. 1 (the paper's eq. 9 without a
/// threshold, as TrackEval computes it).
struct Alignment {
    Eigen::MatrixXd of;             ///< objects x tracks
    Eigen::VectorXd scans_objects;  ///< in how many scans each is
    Eigen::VectorXd scans_tracks;

    Alignment(const std::vector<ScanNumbers>& scans, Eigen::Index objects, Eigen::Index tracks)
        : of(Eigen::MatrixXd::Zero(objects, tracks)),
          scans_objects(Eigen::VectorXd::Zero(objects)),
          scans_tracks(Eigen::VectorXd::Zero(tracks)) {
        for (const ScanNumbers& n : scans) add(n);
        for (Eigen::Index i = 0; i < objects; ++i) {
            for (Eigen::Index j = 0; j < tracks; ++j)
                of(i, j) /= std::max(1e-9, scans_objects[i] + scans_tracks[j] - of(i, j));
        }
    }

  private:
    void add(const ScanNumbers& n) {
        for (const Eigen::Index i : n.objects) scans_objects[i] += 1.0;
        for (const Eigen::Index j : n.tracks) scans_tracks[j] += 1.0;
        if (n.similarity.size() == 0) return;
        const Eigen::VectorXd of_object = n.similarity.rowwise().sum();
        const Eigen::RowVectorXd of_track = n.similarity.colwise().sum();
        for (Eigen::Index i = 0; i < n.similarity.rows(); ++i) {
            for (Eigen::Index j = 0; j < n.similarity.cols(); ++j) {
                const double s = n.similarity(i, j);
                const double all = of_object[i] + of_track[j] - s;
                if (all > 1e-9)
                    of(n.objects[static_cast<std::size_t>(i)], n.tracks[static_cast<std::size_t>(j)]) += s / all;
            }
        }
    }
};

/// Pairs of a scan: those that belong together over time first, then those that are alike.
IndexPairs pairsOf(const ScanNumbers& n, const Alignment& alignment) {
    Eigen::MatrixXd score = n.similarity;
    for (Eigen::Index i = 0; i < score.rows(); ++i) {
        for (Eigen::Index j = 0; j < score.cols(); ++j) {
            const double s = n.similarity(i, j);
            const double aligned =
                alignment.of(n.objects[static_cast<std::size_t>(i)], n.tracks[static_cast<std::size_t>(j)]);
            score(i, j) = aligned * s + (s > 0.0 ? 1e-12 : 0.0);
        }
    }
    return pairsOfLargestScore(score);
}

double thresholdOf(std::size_t k) { return 0.05 + 0.05 * static_cast<double>(k); }

/// In how many scans each object matches each track at one threshold.
using Matches = std::map<std::pair<Eigen::Index, Eigen::Index>, double>;
using MatchesByThreshold = std::array<Matches, HotaCounts::kThresholds>;

void countScan(const ScanNumbers& n, const IndexPairs& pairs, HotaCounts& counts, MatchesByThreshold& matches) {
    for (std::size_t k = 0; k < HotaCounts::kThresholds; ++k) {
        double found = 0.0;
        for (const auto& [i, j] : pairs) {
            const double s = n.similarity(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
            if (s < thresholdOf(k) - 1e-9) continue;
            found += 1.0;
            matches[k][{n.objects[i], n.tracks[j]}] += 1.0;
        }
        counts.found[k] += found;
        counts.missed[k] += static_cast<double>(n.objects.size()) - found;
        counts.invented[k] += static_cast<double>(n.tracks.size()) - found;
    }
}

/// Sum over the matches of how much of both tracks is common.
double associationOf(const Matches& matches, const Alignment& a) {
    double sum = 0.0;
    for (const auto& [pair, n] : matches)
        sum += n * n / std::max(1.0, a.scans_objects[pair.first] + a.scans_tracks[pair.second] - n);
    return sum;
}

double meanOverThresholds(const HotaCounts& h, double (*figure)(double, double)) {
    double sum = 0.0;
    for (std::size_t k = 0; k < HotaCounts::kThresholds; ++k) {
        const double detection = h.found[k] / std::max(1.0, h.found[k] + h.missed[k] + h.invented[k]);
        sum += figure(detection, h.association[k] / std::max(1.0, h.found[k]));
    }
    return sum / static_cast<double>(HotaCounts::kThresholds);
}

}  // namespace

HotaCounts countHota(const std::vector<TrackedScan>& scans, JudgedGroup group) {
    Numbers objects;
    Numbers tracks;
    std::vector<ScanNumbers> numbers;
    numbers.reserve(scans.size());
    for (const TrackedScan& scan : scans) numbers.push_back(numbersOf(scan, group, objects, tracks));
    const Alignment alignment(numbers, objects.size(), tracks.size());
    HotaCounts counts;
    MatchesByThreshold matches;
    for (const ScanNumbers& n : numbers) countScan(n, pairsOf(n, alignment), counts, matches);
    for (std::size_t k = 0; k < HotaCounts::kThresholds; ++k)
        counts.association[k] = associationOf(matches[k], alignment);
    return counts;
}

double HotaCounts::hota() const {
    return meanOverThresholds(*this, [](double d, double a) { return std::sqrt(d * a); });
}
double HotaCounts::detection() const {
    return meanOverThresholds(*this, [](double d, double) { return d; });
}
double HotaCounts::associationAccuracy() const {
    return meanOverThresholds(*this, [](double, double a) { return a; });
}

}  // namespace lidar_obstacles::evaluation
