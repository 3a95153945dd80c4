// SPDX-License-Identifier: BSD-3-Clause
// What is searched: rectangle, outline, excluded places and sectors.
#include "lidar_obstacles/searched_place.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lidar_obstacles {
namespace {

bool isSearched(const std::string& excluded, double azimuth_deg, const std::string& outline = "none") {
    RegionParams params;
    params.excluded = excluded;
    params.outline = outline;
    const double azimuth = azimuth_deg * M_PI / 180.0;
    return SearchedPlace(params).holds(
        {static_cast<float>(10.0 * std::cos(azimuth)), static_cast<float>(10.0 * std::sin(azimuth)), 1.0F});
}

TEST(SearchedPlace, ByDefaultItIsTheRectangle) {
    const SearchedPlace place{RegionParams{}};
    EXPECT_TRUE(place.holds({59.9F, -39.9F, 1.0F}));
    EXPECT_FALSE(place.holds({60.1F, 0.0F, 1.0F}));
    EXPECT_FALSE(place.holds({0.0F, 40.1F, 1.0F}));
    EXPECT_FALSE(place.leavesOut({60.1F, 0.0F, 1.0F})) << "the rectangle ends there, nothing is left out of it";
}

TEST(SearchedPlace, ASectorGoesCounterClockwiseFromItsFirstAzimuthToItsSecond) {
    for (const char* sector : {"sector(80, 100)", "sector(-280, -260)"}) {
        EXPECT_FALSE(isSearched(sector, 90)) << sector;
        EXPECT_TRUE(isSearched(sector, 79)) << sector;
        EXPECT_TRUE(isSearched(sector, 101)) << sector;
        EXPECT_TRUE(isSearched(sector, -90)) << sector;
    }
    for (const char* sector : {"sector(350, 10)", "sector(-10, 10)"}) {
        EXPECT_FALSE(isSearched(sector, 0)) << sector;
        EXPECT_TRUE(isSearched(sector, 11)) << sector;
        EXPECT_TRUE(isSearched(sector, 180)) << sector;
    }
}

TEST(SearchedPlace, ASectorMayBeWiderThanHalfATurn) {
    EXPECT_FALSE(isSearched("sector(10, -10)", 180));
    EXPECT_FALSE(isSearched("sector(10, -10)", 11));
    EXPECT_FALSE(isSearched("sector(10, -10)", -11));
    EXPECT_TRUE(isSearched("sector(10, -10)", 0));
    EXPECT_FALSE(isSearched("sector(90, 270)", 180));
    EXPECT_TRUE(isSearched("sector(90, 270)", 0));
}

TEST(SearchedPlace, ExcludedPlacesAreCutOutOfTheOutline) {
    EXPECT_TRUE(isSearched("none", 45, "polygon(0 0, 20 0, 0 20)"));
    EXPECT_FALSE(isSearched("none", -45, "polygon(0 0, 20 0, 0 20)"));
    EXPECT_FALSE(isSearched("box(5, 9, 5, 9)", 45, "polygon(0 0, 20 0, 0 20)"));
    EXPECT_TRUE(isSearched("box(5, 9, 5, 9) sector(-90, 0)", 20, "polygon(0 0, 20 0, 0 20)"));
}

TEST(ExcludedPlaces, TheirTextReadsBackTheSame) {
    for (const char* text : {"none", "sector(-10, 12.5)", "box(-1, 1, -0.6, 0.6) sector(170, 190) sector(1, 2)"})
        EXPECT_EQ(toText(ExcludedPlaces(text)), text);
    EXPECT_EQ(toText(ExcludedPlaces("sector (1 2), box(0 1 0 1)")), "box(0, 1, 0, 1) sector(1, 2)");
}

/// What validate() says of a text of the region.
std::string complaint(std::string RegionParams::* key, const std::string& text) {
    DetectorParams params;
    params.region.*key = text;
    try {
        validate(params);
    } catch (const std::invalid_argument& e) {
        return e.what();
    }
    return "";
}

TEST(ExcludedPlaces, WhatIsNotRightIsSaidWithTheKeyAndWhatWasExpected) {
    for (const char* text : {"", "sector", "sector(1)", "sector(1, 2, 3)", "sector(0, 360)", "sector(5, 5)",
                             "sector(1, x)", "sector(1, 400)", "circle(1)", "box(1, 2)", "sector(1, 2) more"}) {
        const std::string said = complaint(&RegionParams::excluded, text);
        EXPECT_EQ(said.rfind(std::string("[region] excluded = ") + text + ": ", 0), 0U) << said;
    }
    EXPECT_NE(complaint(&RegionParams::excluded, "circle(1)").find("sector(..)"), std::string::npos);
    EXPECT_NE(complaint(&RegionParams::excluded, "sector(5, 5)").find("two directions"), std::string::npos);
}

TEST(SearchedOutline, WhatIsNotRightIsSaidWithTheKeyAndWhatWasExpected) {
    for (const char* text : {"", "polygon(0 0, 1 1)", "sector(1, 2)", "box(1, 2)"}) {
        const std::string said = complaint(&RegionParams::outline, text);
        EXPECT_EQ(said.rfind(std::string("[region] outline = ") + text + ": ", 0), 0U) << said;
        EXPECT_NE(said.find("expected none, or polygon(..)"), std::string::npos) << said;
    }
}

}  // namespace
}  // namespace lidar_obstacles
