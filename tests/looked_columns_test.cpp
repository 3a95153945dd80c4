// SPDX-License-Identifier: BSD-3-Clause
// Columns at which nobody looked: the seam of a turn, packets that are missing.
#include "scan/looked_columns.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace lidar_obstacles {
namespace {

constexpr int kColumns = 360;

/// Two rings; both brought something back everywhere but in stretches of columns: first, number.
OrganizedView viewWithout(const std::vector<std::pair<int, int>>& stretches) {
    OrganizedView view;
    view.rings = 2;
    view.columns = kColumns;
    view.index.assign(2 * kColumns, 0);
    for (const auto& [first, number] : stretches)
        for (int k = 0; k < number; ++k)
            for (int ring = 0; ring < 2; ++ring) view.at(ring, (first + k) % kColumns) = -1;
    return view;
}

TEST(LookedColumns, AreAllWhereNothingIsMissing) {
    const LookedColumns all(viewWithout({}));
    EXPECT_EQ(all.count(), kColumns);
    EXPECT_EQ(all.placeOf(17), 17);
    EXPECT_EQ(all.columnAt(17), 17);
    EXPECT_EQ(all.columnAt(kColumns), 0) << "places go round";
    EXPECT_EQ(all.columnAt(-1), kColumns - 1);
}

TEST(LookedColumns, SkipAHole) {
    const LookedColumns columns(viewWithout({{100, 24}}));
    EXPECT_EQ(columns.count(), kColumns - 24);
    EXPECT_EQ(columns.placeOf(99), 99);
    EXPECT_EQ(columns.placeOf(124), 100) << "beside the column before the hole";
    EXPECT_EQ(columns.columnAt(100), 124);
    EXPECT_EQ(columns.placeOf(110), 99);
}

TEST(LookedColumns, SkipAHoleAtTheEndOfTheView) {
    const LookedColumns columns(viewWithout({{kColumns - 5, 15}}));
    EXPECT_EQ(columns.count(), kColumns - 15);
    EXPECT_EQ(columns.columnAt(0), 10);
    EXPECT_EQ(columns.placeOf(3), columns.count() - 1);
    EXPECT_EQ(columns.columnAt(-1), kColumns - 6) << "the last before the hole is next to the first behind it";
}

TEST(LookedColumns, AColumnThatOneRingSawIsNoHole) {
    OrganizedView view = viewWithout({{100, 10}});
    view.at(1, 105) = 0;
    EXPECT_EQ(LookedColumns(view).count(), kColumns - 9);
}

TEST(LookedColumns, KeepWhatIsNoHole) {
    EXPECT_EQ(LookedColumns(viewWithout({{100, 25}})).count(), kColumns) << "longer than a packet";
    EXPECT_EQ(LookedColumns(viewWithout({{100, 200}, {320, 10}})).count(), kColumns - 10) << "a limited field of view";
    std::vector<std::pair<int, int>> every_third;
    for (int column = 0; column < kColumns; column += 3) every_third.emplace_back(column, 1);
    EXPECT_EQ(LookedColumns(viewWithout(every_third)).count(), kColumns) << "a scan without its ground";
}

TEST(LookedColumns, OfNothingAreNone) {
    EXPECT_EQ(LookedColumns(OrganizedView{}).count(), 0);
    EXPECT_EQ(LookedColumns(viewWithout({{0, kColumns}})).count(), kColumns);
}

}  // namespace
}  // namespace lidar_obstacles
