// SPDX-License-Identifier: BSD-3-Clause
#include "common/merges_csv.h"

#include <algorithm>

#include "common/number_text.h"
#include "lidar_obstacles/grouping.h"
#include "lidar_obstacles/recognizer.h"

namespace lidar_obstacles::apps {
namespace {

Category likeliest(const CategoryProbabilities& p) {
    return static_cast<Category>(std::max_element(p.begin(), p.end()) - p.begin());
}

}  // namespace

std::string mergesHeader() {
    std::string text =
        "timestamp,scan_index,hypothesis,part_a,part_b,x,y,num_points,gap,apart,together,taken,told,whole";
    for (std::size_t k = 0; k < kCategories; ++k) text += std::string(",p_") + toString(static_cast<Category>(k));
    return text + "\n";
}

std::string mergesRows(double timestamp, std::size_t scan_index, const PointCloud& cloud,
                       const DetectionResult& result) {
    std::string text;
    for (const Merge& m : mergesOf(result.hypotheses)) {
        const Hypothesis& h = result.hypotheses[static_cast<std::size_t>(m.whole)];
        Eigen::Vector2f sum = Eigen::Vector2f::Zero();
        for (const std::int32_t i : h.points) sum += cloud.xyz[i].head<2>();
        const Eigen::Vector2f middle = sum / static_cast<float>(std::max<std::size_t>(1, h.points.size()));
        text += fixedText(timestamp, 6) + ',' + std::to_string(scan_index) + ',' + std::to_string(m.whole) + ',' +
                std::to_string(m.part[0]) + ',' + std::to_string(m.part[1]) + ',' + fixedText(middle.x(), 2) + ',' +
                fixedText(middle.y(), 2) + ',' + std::to_string(h.points.size()) + ',' + fixedText(h.gap, 2) + ',' +
                fixedText(m.apart, 1) + ',' + fixedText(m.together, 1) + ',' + (m.taken ? '1' : '0') + ',' +
                toString(likeliest(h.category)) + ',' + fixedText(h.whole, 3);
        for (const float p : h.category) text += ',' + fixedText(p, 3);
        text += '\n';
    }
    return text;
}

}  // namespace lidar_obstacles::apps
