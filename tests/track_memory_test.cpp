// SPDX-License-Identifier: BSD-3-Clause
// The tracker takes no memory from the heap once it has seen as many boxes and tracks as there will be.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "support/track_scene.h"

namespace {

std::atomic<long> g_allocations{0};

}  // namespace

void* operator new(std::size_t size) {
    ++g_allocations;
    if (void* p = std::malloc(size == 0 ? 1 : size)) return p;
    throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++g_allocations;
    return std::malloc(size == 0 ? 1 : size);
}
void* operator new(std::size_t size, std::align_val_t align) {
    ++g_allocations;
    const auto step = static_cast<std::size_t>(align);
    if (void* p = std::aligned_alloc(step, (size + step - 1) / step * step)) return p;
    throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, const std::nothrow_t&) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

namespace lidar_obstacles {
namespace {

TEST(Tracker, TakesNoMemoryInTheSteadyState) {
    test::Drive drive;
    std::vector<test::Body> bodies;
    for (int k = 0; k < 20; ++k) bodies.push_back(test::carAt({8.0 + 7.0 * (k % 5), -16.0 + 8.0 * (k / 5), 0.0}));
    for (int n = 0; n < 40; ++n) drive.scan(bodies, {0.3 * n, 0.0, 0.0});
    long during = 0;
    for (int n = 0; n < 200; ++n) {
        drive.time += 0.1;
        drive.input.time = drive.time;
        for (SeenBox& b : drive.input.boxes) b.time = drive.time;
        const long before = g_allocations;
        drive.tracker.update(drive.input);
        during += g_allocations - before;
    }
    EXPECT_EQ(during, 0);
    EXPECT_EQ(drive.tracker.size(), 20u);
}

}  // namespace
}  // namespace lidar_obstacles
