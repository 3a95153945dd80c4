// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/params.h"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "lidar_obstacles/params_list.h"

namespace lidar_obstacles {
namespace {

template <class T>
constexpr bool kIsNumber = std::is_same_v<T, int> || std::is_same_v<T, double>;

/// What validate() says; empty if it is content.
std::string complaint(const DetectorParams& params) {
    try {
        validate(params);
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return "";
}

/// Sets the number-th parameter, if it is a number, to value(info) and tells its name "[section] key".
template <class Value>
std::string setNumber(DetectorParams& params, int number, Value value) {
    int at = 0;
    std::string name;
    forEachParam(params, [&](const ParamInfo& info, auto& member) {
        using T = std::decay_t<decltype(member)>;
        if constexpr (kIsNumber<T>) {
            if (at++ != number) return;
            member = static_cast<T>(value(info));
            name = "[" + std::string(info.section) + "] " + info.key;
        }
    });
    return name;
}

int numberOfNumbers() {
    int count = 0;
    DetectorParams params;
    forEachParam(params, [&](const ParamInfo&, auto& member) { count += kIsNumber<std::decay_t<decltype(member)>>; });
    return count;
}

TEST(Params, TheDefaultsAreValid) { EXPECT_EQ(complaint(DetectorParams{}), ""); }

TEST(Params, EveryNumberBelowItsRangeIsNamed) {
    for (int k = 0; k < numberOfNumbers(); ++k) {
        DetectorParams params;
        const std::string name = setNumber(params, k, [](const ParamInfo& i) { return i.min - 1.0; });
        EXPECT_NE(complaint(params).find(name + " ="), std::string::npos) << name << ": " << complaint(params);
    }
}

TEST(Params, EveryNumberAboveItsRangeIsNamedWithValueAndRange) {
    for (int k = 0; k < numberOfNumbers(); ++k) {
        DetectorParams params;
        double highest = 0.0;
        const std::string name = setNumber(params, k, [&](const ParamInfo& i) {
            highest = i.max;
            return i.max + 1.0;
        });
        if (highest >= std::numeric_limits<int>::max()) continue;  // no int lies above
        const std::string text = complaint(params);
        EXPECT_NE(text.find(name + " ="), std::string::npos) << name << ": " << text;
        EXPECT_NE(text.find("outside"), std::string::npos) << text;
    }
}

TEST(Params, TheEndsOfEveryRangeAreAllowed) {
    for (int k = 0; k < numberOfNumbers(); ++k) {
        DetectorParams low;
        DetectorParams high;
        setNumber(low, k, [](const ParamInfo& i) { return i.min; });
        setNumber(high, k, [](const ParamInfo& i) { return i.max; });
        EXPECT_EQ(complaint(low), "");
        EXPECT_EQ(complaint(high), "");
    }
}

TEST(Params, NanIsOutsideEveryRange) {
    DetectorParams params;
    params.grid.resolution = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(complaint(params).find("[grid] resolution"), std::string::npos);
    params = DetectorParams{};
    params.region.max_height = std::numeric_limits<double>::infinity();
    EXPECT_NE(complaint(params).find("[region] max_height"), std::string::npos);
}

TEST(Params, EachIsListedOnceWithATextAndARange) {
    std::set<std::string> names;
    DetectorParams params;
    forEachParam(params, [&](const ParamInfo& info, const auto&) {
        const std::string name = std::string(info.section) + "." + info.key;
        EXPECT_TRUE(names.insert(name).second) << name << " is listed twice";
        EXPECT_NE(std::string(info.text), "") << name;
        EXPECT_LE(info.min, info.max) << name;
    });
    EXPECT_GT(names.size(), 30u);
}

/// All members are 1, 4 or 8 bytes long: between listed ones there is room for padding, but for no other member.
TEST(Params, EveryMemberIsListed) {
    const DetectorParams params;
    std::map<std::ptrdiff_t, std::pair<std::string, std::size_t>> members;  // offset -> name, size
    forEachParam(params, [&](const ParamInfo& info, const auto& member) {
        const auto offset = reinterpret_cast<const char*>(&member) - reinterpret_cast<const char*>(&params);
        members[offset] = {std::string(info.section) + "." + info.key, sizeof(member)};
    });
    std::ptrdiff_t end = 0;
    std::string last = "the beginning";
    for (const auto& [offset, member] : members) {
        EXPECT_LT(offset - end, 8) << "a member between " << last << " and " << member.first << " is not listed";
        end = offset + static_cast<std::ptrdiff_t>(member.second);
        last = member.first;
    }
    EXPECT_LT(static_cast<std::ptrdiff_t>(sizeof(params)) - end, 8) << "members after " << last << " are not listed";
}

}  // namespace
}  // namespace lidar_obstacles
