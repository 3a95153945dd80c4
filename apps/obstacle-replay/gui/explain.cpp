// SPDX-License-Identifier: BSD-3-Clause
#include "explain.h"

#include <algorithm>
#include <cstdio>
#include <numeric>
#include <optional>

#include "lidar_obstacles/classification.h"
#include "lidar_obstacles/features.h"
#include "lidar_obstacles/grouping.h"
#include "lidar_obstacles/measured_features.h"
#include "lidar_obstacles/mrpt_bridge/scene.h"
#include "lidar_obstacles/recognizer.h"

namespace lidar_obstacles::apps {
namespace {

constexpr double kDegrees = 57.295779513082321;
constexpr double kBeside = 3.0;    ///< what was sorted out this near is named [m]
constexpr std::size_t kNamed = 5;  ///< merges and rejected clusters at most

template <class... Values>
std::string format(const char* pattern, Values... values) {
    char buffer[160];
    std::snprintf(buffer, sizeof buffer, pattern, values...);
    return buffer;
}

/// The chosen hypothesis that holds the obstacle's returns.
std::optional<std::size_t> hypothesisOf(const Obstacle& o, const std::vector<Hypothesis>& all) {
    if (o.points.empty()) return std::nullopt;
    for (std::size_t k = 0; k < all.size(); ++k) {
        const auto& points = all[k].points;
        if (all[k].chosen && std::find(points.begin(), points.end(), o.points.front()) != points.end()) return k;
    }
    return std::nullopt;
}

bool isWithin(int part, std::size_t whole, const std::vector<Hypothesis>& all) {
    for (; part >= 0; part = all[static_cast<std::size_t>(part)].parent)
        if (part == static_cast<int>(whole)) return true;
    return false;
}

std::string categoriesText(const Hypothesis& h) {
    std::vector<std::size_t> order(kCategories);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return h.category[a] > h.category[b]; });
    std::string text;
    for (const std::size_t k : order)
        if (h.category[k] >= 0.01F)
            text += format("%s%s %.2f", text.empty() ? "" : ", ", toString(static_cast<Category>(k)),
                           static_cast<double>(h.category[k]));
    return text;
}

std::string mergeText(const Merge& m, const std::vector<Hypothesis>& all) {
    const auto returns = [&](std::size_t k) { return all[static_cast<std::size_t>(m.part[k])].points.size(); };
    return format("%s: %zu + %zu returns (together %.1f, apart %.1f)", m.taken ? "joined" : "not joined", returns(0),
                  returns(1), static_cast<double>(m.together), static_cast<double>(m.apart));
}

void addRejected(const Obstacle& o, const LayerData& scan, std::vector<std::string>& lines) {
    std::size_t named = 0;
    for (const RejectedCluster& r : scan.result.clusters.rejected) {
        Eigen::Vector2d middle = Eigen::Vector2d::Zero();
        for (const std::int32_t i : r.cluster.points) middle += scan.cloud.xyz[i].head<2>().cast<double>();
        middle /= static_cast<double>(std::max<std::size_t>(1, r.cluster.points.size()));
        const double away = (middle - o.box.center.head<2>()).norm();
        if (away > kBeside || named++ >= kNamed) continue;
        lines.push_back(
            format("left out %.1f m away: %s, %.3g of %.3g", away, toString(r.reason), r.measured, r.limit));
    }
}

}  // namespace

std::vector<Line> numbersOf(const Obstacle& o) {
    const float p = probabilityOf(o);
    const Eigen::Vector3d& s = o.box.size;
    std::vector<Line> lines = {
        {"class", p > 0.F ? format("%s, %.2f", toString(o.cls), static_cast<double>(p)) : std::string(toString(o.cls))},
        {"size", format("%.2f x %.2f x %.2f m", s.x(), s.y(), s.z())},
        {"distance", format("%.1f m", distanceTo(o.box))},
        {"returns", format("%d of %d rings", o.num_points, o.num_rings)},
        {"heading", o.heading_valid ? format("%.0f deg +-%.0f, %s", o.box.yaw * kDegrees, o.heading_std * kDegrees,
                                             toString(o.rule))
                                    : std::string("-")},
        {"faces", facesText(o.faces)},
    };
    if (!o.track) return lines;
    const TrackState& t = *o.track;
    lines.push_back({"speed", t.velocity ? format("%.1f m/s%s", t.velocity->norm(), t.moving ? "" : ", stands") : "-"});
    lines.push_back({"age", format("%.1f s%s", t.age, t.seen ? "" : ", hidden")});
    return lines;
}

std::vector<std::string> reasonsOf(const Obstacle& o, const LayerData& scan) {
    const std::vector<Hypothesis>& all = scan.result.hypotheses;
    std::vector<std::string> lines;
    const auto chosen = hypothesisOf(o, all);
    if (!chosen) {
        lines.push_back(o.points.empty() ? "nothing of it was seen in this scan" : "nothing was weighed for it");
    } else {
        const Hypothesis& h = all[*chosen];
        lines.push_back("told: " + categoriesText(h));
        lines.push_back(format("whole %.2f; %d pieces, %.2f m apart; next %.2f m away", static_cast<double>(h.whole),
                               h.pieces, static_cast<double>(h.gap), static_cast<double>(h.next_gap)));
        std::size_t named = 0;
        for (const Merge& m : mergesOf(all)) {
            const bool of_it = isWithin(m.part[0], *chosen, all) || isWithin(m.part[1], *chosen, all);
            if (of_it && named++ < kNamed) lines.push_back(mergeText(m, all));
        }
        if (named > kNamed) lines.push_back(format("and %zu merges more", named - kNamed));
    }
    addRejected(o, scan, lines);
    return lines;
}

std::vector<Line> featuresOf(const Obstacle& o, const LayerData& scan) {
    const std::vector<Hypothesis>& all = scan.result.hypotheses;
    const auto chosen = hypothesisOf(o, all);
    std::vector<Line> lines;
    if (!chosen) return lines;
    const FeatureVector values = measuredFeatures(all[*chosen], scan.cloud, scan.result.ground);
    lines.reserve(kFeatures);
    for (std::size_t k = 0; k < kFeatures; ++k) {
        if (isOpinion(static_cast<Feature>(k))) continue;
        const FeatureInfo& info = featureInfos()[k];
        lines.push_back({info.name, format("%.3g %s", static_cast<double>(values[k]), info.unit), info.text});
    }
    return lines;
}

}  // namespace lidar_obstacles::apps
