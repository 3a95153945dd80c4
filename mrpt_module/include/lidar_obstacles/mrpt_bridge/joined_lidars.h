// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Several lidars of a vehicle as one.
#pragma once

#include <list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace lidar_obstacles {

/// Puts the scans of several lidars together that belong to the same time: an item of the first lidar gets those of
/// the others as SourceItem::beside, and the name of the whole choice as its lidar.
///
/// Of each other lidar it is the scan whose stamp is nearest, not more than 0.1 s away. All other items pass in their
/// order, also scans that were joined to none: they keep the names of their lidars. It looks 0.2 s of scans and 400
/// items ahead at most, and not across a clock that was set back.
/// An object is for one thread at a time.
class JoinedLidars : public ScanSourceFilter {
  public:
    /// @param choice  "front,rear": names of lidars (SourceItem::lidar), the first of which gives the time; "all":
    ///     every lidar, after the first that comes. Spaces beside the names do not count.
    JoinedLidars(std::unique_ptr<ScanSource> source, const std::string& choice);

    std::optional<SourceItem> next() override;
    SourceStatus status() const override { return ahead_.empty() ? source_.status() : SourceStatus::Open; }
    std::size_t objects() const override { return objects_; }  ///< up to the item handed on last
    /// Also which lidars were missing beside how many scans, and how many of their scans were joined to none.
    std::string remarks() const override;

    /// The names in a choice; empty for "all".
    static std::vector<std::string> namesIn(const std::string& choice);
    /// True for "all" and for several names.
    static bool joins(const std::string& choice);

  private:
    struct Entry {
        SourceItem item;
        bool is_scan = false;                  ///< of a lidar that is joined, and with its points
        double time = 0.0;                     ///< of a scan [s]
        std::vector<std::string> beside = {};  ///< lidars whose scans were joined to it
    };
    struct Count {
        std::size_t joined = 0;
        std::size_t alone = 0;
    };

    using Entries = std::list<Entry>;

    bool readOne();
    bool isReady() const;
    Entries::iterator nearestTo(const Entry& entry, const std::string& lidar);
    void join(Entry& first, Entries::iterator other);
    void joinOthers(Entry& first);
    bool joinFront();

    std::unique_ptr<ScanSource> owned_;
    std::string choice_;
    std::vector<std::string> names_;  ///< empty: all
    std::string first_;               ///< lidar that gives the time; empty: not known yet
    Entries ahead_;
    std::size_t objects_ = 0;
    std::size_t firsts_ = 0;               ///< scans of the first lidar handed on
    std::map<std::string, Count> others_;  ///< scans of the other lidars
};

/// The scan of an item and those beside it as one cloud (joinedCloud()).
/// @param stats  if not null, receives the sums over all of them.
/// @throws as the other toPointCloud(); std::invalid_argument if the item is no scan.
PointCloud toPointCloud(const SourceItem& item, const SensorParams& params, DecodeStats* stats = nullptr);

}  // namespace lidar_obstacles
