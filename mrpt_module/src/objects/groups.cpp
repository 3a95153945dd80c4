#include "objects/groups.h"

#include <algorithm>

namespace lidar_obstacles {

void setScore(Hypothesis& hypothesis, const CategoryProbabilities& verdict) {
    const auto of = [&](Category c) { return verdict[static_cast<std::size_t>(c)]; };
    hypothesis.probability = classesOf(verdict);
    hypothesis.whole = 1.0f - of(Category::VehiclePart) - of(Category::PersonPart) - of(Category::Mixture);
}

void score(std::vector<Hypothesis>& tree, const Beams& beams, const GroundModel& ground, const Recognizer& recognizer) {
    FeatureExtractor featuresOf(beams, ground, tree);
    for (std::size_t k = 0; k < tree.size(); ++k) setScore(tree[k], recognizer(featuresOf(static_cast<int>(k))));
}

void chooseBestCut(std::vector<Hypothesis>& tree) {
    std::vector<float> best(tree.size());
    for (std::size_t k = 0; k < tree.size(); ++k) {
        Hypothesis& h = tree[k];
        best[k] = static_cast<float>(h.points.size()) * h.whole;
        h.chosen = true;
        if (h.part[0] < 0) continue;
        const float apart = best[static_cast<std::size_t>(h.part[0])] + best[static_cast<std::size_t>(h.part[1])];
        h.chosen = best[k] >= apart;
        best[k] = std::max(best[k], apart);
    }
    std::vector<bool> taken(tree.size(), false);  // is in something chosen
    for (std::size_t k = tree.size(); k-- > 0;) {
        Hypothesis& h = tree[k];
        if (h.parent >= 0 && taken[static_cast<std::size_t>(h.parent)]) h.chosen = false;
        taken[k] = h.chosen || (h.parent >= 0 && taken[static_cast<std::size_t>(h.parent)]);
    }
}

}  // namespace lidar_obstacles
