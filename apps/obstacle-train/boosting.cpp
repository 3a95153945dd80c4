// SPDX-License-Identifier: BSD-3-Clause
#include "boosting.h"

#include <xgboost/c_api.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "common/number_text.h"

namespace lidar_obstacles::apps {
namespace {

using Json = nlohmann::json;

void check(int status) {
    if (status != 0) throw std::runtime_error(std::string("XGBoost: ") + XGBGetLastError());
}

struct MatrixEnd {
    void operator()(void* m) const { XGDMatrixFree(m); }
};
struct BoosterEnd {
    void operator()(void* b) const { XGBoosterFree(b); }
};

/// The rarer a category, the more each of its samples counts: by the root of how rare it is.
std::vector<float> weightsOf(const std::vector<float>& labels) {
    std::array<double, kCategories> count{};
    for (const float label : labels) ++count[static_cast<std::size_t>(label)];
    std::vector<float> weights;
    weights.reserve(labels.size());
    const double even = static_cast<double>(labels.size()) / kCategories;
    for (const float label : labels)
        weights.push_back(static_cast<float>(std::sqrt(even / count[static_cast<std::size_t>(label)])));
    return weights;
}

/// A row for each sample. What is left out is the same for all: no tree can ask for it.
std::unique_ptr<void, MatrixEnd> matrixOf(const std::vector<const Sample*>& samples, Recognizer::Forest forest,
                                          const std::set<Feature>& left_out) {
    const bool grouping = forest == Recognizer::Forest::Grouping;
    const std::size_t features = grouping ? kGroupFeatures : kFeatures;
    std::vector<float> data;
    std::vector<float> labels;
    data.reserve(samples.size() * features);
    for (const Sample* s : samples) {
        data.insert(data.end(), s->features.begin(), s->features.begin() + static_cast<std::ptrdiff_t>(features));
        for (const Feature k : left_out)
            if (static_cast<std::size_t>(k) < features)
                data[data.size() - features + static_cast<std::size_t>(k)] = 0.0f;
        labels.push_back(static_cast<float>(grouping ? s->truth : s->verdict));
    }
    const std::vector<float> weights = weightsOf(labels);
    DMatrixHandle handle = nullptr;
    check(XGDMatrixCreateFromMat(data.data(), samples.size(), features, NAN, &handle));
    std::unique_ptr<void, MatrixEnd> matrix(handle);
    check(XGDMatrixSetFloatInfo(handle, "label", labels.data(), labels.size()));
    check(XGDMatrixSetFloatInfo(handle, "weight", weights.data(), weights.size()));
    return matrix;
}

/// A tree of XGBoost's as lines: 1 + feature (0: leaf), limit or leaf value, first of the two nodes that follow.
TreeText linesOf(const Json& root) {
    std::vector<const Json*> nodes{&root};
    std::string lines;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        const Json& node = *nodes[n];
        if (node.contains("leaf")) {
            lines += "0 " + shortestText(node["leaf"].get<float>()) + '\n';
            continue;
        }
        const int feature = std::stoi(node["split"].get<std::string>().substr(1));
        lines += std::to_string(feature + 1) + ' ' + shortestText(node["split_condition"].get<float>()) + ' ' +
                 std::to_string(nodes.size()) + '\n';
        const bool first_is_yes = node["children"][0]["nodeid"] == node["yes"];
        nodes.push_back(&node["children"][first_is_yes ? 0 : 1]);
        nodes.push_back(&node["children"][first_is_yes ? 1 : 0]);
    }
    return "tree " + std::to_string(nodes.size()) + '\n' + lines;
}

}  // namespace

std::vector<TreeText> boost(const std::vector<const Sample*>& samples, Recognizer::Forest forest,
                            const BoostingOptions& options) {
    const auto matrix = matrixOf(samples, forest, options.left_out);
    const DMatrixHandle data = matrix.get();
    BoosterHandle handle = nullptr;
    check(XGBoosterCreate(&data, 1, &handle));
    const std::unique_ptr<void, BoosterEnd> booster(handle);
    const std::map<std::string, std::string> params = {{"objective", "multi:softprob"},
                                                       {"num_class", std::to_string(kCategories)},
                                                       {"tree_method", "hist"},
                                                       {"max_depth", std::to_string(options.depth)},
                                                       {"eta", std::to_string(options.rate)},
                                                       {"subsample", "0.7"},
                                                       {"colsample_bytree", "0.7"},
                                                       {"min_child_weight", "10"},
                                                       {"gamma", "1"},
                                                       {"nthread", "2"},
                                                       {"verbosity", "0"},
                                                       {"seed", std::to_string(options.seed)}};
    for (const auto& [key, value] : params) check(XGBoosterSetParam(handle, key.c_str(), value.c_str()));
    for (int round = 0; round < options.rounds; ++round) check(XGBoosterUpdateOneIter(handle, round, data));
    bst_ulong count = 0;
    const char** dumps = nullptr;
    check(XGBoosterDumpModelEx(handle, "", 0, "json", &count, &dumps));
    std::vector<TreeText> trees;
    for (bst_ulong t = 0; t < count; ++t) trees.push_back(linesOf(Json::parse(dumps[t])));
    return trees;
}

std::string rangesText(const std::vector<const Sample*>& samples, const std::set<Feature>& left_out) {
    constexpr double kRare = 0.0005;  // share of the samples that may lie outside on either side
    std::string text = "lidar_obstacles_model 2\n";
    std::vector<float> values(samples.size());
    for (std::size_t k = 0; k < kFeatures; ++k) {
        const auto feature = static_cast<Feature>(k);
        if (samples.empty() || isOpinion(feature) ||
            left_out.count(feature) != 0) {  // the latter are bounded, whatever the model
            text += std::string("feature ") + featureInfos()[k].name + " -1e30 1e30\n";
            continue;
        }
        for (std::size_t n = 0; n < samples.size(); ++n) values[n] = samples[n]->features[k];
        std::sort(values.begin(), values.end());
        const auto rare = static_cast<std::size_t>(kRare * static_cast<double>(values.size()));
        text += std::string("feature ") + featureInfos()[k].name + ' ' + shortestText(values[rare]) + ' ' +
                shortestText(values[values.size() - 1 - rare]) + '\n';
    }
    return text;
}

std::string modelText(const std::string& ranges, const Forest& grouping, const Forest& verdict) {
    std::string text = ranges;
    const auto add = [&](const char* name, const Forest& forest) {
        text += name + (' ' + shortestText(forest.calibration.sharpness));
        for (const float b : forest.calibration.bias) text += ' ' + shortestText(b);
        text += "\ntrees " + std::to_string(forest.trees.size()) + '\n';
        for (const TreeText& tree : forest.trees) text += tree;
    };
    add("grouping", grouping);
    add("verdict", verdict);
    return text;
}

}  // namespace lidar_obstacles::apps
