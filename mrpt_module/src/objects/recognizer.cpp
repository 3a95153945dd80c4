// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/recognizer.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "lidar_obstacles/object_models.h"
#include "objects/boosted_trees.h"
#include "objects/builtin_model.h"

namespace lidar_obstacles {
namespace {

constexpr int kMostUnseen = 2;         // features outside what the training has seen
constexpr std::size_t kFirstLook = 8;  // rounds of trees before which nothing is clear
constexpr std::size_t kLookEvery = 4;  // how often it is looked at again
constexpr float kUnseenWhole = 0.4f;   // probability that such a group is one thing: nothing speaks for it

/// Words of a model, with the line in messages.
class ModelReader {
  public:
    ModelReader(const std::string& text, const std::string& name) : text_(text), name_(name) {}

    void line() {
        ++line_;
        if (next_ >= text_.size()) fail("the file ends here");
        at_ = next_;
        const std::size_t end = text_.find('\n', at_);
        end_ = end == std::string::npos ? text_.size() : end;
        next_ = end_ + 1;
    }
    std::string word(const std::string& expected) {
        while (at_ < end_ && text_[at_] == ' ') ++at_;
        const std::size_t begin = at_;
        while (at_ < end_ && text_[at_] != ' ') ++at_;
        if (begin == at_) fail("expected " + expected);
        return text_.substr(begin, at_ - begin);
    }
    void keyword(const std::string& expected) {
        const std::string w = word("'" + expected + "'");
        if (w != expected) fail("expected '" + expected + "', found '" + w + "'");
    }
    template <class Number>
    Number number(const char* expected) {
        while (at_ < end_ && text_[at_] == ' ') ++at_;
        Number n{};
        const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + end_, n);
        if (error != std::errc()) fail(std::string("expected ") + expected);
        if constexpr (std::is_floating_point_v<Number>)
            if (!std::isfinite(n)) fail(std::string("expected ") + expected);
        at_ = static_cast<std::size_t>(end - text_.data());
        return n;
    }
    /// What sums and products of many stay finite with.
    float weight(const char* expected) {
        constexpr float kMost = 1e6f;
        const float w = number<float>(expected);
        if (std::abs(w) > kMost) fail(std::string("expected ") + expected + " up to 1e6");
        return w;
    }
    int count(const char* expected, int most) {
        const int n = number<int>(expected);
        if (n < 0 || n > most)
            fail(std::string(expected) + " is " + std::to_string(n) + ", allowed are 0 .. " + std::to_string(most));
        return n;
    }
    [[noreturn]] void fail(const std::string& what) const {
        throw std::runtime_error(name_ + ", line " + std::to_string(line_) + ": " + what);
    }

  private:
    const std::string& text_;
    const std::string& name_;
    std::size_t at_ = 0;    ///< of the line: what is not read yet
    std::size_t end_ = 0;   ///< of the line
    std::size_t next_ = 0;  ///< line
    int line_ = 0;
};

std::string textOf(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    if (!in || !(text << in.rdbuf())) throw std::runtime_error(file + ": cannot read the model");
    return text.str();
}

}  // namespace

const char* toString(Category category) {
    static constexpr std::array<const char*, kCategories> kNames = {
        "unknown", "vehicle", "pedestrian", "cyclist", "structure", "vehicle_part", "person_part", "mixture"};
    return kNames[static_cast<std::size_t>(category)];
}

namespace {

/// Notes the limits of each feature, as many as a model may have.
class LimitCounter {
  public:
    void add(int feature, float limit, const ModelReader& reader) {
        std::set<float>& limits = limits_[static_cast<std::size_t>(feature)];
        limits.insert(limit);
        if (limits.size() > BoostedTrees::kMostLimits)
            reader.fail("more than " + std::to_string(BoostedTrees::kMostLimits) + " limits of feature '" +
                        featureInfos()[static_cast<std::size_t>(feature)].name + "'");
    }

