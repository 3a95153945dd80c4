// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "asked.h"
#include "lidar_obstacles/evaluation/box_overlap.h"
#include "tracking_judge.h"

namespace lidar_obstacles::evaluation {
namespace {

double ratio(std::size_t part, std::size_t whole) {
    return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
}

/// What a wrong claim stands on; "" where that is neither wanted nor false.
std::string standsOn(const Detection& d, const Scan& scan, JudgedGroup group, const EvaluationOptions& options) {
    constexpr double kLabelMargin = 0.3;  // [m]
    const double enough = 0.3 * std::max(1e-9, d.box.size.x() * d.box.size.y());
    std::string on = "nothing";
    for (const TruthObject& o : scan.objects) {
        if (!(sharedArea(grown(o.box, kLabelMargin), d.box) > enough)) continue;
        if (o.group == Group::Other || !isAskedFor(o, options)) return "";
        if (belongsTo(o.group, group))
            on = "again";
        else if (on == "nothing")
            on = "other class";
    }
    return on;
}

/// The boxes of a group, the most probable first; those that tell no probability before them.
std::vector<const Detection*> ranked(const Scan& scan, JudgedGroup group, const EvaluationOptions& options) {
    const auto rank = [](const Detection* d) {
        return std::isfinite(d->track.probability) ? d->track.probability : 1.0;
    };
    std::vector<const Detection*> boxes;
    for (const Detection& d : scan.detections)
        if (isBoxOf(d, group, options)) boxes.push_back(&d);
    std::stable_sort(boxes.begin(), boxes.end(),
                     [&](const Detection* a, const Detection* b) { return rank(a) > rank(b); });
    return boxes;
}

class ScanClasses {
  public:
    ScanClasses(const Scan& scan, JudgedGroup group, const EvaluationOptions& options, ClassCounts& counts)
        : scan_(scan), group_(group), options_(options), counts_(counts), used_(scan.objects.size(), false) {}

    void judge(const Detection& d) {
        if (const auto at = bestObject(d)) {
            used_[*at] = true;
            if (isAskedFor(scan_.objects[*at], options_)) counts_.claims.push_back({d.track.probability, true});
            return;
        }
        if (d.range > options_.max_range || d.track.seen == 0.0) return;  // no claim about this scan
        const std::string on = standsOn(d, scan_, group_, options_);
        if (on.empty()) return;
        ++counts_.wrong[on];
        counts_.claims.push_back({d.track.probability, false});
    }

  private:
    std::optional<std::size_t> bestObject(const Detection& d) const {
        std::optional<std::size_t> at;
        double best = 0.0;
        for (std::size_t i = 0; i < used_.size(); ++i) {
            if (used_[i] || !belongsTo(scan_.objects[i].group, group_)) continue;
            const double fit = fitOf(scan_.objects[i], d, group_);
            if (fit <= best) continue;
            best = fit;
            at = i;
        }
        return at;
    }

    const Scan& scan_;
    JudgedGroup group_;
    const EvaluationOptions& options_;
    ClassCounts& counts_;
    std::vector<bool> used_;
};

bool allProbable(const std::vector<Claim>& claims) {
    return !claims.empty() &&
           std::all_of(claims.begin(), claims.end(), [](const Claim& c) { return std::isfinite(c.probability); });
}

}  // namespace

ClassCounts countClasses(const JudgedScans& scans, JudgedGroup group, const EvaluationOptions& options) {
    ClassCounts counts;
    for (const Scan& scan : scans) {
        for (const TruthObject& o : scan.objects)
            counts.asked += belongsTo(o.group, group) && isAskedFor(o, options) ? 1 : 0;
        ScanClasses judged(scan, group, options, counts);
        for (const Detection* d : ranked(scan, group, options)) judged.judge(*d);
    }
    return counts;
}

std::size_t ClassCounts::right() const {
    return static_cast<std::size_t>(
        std::count_if(claims.begin(), claims.end(), [](const Claim& c) { return c.right; }));
}

double ClassCounts::precision() const { return ratio(right(), claims.size()); }
double ClassCounts::recall() const { return ratio(right(), asked); }

double ClassCounts::f1() const {
    const double p = precision();
    const double r = recall();
    return 2.0 * p * r / std::max(1e-9, p + r);
}

std::optional<double> ClassCounts::averagePrecision() const {
    if (!allProbable(claims)) return std::nullopt;
    std::vector<Claim> sorted = claims;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const Claim& a, const Claim& b) { return a.probability > b.probability; });
    std::vector<std::pair<double, double>> curve;  // recall, precision; claims of one probability are one point
    std::size_t right = 0;
    for (std::size_t k = 0; k < sorted.size(); ++k) {
        right += sorted[k].right ? 1 : 0;
        if (k + 1 == sorted.size() || sorted[k + 1].probability != sorted[k].probability)
            curve.emplace_back(ratio(right, asked), ratio(right, k + 1));
    }
    double area = 0.0;
    double best = 0.0;  // precision at this recall or a higher one
    for (std::size_t k = curve.size(); k-- > 0;) {
        best = std::max(best, curve[k].second);
        area += best * (curve[k].first - (k > 0 ? curve[k - 1].first : 0.0));
    }
    return area;
}

std::optional<double> ClassCounts::calibrationError() const {
    if (!allProbable(claims)) return std::nullopt;
    constexpr int kBins = 10;
    std::array<double, kBins> told{};
    std::array<double, kBins> right{};
    for (const Claim& c : claims) {
        const auto bin = static_cast<std::size_t>(std::clamp(static_cast<int>(c.probability * kBins), 0, kBins - 1));
        told[bin] += c.probability;
        right[bin] += c.right ? 1.0 : 0.0;
    }
    double error = 0.0;
    for (std::size_t k = 0; k < kBins; ++k) error += std::abs(told[k] - right[k]);
    return error / static_cast<double>(claims.size());
}

}  // namespace lidar_obstacles::evaluation
