// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

namespace lidar_obstacles {

/// Quantiles of numbers that are not negative, for few numbers over and over. Numbers are counted by their size as they
/// come: then only those about as large as the one that is asked for are compared.
class Quantiles {
  public:
    void clear() {
        numbers_.clear();
        count_.fill(0);
    }
    void add(float number) {
        numbers_.push_back(number);
        ++count_[bucketOf(number)];
    }
    std::size_t size() const { return numbers_.size(); }

    /// The k-th of n (0 .. 1) in their order, as std::nth_element has it; 0 where there is none.
    float operator()(float k) {
        if (numbers_.empty()) return 0.0f;
        auto place = static_cast<std::size_t>(k * static_cast<float>(numbers_.size() - 1));
        std::size_t bucket = 0;
        for (; place >= count_[bucket]; ++bucket) place -= count_[bucket];
        alike_.resize(numbers_.size() + 1);
        std::size_t alike = 0;
        for (const float number : numbers_) {
            alike_[alike] = number;  // written over by the next one unless it is alike
            alike += static_cast<std::size_t>(bucketOf(number) == bucket);
        }
        const auto nth = alike_.begin() + static_cast<std::ptrdiff_t>(place);
        std::nth_element(alike_.begin(), nth, alike_.begin() + static_cast<std::ptrdiff_t>(alike));
        return *nth;
    }

  private:
    static constexpr std::size_t kBuckets = 64;

    /// Four to an octave, from 2^-12 to 16: a float's first bits. All smaller ones are in the first bucket, all larger
    /// ones in the last.
    static std::size_t bucketOf(float number) {
        constexpr std::int32_t kFirst = (127 - 12) << 2;
        std::int32_t bits = 0;
        std::memcpy(&bits, &number, sizeof bits);
        return static_cast<std::size_t>(std::clamp((bits >> 21) - kFirst, 0, static_cast<std::int32_t>(kBuckets) - 1));
    }

    std::vector<float> numbers_;
    std::array<std::uint32_t, kBuckets> count_{};
    std::vector<float> alike_;
};

}  // namespace lidar_obstacles