  private:
    std::array<std::set<float>, kFeatures> limits_;
};

BoostedTrees::Tree readTree(ModelReader& reader, LimitCounter& limits) {
    constexpr int kMostNodes = 65000;
    reader.line();
    reader.keyword("tree");
    const int nodes = reader.count("the number of nodes", kMostNodes);
    if (nodes == 0) reader.fail("a tree without nodes");
    BoostedTrees::Tree tree;
    std::vector<int> depth(static_cast<std::size_t>(nodes), 0);  // of each node
    for (int n = 0; n < nodes; ++n) {
        reader.line();
        BoostedTrees::Node node;
        node.feature = reader.count("1 + the place of a feature, 0 for a leaf", static_cast<int>(kFeatures)) - 1;
        node.value = node.feature >= 0 ? reader.number<float>("a number") : reader.weight("a number");
        const int own = depth[static_cast<std::size_t>(n)];
        if (own > BoostedTrees::kDeepest) reader.fail("a tree deeper than " + std::to_string(BoostedTrees::kDeepest));
        if (node.feature >= 0) {
            node.next = reader.count("a node", nodes - 2);
            if (node.next <= n) reader.fail("a node that leads back");
            for (const int child : {node.next, node.next + 1}) depth[static_cast<std::size_t>(child)] = own + 1;
            limits.add(node.feature, node.value, reader);
        }
        tree.push_back(node);
    }
    return tree;
}

std::vector<BoostedTrees::Tree> readTrees(ModelReader& reader) {
    constexpr int kMostTrees = 100000;
    reader.line();
    reader.keyword("trees");
    const int count = reader.count("the number of trees", kMostTrees);
    if (count % static_cast<int>(kCategories) != 0) reader.fail("expected as many trees for each category");
    LimitCounter limits;
    std::vector<BoostedTrees::Tree> trees;
    trees.reserve(static_cast<std::size_t>(count));
    for (int t = 0; t < count; ++t) trees.push_back(readTree(reader, limits));
    return trees;
}

}  // namespace

Recognizer Recognizer::parse(const std::string& text, const std::string& name) {
    ModelReader reader(text, name);
    Recognizer model;
    reader.line();
    reader.keyword("lidar_obstacles_model");
    if (reader.count("a version", 1000) != 2) reader.fail("this version of the program reads models of version 2");
    for (std::size_t k = 0; k < kFeatures; ++k) {
        reader.line();
        reader.keyword("feature");
        reader.keyword(featureInfos()[k].name);
        model.least_[k] = reader.number<float>("the smallest value seen");
        model.most_[k] = reader.number<float>("the largest value seen");
    }
    const auto forest = [&](const char* name_of_it, Trees& t) {
        reader.line();
        reader.keyword(name_of_it);
        t.calibration.sharpness = reader.weight("a number");
        for (float& b : t.calibration.bias) b = reader.weight("a number for each category");
        t.trees = std::make_shared<const BoostedTrees>(readTrees(reader));
    };
    forest("grouping", model.grouping_);
    forest("verdict", model.verdict_);
    return model;
}

bool Recognizer::judgesSurroundings() const { return verdict_.trees->rounds() > 0; }

/// Most groups are walls and plants beyond any doubt: the later trees, which only refine, are spared them.
bool Recognizer::clearlyStructure(const Trees& t, const std::array<float, kCategories>& sum) {
    constexpr float kDoubt = 4.0f;  // exp(-4): 2 per cent
    float next = -1e9f;
    for (std::size_t k = 0; k < kCategories; ++k)
        if (k != static_cast<std::size_t>(Category::Structure)) next = std::max(next, sum[k]);
    return t.calibration.sharpness * (sum[static_cast<std::size_t>(Category::Structure)] - next) > kDoubt;
}

std::array<float, kCategories> Recognizer::scores(const FeatureVector& features, Forest forest) const {
    return sumsOf(treesOf(forest), {&features}).front();
}

std::vector<std::array<float, kCategories>> Recognizer::sumsOf(const Trees& t,
                                                               const std::vector<const FeatureVector*>& groups) {
    std::vector<Walker> all = t.trees->walkersFor(groups);
    Walkers walkers(all);
    for (std::size_t round = 0; round < t.trees->rounds() && !walkers.members().empty(); ++round) {
        if (round >= kFirstLook && round % kLookEvery == 0)
            walkers.release([&](const CategorySums& sums) { return clearlyStructure(t, sums); });
        t.trees->addRound(round, walkers);
    }
    std::vector<std::array<float, kCategories>> sums;
    sums.reserve(all.size());
    for (const Walker& w : all) sums.push_back(w.sums);
    return sums;
}

