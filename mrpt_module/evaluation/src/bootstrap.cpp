// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/evaluation/bootstrap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "quantile.h"

namespace lidar_obstacles::evaluation {
namespace {

/// What is summed over the rows of an object.
enum Sum : std::size_t {
    kAsked,
    kFound,
    kFace,
    kFaceAbs,
    kCentre,
    kBevIou,
    kIou3d,
    kHeadings,
    kHeading180,
    kHeading180Abs,
    kHeading90Abs,
    kOver20,
    kSwapped,
    kFlipped,
    kSums
};
using Sums = std::array<double, kSums>;

/// A quantity is a quotient of two sums.
struct Quantity {
    const char* name;
    Sum numerator;
    Sum denominator;
};

constexpr std::array<Quantity, 13> kQuantities = {{{"recall", kFound, kAsked},
                                                   {"face_mean", kFace, kFound},
                                                   {"face_mae", kFaceAbs, kFound},
                                                   {"centre_mae", kCentre, kFound},
                                                   {"iou_mean", kBevIou, kFound},
                                                   {"iou3_mean", kIou3d, kFound},
                                                   {"heading_valid", kHeadings, kFound},
                                                   {"h180_mean", kHeading180, kHeadings},
                                                   {"h180_mae", kHeading180Abs, kHeadings},
                                                   {"h90_mae", kHeading90Abs, kHeadings},
                                                   {"h180_over20", kOver20, kHeadings},
                                                   {"swap_rate", kSwapped, kHeadings},
                                                   {"flip_rate", kFlipped, kHeadings}}};

void add(Sums& sums, const ObjectRecord& record) {
    sums[kAsked] += 1.0;
    if (!record.errors) return;
    const BoxErrors& e = *record.errors;
    sums[kFound] += 1.0;
    sums[kFace] += e.face;
    sums[kFaceAbs] += std::abs(e.face);
    sums[kCentre] += e.centre;
    sums[kBevIou] += e.bev_iou;
    sums[kIou3d] += e.iou_3d;
    if (!e.heading_valid) return;
    constexpr double kDegrees = 180.0 / M_PI;
    sums[kHeadings] += 1.0;
    sums[kHeading180] += kDegrees * e.heading_180;
    sums[kHeading180Abs] += kDegrees * std::abs(e.heading_180);
    sums[kHeading90Abs] += kDegrees * std::abs(e.heading_90);
    sums[kOver20] += kDegrees * std::abs(e.heading_180) > 20.0 ? 1.0 : 0.0;
    sums[kSwapped] += e.swapped ? 1.0 : 0.0;
    sums[kFlipped] += e.flipped ? 1.0 : 0.0;
}

std::vector<Sums> sumsOfObjects(const std::vector<CountedRow>& rows) {
    std::map<std::size_t, Sums> by_object;
    for (const CountedRow& row : rows) add(by_object.try_emplace(row.object, Sums{}).first->second, *row.record);
    std::vector<Sums> sums;
    sums.reserve(by_object.size());
    for (const auto& [object, s] : by_object) sums.push_back(s);
    return sums;
}

Sums resampled(const std::vector<Sums>& objects, std::mt19937_64& random) {
    Sums total{};
    for (std::size_t k = 0; k < objects.size(); ++k) {
        // not std::uniform_int_distribution: each standard library draws its own numbers
        const Sums& drawn = objects[static_cast<std::size_t>(random() % objects.size())];
        for (std::size_t s = 0; s < kSums; ++s) total[s] += drawn[s];
    }
    return total;
}

}  // namespace

Intervals bootstrapOverObjects(const std::vector<CountedRow>& rows, const BootstrapOptions& options) {
    if (options.replicates < 0) throw std::invalid_argument("bootstrapOverObjects: replicates < 0");
    const std::vector<Sums> objects = sumsOfObjects(rows);
    if (objects.size() < 2 || options.replicates == 0) return {};
    std::mt19937_64 random(options.seed);
    std::array<std::vector<double>, kQuantities.size()> values;
    for (int b = 0; b < options.replicates; ++b) {
        const Sums total = resampled(objects, random);
        for (std::size_t q = 0; q < kQuantities.size(); ++q) {
            const double denominator = total[kQuantities[q].denominator];
            if (denominator > 0.0) values[q].push_back(total[kQuantities[q].numerator] / denominator);
        }
    }
    Intervals intervals;
    for (std::size_t q = 0; q < kQuantities.size(); ++q) {
        if (values[q].empty()) continue;
        std::sort(values[q].begin(), values[q].end());
        intervals[kQuantities[q].name] = {sortedQuantile(values[q], 0.025), sortedQuantile(values[q], 0.975)};
    }
    return intervals;
}

}  // namespace lidar_obstacles::evaluation
