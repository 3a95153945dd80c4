// SPDX-License-Identifier: BSD-3-Clause
#include "sequence.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace lidar_obstacles::apps {

Sequence::Sequence(const ScanStore& store, std::shared_ptr<const PoseIndex> poses, DetectorSetup setup)
    : store_(store), poses_(std::move(poses)), setup_(std::move(setup)), detector_(setup_.params) {
    forget();
}

void Sequence::forget() {
    last_.reset();
    last_time_.reset();
    detector_.restart();
    tails_.clear();
    zones_.reset();
    if (!setup_.zones.zones.empty() || !setup_.zones.vehicle.empty())
        zones_.emplace(setup_.zones, setup_.params.region);
}

std::shared_ptr<ShownScan> Sequence::decode(std::size_t index) const {
    return decodeScan(*store_.read(index), store_.scanIndex(index), setup_);
}

std::shared_ptr<ShownScan> Sequence::process(std::size_t index) {
    auto scan = decode(index);
    const bool is_ready = ready(index);
    if (!last_ || *last_ + 1 != index) warmUp(index);
    last_ = is_ready ? std::optional(index) : std::nullopt;
    if (!scan->error.empty()) return scan;
    SequenceResult found = detectIn(std::move(scan->cloud));
    if (health_) health_->update(found);
    if (zones_) scan->zones = outlinesOf(*zones_, found, detector_.trajectory());
    scan->take(std::move(found), detector_, setup_.params);
    scan->tails = tails_.tails();
    return scan;
}

bool Sequence::ready(std::size_t index) const {
    if (!poses_) return true;
    double latest = store_.time(index);  // stamps need not rise
    for (std::size_t k = index - std::min(index, scansRemembered(setup_.params)); k < index; ++k)
        latest = std::max(latest, store_.time(k));
    return poses_->covers(latest);
}

/// Shows the detector the scans before `index` that it would remember; those that cannot be right are none.
void Sequence::warmUp(std::size_t index) {
    forget();
    std::vector<PointCloud> before;
    for (std::size_t k = index; k-- > 0 && before.size() < scansRemembered(setup_.params);) {
        auto scan = decode(k);
        if (scan->error.empty()) before.push_back(std::move(scan->cloud));
    }
    for (; !before.empty(); before.pop_back()) detectIn(std::move(before.back()));
}

SequenceResult Sequence::detectIn(PointCloud cloud) {
    constexpr double kBefore = 1.0;  // of poses before the first scan [s]
    const double time = cloud.timestamp;
    if (poses_)
        for (const StampedPose& pose : poses_->around(last_time_.value_or(time - kBefore), time))
            detector_.addPose(pose);
    last_time_ = time;
    SequenceResult found = detector_.process(std::move(cloud));
    tails_.add(found, detector_.trajectory());
    if (zones_) zones_->update({found, detector_.trajectory(), nullptr, std::nullopt});
    return found;
}

}  // namespace lidar_obstacles::apps
