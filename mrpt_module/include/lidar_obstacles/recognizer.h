// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// What a group of returns is: boosted trees over its features, learned from simulated scenes (obstacle-train).
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "lidar_obstacles/features.h"
#include "lidar_obstacles/types.h"

namespace lidar_obstacles {

class BoostedTrees;

/// "unknown", "vehicle", "pedestrian", "cyclist", "structure", "vehicle_part", "person_part" or "mixture".
const char* toString(Category category);

/// What makes probabilities of the sums of a forest's trees: sharpness times the sum, and a bias for each category.
struct Calibration {
    float sharpness = 1.0f;
    std::array<float, kCategories> bias{};
};
/// Their shares of exp(sharpness * sum + bias).
CategoryProbabilities probabilitiesOf(const std::array<float, kCategories>& sums, const Calibration& calibration);

/// The learned model. Does not change once read; may be used by several threads.
class Recognizer {
  public:
    /// Reads a model. @param name  stands for the file in messages.
    /// @throws std::runtime_error naming the file, the line and what was expected.
    static Recognizer parse(const std::string& text, const std::string& name);

    /// The trees that form groups, and those that judge what was chosen.
    enum class Forest : std::uint8_t { Grouping, Verdict };
    /// What groups are: by themselves (Grouping), or among what stands about them, of which the features tell as well
    /// (Verdict). Probabilities of the categories, calibrated; they sum to 1. A group whose features lie outside what
    /// the training has seen is Unknown, and more likely a mixture than one thing. What is too large or too low for a
    /// class is not of it (sizeLimitsOf), but a mixture. Many at once take less time than one after the other.
    std::vector<CategoryProbabilities> operator()(const std::vector<const FeatureVector*>& groups, Forest forest) const;
    CategoryProbabilities operator()(const FeatureVector& group, Forest forest) const {
        return (*this)(std::vector<const FeatureVector*>{&group}, forest).front();
    }
    /// Was it trained to judge what was chosen? A model need not be.
    bool judgesSurroundings() const;

    /// The sums of the trees before calibration. For training.
    std::array<float, kCategories> scores(const FeatureVector& features, Forest forest) const;
    /// How many features lie well outside what the training has seen.
    int unseen(const FeatureVector& features) const;

  private:
    struct Trees {
        std::shared_ptr<const BoostedTrees> trees;
        Calibration calibration;
    };
    static bool clearlyStructure(const Trees& t, const std::array<float, kCategories>& sum);
    static std::vector<std::array<float, kCategories>> sumsOf(const Trees& t,
                                                              const std::vector<const FeatureVector*>& groups);
    static void applySizes(const FeatureVector& features, CategoryProbabilities& p);
    const Trees& treesOf(Forest forest) const { return forest == Forest::Grouping ? grouping_ : verdict_; }

    Trees grouping_, verdict_;
    std::array<float, kFeatures> least_{}, most_{};
};

/// The model of a file, or the built-in one for "built-in". A file is read once.
/// @throws std::runtime_error if it cannot be read or is no model.
std::shared_ptr<const Recognizer> recognizerOf(const std::string& model);

/// The five classes from the categories: parts count for their class, a mixture is Unknown.
ClassProbabilities classesOf(const CategoryProbabilities& categories);

}  // namespace lidar_obstacles
