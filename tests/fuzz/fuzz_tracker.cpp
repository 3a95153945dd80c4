// SPDX-License-Identifier: BSD-3-Clause
// The tracker: any boxes, at any times.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <set>
#include <stdexcept>

#include "lidar_obstacles/tracking.h"

namespace {

using namespace lidar_obstacles;

/// Numbers from the fuzzer's bytes; 0 where they are used up.
class Numbers {
  public:
    Numbers(const std::uint8_t* data, std::size_t size) : at_(data), end_(data + size) {}
    bool any() const { return at_ < end_; }
    int byte() { return any() ? *at_++ : 0; }
    /// -`limit` to `limit`; one of 256 is what eight bytes say, whatever that is.
    double number(double limit) {
        const int first = byte();
        if (first != 255) return limit * (first * 256 + byte() - 32640) / 32768.0;
        double value = 0.0;
        if (end_ - at_ >= 8) {
            std::memcpy(&value, at_, 8);
            at_ += 8;
        }
        return value;
    }

  private:
    const std::uint8_t* at_;
    const std::uint8_t* end_;
};

SeenBox boxOf(Numbers& numbers, double time) {
    SeenBox b;
    b.time = time + numbers.number(0.1);
    b.box.center = {numbers.number(60.0), numbers.number(60.0), numbers.number(2.0)};
    b.box.size = {2.0 + numbers.number(2.0), 1.0 + numbers.number(1.0), 1.0 + numbers.number(1.0)};
    b.box.yaw = numbers.number(3.2);
    b.seen_box = b.box;
    const int flags = numbers.byte();
    b.heading_valid = (flags & 1) != 0;
    b.heading_std = b.heading_valid ? 0.02 : 0.0;
    b.faces = static_cast<std::uint8_t>(flags >> 4);
    b.num_points = numbers.byte();
    b.classes = classesOfLabel(static_cast<ObstacleClass>(numbers.byte() % 5), 0.8);
    return b;
}

void checkRows(const std::vector<TrackedBox>& rows, std::size_t boxes) {
    std::set<int> ids;
    for (const TrackedBox& row : rows) {
        if (!ids.insert(row.id).second) std::abort();
        if (row.source < -1 || row.source >= static_cast<int>(boxes)) std::abort();
        if (!row.box.center.allFinite() || !row.box.size.allFinite() || !std::isfinite(row.box.yaw)) std::abort();
        if (row.box.size.minCoeff() <= 0.0 || !row.state.center_std.allFinite()) std::abort();
        if (row.state.velocity && !row.state.velocity->allFinite()) std::abort();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Numbers numbers(data, size);
    Tracker tracker{TrackingParams{}};
    TrackingScan scan;
    scan.time = 1000.0;
    scan.poses_known = (numbers.byte() & 1) != 0;
    double x = 0.0;
    while (numbers.any()) {
        scan.time += 0.1 + numbers.number(0.1);
        x += numbers.number(2.0);
        scan.T_world_vehicle = Eigen::Isometry3d::Identity();
        if (scan.poses_known) scan.T_world_vehicle.translate(Eigen::Vector3d(x, 0.0, 0.0));
        scan.boxes.clear();
        for (int n = numbers.byte() % 12; n > 0; --n) {
            scan.boxes.push_back(boxOf(numbers, scan.time));
            scan.boxes.back().T_world_vehicle = scan.T_world_vehicle;
        }
        try {
            checkRows(tracker.update(scan), scan.boxes.size());
        } catch (const std::invalid_argument&) {
            if (!std::isfinite(scan.time) || !std::isfinite(x)) return 0;
        }
        const auto pose = [&scan](double) { return scan.T_world_vehicle; };
        tracker.expected(scan.time + 0.1, scan.poses_known, pose);
    }
    return 0;
}
