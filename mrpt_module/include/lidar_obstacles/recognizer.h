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

/// What the model tells apart: the five classes as whole objects, and what is no whole object.
enum class Category : std::uint8_t {
    Unknown,
    Vehicle,
    Pedestrian,
    Cyclist,
    Structure,
    VehiclePart,  ///< of a vehicle of which more was seen
    PersonPart,   ///< of a person or rider
    Mixture,      ///< more than one thing
    Count
};
constexpr std::size_t kCategories = static_cast<std::size_t>(Category::Count);
using CategoryProbabilities = std::array<float, kCategories>;

/// "unknown", "vehicle", "pedestrian", "cyclist", "structure", "vehicle_part", "person_part" or "mixture".
const char* toString(Category category);

/// The learned model. Does not change once read; may be used by several threads.
class Recognizer {
  public:
    /// Reads a model. @param name  stands for the file in messages.
    /// @throws std::runtime_error naming the file, the line and what was expected.
    static Recognizer parse(const std::string& text, const std::string& name);

    /// Probabilities of the categories, calibrated; they sum to 1. A group whose features lie outside what the
    /// training has seen is Unknown, and more likely a mixture than one thing. What is too large or too low for a class
    /// is not of it (sizeLimitsOf), but a mixture.
    CategoryProbabilities operator()(const FeatureVector& features) const;

    /// The sums of the trees before calibration. For training.
    std::array<float, kCategories> scores(const FeatureVector& features) const;
    /// How many features lie well outside what the training has seen.
    int unseen(const FeatureVector& features) const;

  private:
    bool clearlyStructure(const std::array<float, kCategories>& sum) const;
    void applySizes(const FeatureVector& features, CategoryProbabilities& p) const;

    std::shared_ptr<const BoostedTrees> trees_;
    std::array<float, kFeatures> least_{}, most_{};
    float sharpness_ = 1.0f;
    std::array<float, kCategories> bias_{};
};

/// The model of a file, or the built-in one for "built-in". A file is read once.
/// @throws std::runtime_error if it cannot be read or is no model.
std::shared_ptr<const Recognizer> recognizerOf(const std::string& model);

/// The five classes from the categories: parts count for their class, a mixture for none.
ClassProbabilities classesOf(const CategoryProbabilities& categories);

}  // namespace lidar_obstacles
