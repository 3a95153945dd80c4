// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Scans together with the poses that belong to them.
#pragma once

#include <deque>
#include <functional>
#include <string>

#include "lidar_obstacles/mrpt_bridge/ego_motion.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace lidar_obstacles {

constexpr double kLongestScan = 0.2;    ///< poses beyond the end of a scan: 5 turns per second are the slowest [s]
constexpr double kPosesBelongTo = 0.4;  ///< poses that come later after a scan's beginning do not belong to it [s]

/// Hands on the items of another source in their order, but reads ahead of each lidar scan until a pose beyond its end
/// has come: so poses are interpolated, not extrapolated. Of joined scans (SourceItem::beside) that of the last one
/// counts. It looks `kPosesBelongTo` and 400 items ahead at most, and not across a clock that was set back.
/// An object is for one thread at a time.
class PoseFeed : public ScanSourceFilter {
  public:
    using Sink = std::function<void(const StampedPose&)>;

    /// @param source  stays the caller's.
    /// @param ego  which poses are taken out of it; where none is read from it, nothing is read ahead.
    /// @param sink  is given each pose; what it throws as std::invalid_argument is counted as a refused pose.
    PoseFeed(ScanSource& source, EgoSource ego, Sink sink);

    std::optional<SourceItem> next() override;
    SourceStatus status() const override { return ahead_.empty() ? source_.status() : SourceStatus::Open; }
    std::size_t objects() const override { return objects_; }  ///< up to the item handed on last
    /// Also how many poses were refused, and why the first was.
    std::string remarks() const override;

    std::size_t poses() const { return poses_; }  ///< handed to the sink and taken by it
    std::size_t refused() const { return refused_; }
    const EgoSource& ego() const { return ego_.source(); }

  private:
    bool readOne();
    void readAheadOf(const SourceItem& scan);
    bool isSetBack(const SourceItem& scan) const;

    EgoMotion ego_;
    Sink sink_;
    std::deque<SourceItem> ahead_;
    double last_pose_ = -1e300;  ///< stamp of the pose read last [s]
    double last_item_ = -1e300;  ///< of the observation read last [s]
    std::size_t objects_ = 0;
    std::size_t poses_ = 0;
    std::size_t refused_ = 0;
    std::string why_refused_;
};

}  // namespace lidar_obstacles