int Recognizer::unseen(const FeatureVector& features) const {
    constexpr float kBeyond =
        0.5f;  // of the range seen, to either side: there the trees still know better than nothing
    int count = 0;
    for (std::size_t k = 0; k < kFeatures; ++k) {
        const float beyond = kBeyond * (most_[k] - least_[k]);
        count += static_cast<int>(!(features[k] >= least_[k] - beyond && features[k] <= most_[k] + beyond));
    }
    return count;
}

CategoryProbabilities probabilitiesOf(const std::array<float, kCategories>& sums, const Calibration& calibration) {
    CategoryProbabilities p{};
    for (std::size_t k = 0; k < kCategories; ++k) p[k] = calibration.sharpness * sums[k] + calibration.bias[k];
    const float most = *std::max_element(p.begin(), p.end());
    float sum = 0.0f;
    for (float& v : p) sum += v = std::exp(v - most);
    for (float& v : p) v /= sum;
    return p;
}

std::vector<CategoryProbabilities> Recognizer::operator()(const std::vector<const FeatureVector*>& groups,
                                                          Forest forest) const {
    const Trees& t = treesOf(forest);
    std::vector<CategoryProbabilities> told;
    for (const std::array<float, kCategories>& sums : sumsOf(t, groups))
        told.push_back(probabilitiesOf(sums, t.calibration));
    for (std::size_t k = 0; k < groups.size(); ++k) {
        if (unseen(*groups[k]) <= kMostUnseen) {
            applySizes(*groups[k], told[k]);
            continue;
        }
        told[k].fill(0.0f);
        told[k][static_cast<std::size_t>(Category::Unknown)] = kUnseenWhole;
        told[k][static_cast<std::size_t>(Category::Mixture)] = 1.0f - kUnseenWhole;
    }
    return told;
}

void Recognizer::applySizes(const FeatureVector& features, CategoryProbabilities& p) {
    constexpr std::array<std::pair<Category, ObstacleClass>, 3> kWholes = {
        {{Category::Vehicle, ObstacleClass::Vehicle},
         {Category::Pedestrian, ObstacleClass::Pedestrian},
         {Category::Cyclist, ObstacleClass::Cyclist}}};
    const auto of = [&](Feature k) { return features[static_cast<std::size_t>(k)]; };
    for (const auto& [category, cls] : kWholes) {
        const SizeLimits limits = sizeLimitsOf(cls, of(Feature::TopLimit));
        if (of(Feature::Length) <= limits.max_length && of(Feature::Width) <= limits.max_width &&
            of(Feature::TopLimit) >= limits.min_height && of(Feature::Top) <= limits.max_height)
            continue;
        float& whole = p[static_cast<std::size_t>(category)];
        p[static_cast<std::size_t>(Category::Mixture)] += whole;
        whole = 0.0f;
    }
}

std::shared_ptr<const Recognizer> recognizerOf(const std::string& model) {
    static std::mutex mutex;
    static std::map<std::string, std::shared_ptr<const Recognizer>> read;
    const std::lock_guard<std::mutex> lock(mutex);
    std::shared_ptr<const Recognizer>& entry = read[model];
    if (!entry) {
        const bool built_in = model == "built-in";
        entry = std::make_shared<const Recognizer>(
            Recognizer::parse(built_in ? builtinModel() : textOf(model), built_in ? "built-in model" : model));
    }
    return entry;
}

ClassProbabilities classesOf(const CategoryProbabilities& c) {
    const auto of = [&](Category k) { return c[static_cast<std::size_t>(k)]; };
    const float people = of(Category::Pedestrian) + of(Category::Cyclist);
    const float on_foot = people > 1e-6f ? of(Category::Pedestrian) / people : 0.5f;
    ClassProbabilities p{};
    p[static_cast<std::size_t>(ObstacleClass::Unknown)] = of(Category::Unknown) + of(Category::Mixture);
    p[static_cast<std::size_t>(ObstacleClass::Vehicle)] = of(Category::Vehicle) + of(Category::VehiclePart);
    p[static_cast<std::size_t>(ObstacleClass::Pedestrian)] =
        of(Category::Pedestrian) + on_foot * of(Category::PersonPart);
    p[static_cast<std::size_t>(ObstacleClass::Cyclist)] =
        of(Category::Cyclist) + (1.0f - on_foot) * of(Category::PersonPart);
    p[static_cast<std::size_t>(ObstacleClass::Structure)] = of(Category::Structure);
    return p;
}

}  // namespace lidar_obstacles
