// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Whether two evaluations say the same.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace lidar_obstacles::test {

/// Digits that the other evaluation rounds a figure to, by its path ("vehicle.face_m.mean").
using DecimalsOf = std::function<int(const std::string&)>;

/// Everything that the other evaluation says is said by ours, to its rounding.
/// @param key  path of the two, for messages.
inline void expectAgreement(const nlohmann::json& theirs, const nlohmann::json& ours, const std::string& key,
                            const DecimalsOf& decimals_of) {
    if (theirs.is_object()) {
        for (const auto& [name, value] : theirs.items()) {
            if (name == "options" || name == "object_id") continue;
            ASSERT_TRUE(ours.contains(name)) << key << '.' << name;
            expectAgreement(value, ours.at(name), key + '.' + name, decimals_of);
        }
    } else if (theirs.is_array()) {
        ASSERT_EQ(theirs.size(), ours.size()) << key;
        for (std::size_t k = 0; k < theirs.size(); ++k) expectAgreement(theirs[k], ours[k], key, decimals_of);
    } else if (theirs.is_number()) {
        ASSERT_TRUE(ours.is_number()) << key << ": " << theirs << " and " << ours;
        // the last digit, and our millionths
        const double rounding = theirs.is_number_float() ? 0.5 * std::pow(10.0, -decimals_of(key)) + 1.5e-6 : 0.0;
        EXPECT_NEAR(theirs.get<double>(), ours.get<double>(), rounding) << key;
    } else {
        EXPECT_EQ(theirs, ours) << key;
    }
}

}  // namespace lidar_obstacles::test
