#include "sequence/track_shape.h"

#include <algorithm>

namespace lidar_obstacles {
namespace {

constexpr double kFading = 0.98;  // of the weight of a view with each that follows: some 50 views are remembered
constexpr double kMinExtent = 0.05;

}  // namespace

void BestViews::add(double value, double weight) {
    for (std::size_t k = 0; k < count_; ++k) views_[k].weight *= kFading;
    if (count_ == kKept) {
        const auto least = std::min_element(views_.begin(), views_.end(),
                                            [](const View& a, const View& b) { return a.weight < b.weight; });
        if (least->weight > weight) return settle();
        std::move(least + 1, views_.end(), least);
        --count_;
    }
    std::size_t at = count_++;
    for (; at > 0 && views_[at - 1].value > value; --at) views_[at] = views_[at - 1];
    views_[at] = {value, weight};
    settle();
}

/// The weighted median, interpolated between the two views around it.
void BestViews::settle() {
    weight_ = 0.0;
    for (std::size_t k = 0; k < count_; ++k) weight_ += views_[k].weight;
    double below = 0.0;
    for (std::size_t k = 0; k < count_; ++k) {
        const double middle = below + 0.5 * views_[k].weight;
        if (middle >= 0.5 * weight_) {
            if (k == 0) break;
            const double before = below - 0.5 * views_[k - 1].weight;
            const double part = (0.5 * weight_ - before) / std::max(1e-12, middle - before);
            value_ = views_[k - 1].value + part * (views_[k].value - views_[k - 1].value);
            return;
        }
        below += views_[k].weight;
    }
    value_ = below > 0.0 ? views_[count_ - 1].value : views_[0].value;
}

double BestViews::std() const { return std::max(0.03, 0.4 / (1.0 + 4.0 * weight_)); }

void BestViews::move(double shift) {
    for (std::size_t k = 0; k < count_; ++k) views_[k].value += shift;
    value_ += shift;
}

void BestViews::cut(double limit) {
    for (std::size_t k = 0; k < count_; ++k) views_[k].value = std::min(views_[k].value, limit);
    value_ = std::min(value_, limit);
}

double BodyShape::extent(std::size_t k) const {
    return std::max(kMinExtent, faces_[k].value() + faces_[k + 2].value());
}

Eigen::Vector2d BodyShape::center() const {
    return {0.5 * (faces_[0].value() - faces_[2].value()), 0.5 * (faces_[1].value() - faces_[3].value())};
}

void BodyShape::turn(int quarters) {
    const auto by = static_cast<std::size_t>(((quarters % 4) + 4) % 4);
    std::rotate(faces_.begin(), faces_.begin() + static_cast<std::ptrdiff_t>(by), faces_.end());
}

}  // namespace lidar_obstacles
