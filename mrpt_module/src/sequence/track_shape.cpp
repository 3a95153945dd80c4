// SPDX-License-Identifier: BSD-3-Clause
#include "sequence/track_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lidar_obstacles {
namespace {

constexpr double kKeep = 0.98;               // of the weight of a view with each that follows: some 50 are remembered
constexpr double kKeepRefuted = 0.6;         // of views that beams speak against
constexpr double kMinExtent = 0.05;          // [m]
constexpr double kSeenFace = 0.1 * 0.1;      // where a face is, seen for the first time [m2]
constexpr double kGuessedFace = 0.4 * 0.4;   // where it is guessed
constexpr double kBestFace = 0.03 * 0.03;    // no face is known better: bodies are no boxes
constexpr double kFaceDrift = 0.01 * 0.01;   // per view: what is seen of a face changes
constexpr double kViewOfFace = 0.15 * 0.15;  // how little one view moves the face; the position takes the rest
constexpr double kViewOfMiddle = 0.3 * 0.3;
constexpr double kGuess = 0.4;       // what a completed view counts, beside one that saw both ends
constexpr double kSeenWell = 1.0;    // sum of weights that no single odd view has
constexpr double kSameExtent = 0.3;  // of a view that shows the whole axis [m]

bool isGuess(const BodyAxis::View& view) {
    return view.grade[0] == EdgeGrade::Guess || view.grade[1] == EdgeGrade::Guess;
}

/// What a view says of an extent, beside one that is believed (0: nothing is).
double weightOf(const BodyAxis::View& view, double believed) {
    const int seen = (view.grade[0] == EdgeGrade::Seen ? 1 : 0) + (view.grade[1] == EdgeGrade::Seen ? 1 : 0);
    const double weight = (seen == 2 ? 1.0 : seen == 1 ? 0.6 : 0.3) * view.quality;
    if (believed <= 0.0 || view.ends) return weight;
    // the more of the body is seen, the likelier it ends where the returns do; what is larger may be two
    const double share = (view.edge[0] + view.edge[1]) / believed;
    return weight * std::max(0.2, share < 1.0 ? share * share : 1.0 / share);
}

}  // namespace

void BestViews::add(double value, double weight, double keep) {
    for (std::size_t k = 0; k < count_; ++k) views_[k].weight *= keep;
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

void BodyAxis::begin(const View& view) {
    *this = BodyAxis{};
    addExtent(view);
    center_ = 0.5 * (view.edge[0] - view.edge[1]);
    for (std::size_t k = 0; k < 2; ++k) variance_[k] = view.grade[k] == EdgeGrade::Seen ? kSeenFace : kGuessedFace;
}

void BodyAxis::learn(const View& view) {
    const bool ahead = view.grade[0] == EdgeGrade::Seen;
    const bool behind = view.grade[1] == EdgeGrade::Seen;
    const std::size_t side = ahead ? 0 : 1;
    const double held = face(side);
    const double seen = view.edge[0] + view.edge[1];
    addExtent(view);
    if (ahead != behind) {
        const double before = std::min(variance_[side], variance_[1 - side] + all_.std() * all_.std());
        const double gain = before / (before + kViewOfFace);
        anchor(side, held + gain * (view.edge[side] - held));
        variance_[side] = std::max(kBestFace, (1.0 - gain) * before) + kFaceDrift;
    } else if (std::abs(seen - extent()) < kSameExtent) {
        const double before = std::min(variance_[0], variance_[1]);
        const double gain = before / (before + kViewOfMiddle);
        center_ += gain * (0.5 * (view.edge[0] - view.edge[1]) - center_);
        variance_.fill(std::max(kBestFace, (1.0 - gain) * before) + kFaceDrift);
    }
}

void BodyAxis::addExtent(const View& view) {
    const double extent = view.edge[0] + view.edge[1];
    if (isGuess(view)) return all_.add(extent, kGuess * view.quality, 1.0);
    const double weight = weightOf(view, all_.weight() > 0.0 ? all_.value() : 0.0);
    const double keep = view.ends ? kKeepRefuted : kKeep;
    all_.add(extent, weight, keep);
    seen_.add(extent, weight, keep);
}

/// What was seen more than once proves that it is no shorter.
double BodyAxis::extent() const {
    return std::max({kMinExtent, all_.value(), seen_.weight() > kSeenWell ? seen_.value() : 0.0});
}

double BodyAxis::face(std::size_t side) const { return 0.5 * extent() + (side == 0 ? center_ : -center_); }

double BodyAxis::faceStd(std::size_t side) const {
    return std::sqrt(std::min(variance_[side], variance_[1 - side] + all_.std() * all_.std()));
}

/// Puts the body so that one of its faces is there.
void BodyAxis::anchor(std::size_t side, double at) { center_ = (side == 0 ? 1.0 : -1.0) * (at - 0.5 * extent()); }

void BodyAxis::reverse() {
    center_ = -center_;
    std::swap(variance_[0], variance_[1]);
}

void BodyShape::reverse() {
    for (BodyAxis& axis : axes_) axis.reverse();
}

}  // namespace lidar_obstacles
