// SPDX-License-Identifier: BSD-3-Clause
// What a cluster covers seen from above, held against OpenCV's rectangles on random point sets.
#include "objects/footprint.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <random>

namespace lidar_obstacles {
namespace {

/// `count` returns all over an ellipse of a random place, size and direction.
PointCloud ellipse(int count, std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    const Eigen::Rotation2Df turn(static_cast<float>(M_PI) * unit(random));
    const Eigen::Vector2f place(30.0f * unit(random), 30.0f * unit(random));
    const Eigen::Vector2f radii(0.2f + std::abs(3.0f * unit(random)), 0.1f + std::abs(unit(random)));
    PointCloud cloud;
    while (static_cast<int>(cloud.size()) < count) {
        const Eigen::Vector2f p(unit(random), unit(random));
        if (p.norm() > 1.0f) continue;
        const Eigen::Vector2f q = place + turn * radii.cwiseProduct(p);
        cloud.xyz.emplace_back(q.x(), q.y(), unit(random));
    }
    return cloud;
}

std::vector<std::int32_t> range(std::int32_t first, std::int32_t end) {
    std::vector<std::int32_t> points(end - first);
    std::iota(points.begin(), points.end(), first);
    return points;
}

Footprint footprintOfAll(const PointCloud& cloud) {
    return footprintOf(range(0, static_cast<std::int32_t>(cloud.size())), cloud);
}

cv::RotatedRect minAreaRectOf(const Footprint& f) {
    std::vector<cv::Point2f> corners;
    for (int k = 0; k < Footprint::kDirections; ++k) corners.emplace_back(f.x[k], f.y[k]);
    return cv::minAreaRect(corners);
}

TEST(Footprint, OfNothingIsEmptyAndHasNoSize) {
    const Footprint f = footprintOf({}, PointCloud{});
    EXPECT_TRUE(f.empty());
    EXPECT_EQ(smallestRectangle(f).length, 0.0f);
}

TEST(Footprint, OfOneReturnIsThatReturn) {
    PointCloud cloud;
    cloud.xyz.emplace_back(3.0f, -2.0f, 1.0f);
    const Footprint f = footprintOfAll(cloud);
    EXPECT_EQ(f.box.min(), Eigen::Vector2f(3.0f, -2.0f));
    EXPECT_EQ(f.box.max(), Eigen::Vector2f(3.0f, -2.0f));
    EXPECT_TRUE((f.x == 3.0f).all() && (f.y == -2.0f).all());
    EXPECT_EQ(smallestRectangle(f).length, 0.0f);
}

TEST(Footprint, OfALineHasItsLengthAndNoWidth) {
    PointCloud cloud;
    for (int k = 0; k <= 10; ++k) cloud.xyz.emplace_back(0.3f * k, 10.0f + 0.4f * k, 0.0f);
    const SmallestRectangle r = smallestRectangle(footprintOfAll(cloud));
    EXPECT_NEAR(r.length, 5.0f, 1e-4f);
    EXPECT_NEAR(r.width, 0.0f, 1e-4f);
    EXPECT_NEAR(std::abs(r.along.dot(Eigen::Vector2f(0.6f, 0.8f))), 1.0f, 1e-5f);
}

TEST(Footprint, ItsBoxIsThatOfItsReturns) {
    std::mt19937 random(1);
    for (int k = 0; k < 200; ++k) {
        const PointCloud cloud = ellipse(2 + k, random);
        const auto points = range(0, static_cast<std::int32_t>(cloud.size()));
        EXPECT_TRUE(footprintOf(points, cloud).box.isApprox(boundsOf(points, cloud)));
    }
}

TEST(Footprint, OfTwoTogetherIsThatOfAllTheirReturns) {
    std::mt19937 random(2);
    for (int k = 0; k < 200; ++k) {
        PointCloud cloud = ellipse(20, random);
        const PointCloud other = ellipse(30, random);
        cloud.xyz.insert(cloud.xyz.end(), other.xyz.begin(), other.xyz.end());
        const Footprint both = merged(footprintOf(range(0, 20), cloud), footprintOf(range(20, 50), cloud));
        EXPECT_EQ(both.returns, footprintOfAll(cloud).returns);
    }
}

TEST(Footprint, ItsSmallestRectangleIsThatOfOpenCv) {
    std::mt19937 random(3);
    for (int k = 0; k < 500; ++k) {  // few returns make few corners, many make all sixteen
        const Footprint f = footprintOfAll(ellipse(3 + k % 250, random));
        const SmallestRectangle r = smallestRectangle(f);
        const cv::RotatedRect exact = minAreaRectOf(f);
        EXPECT_NEAR(r.length * r.width, exact.size.area(), 1e-3f * exact.size.area() + 1e-4f) << k;
        EXPECT_GE(r.length, r.width);
    }
}

TEST(Footprint, OfTheRectanglesOfATriangleTheLongestIsTaken) {  // all three cover the same area
    std::mt19937 random(6);
    int judged = 0;
    for (int k = 0; k < 200; ++k) {
        const PointCloud cloud = ellipse(3, random);
        float longest = 0.0f;
        for (int a = 0; a < 3; ++a)
            longest = std::max(longest, (cloud.xyz[a] - cloud.xyz[(a + 1) % 3]).head<2>().norm());
        const Footprint f = footprintOfAll(cloud);
        if (f.box.sizes().minCoeff() < 0.1f) continue;
        ++judged;
        EXPECT_NEAR(smallestRectangle(f).length, longest, 1e-3f * longest) << k;
    }
    EXPECT_GT(judged, 100);
}

TEST(Footprint, TellsSizesToAFewPerCent) {
    std::mt19937 random(5);
    for (int k = 0; k < 500; ++k) {
        const PointCloud cloud = ellipse(100, random);
        const auto all = range(0, 100);
        const Footprint f = footprintOf(all, cloud);
        float longest = 0.0f;
        for (const std::int32_t i : all)
            for (const std::int32_t j : all)
                longest = std::max(longest, (cloud.xyz[i] - cloud.xyz[j]).head<2>().norm());
        EXPECT_NEAR((f.reach.head<8>() + f.reach.tail<8>()).maxCoeff(), longest, 0.02f * longest)
            << k;  // 1 - cos(11.25 deg) = 1.9 %
    }
}

TEST(Footprint, WhatIsSurelyWithinIs) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> size(0.3, 7.0);
    int sure = 0;
    for (int k = 0; k < 2000; ++k) {
        const PointCloud cloud = ellipse(3 + k % 100, random);
        const double length = size(random);
        const double width = std::min(length, size(random));
        const Footprint f = footprintOfAll(cloud);
        if (!surelyWithin(f.box.sizes(), length, width)) continue;
        ++sure;
        const SmallestRectangle r = smallestRectangle(f);
        EXPECT_LE(r.length, length + 1e-4) << k;
        EXPECT_LE(r.width, width + 1e-4) << k;
    }
    EXPECT_GT(sure, 200);
}

}  // namespace
}  // namespace lidar_obstacles
