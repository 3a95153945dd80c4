// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// The scans of a file by their number, in any order, while it is still being read through.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "camera_image.h"
#include "lidar_obstacles/mrpt_bridge/scan_source.h"
#include "scan_spool.h"

namespace lidar_obstacles::apps {

/// Which scans of a file are asked for.
struct ScanSelection {
    std::optional<std::string> label;  ///< of the lidar; none: the first one, which must be the only one then
    std::size_t from = 0;              ///< number of the first scan
    std::size_t to = 0;                ///< number of the last scan
    std::size_t every = 1;
    std::optional<mrpt::poses::CPose3D> sensor_pose = std::nullopt;  ///< of the lidar; none: what the file says
    InputOptions options = {};
    bool points_in_vehicle = false;  ///< placeSensor()
};

/// An index of the selected scans, built by a thread of its own from the moment of opening. Memory holds a few bytes
/// per scan: a scan is read again from the file, or, where that cannot be read from its middle (gzip, captures), from a
/// temporary file that the thread fills.
class ScanStore {
  public:
    /// @throws std::runtime_error naming the file if it cannot be opened.
    ScanStore(const std::string& path, const ScanSelection& selection);
    ~ScanStore();
    ScanStore(const ScanStore&) = delete;
    ScanStore& operator=(const ScanStore&) = delete;

    const std::string& path() const { return path_; }
    /// Scans in the index so far.
    std::size_t size() const;
    /// True when the whole file has been read through, or as far as it can be.
    bool complete() const { return complete_; }
    /// Share of the file that has been read through, 0 .. 1.
    double progress() const { return progress_; }
    /// Why the index ends before the file does (damage, temporary files), in one line; empty if it does not.
    std::string problem() const;
    /// True if the problem is how the program was called: several lidars and none chosen, none of that label, no scan
    /// selected, none at all.
    bool problemOfUsage() const { return usage_; }

    /// Waits until the scan is in the index or will never be. @return whether it is.
    bool waitFor(std::size_t index) const;

    /// Number of a scan in the file.
    std::size_t scanIndex(std::size_t index) const;
    /// Seconds since the epoch.
    double time(std::size_t index) const;
    /// The first scan whose number is at least that; the last one if there is none.
    std::size_t atScanIndex(std::size_t scan_index) const;
    /// The last scan that is not later than that; the first one if there is none.
    std::size_t atTime(double time) const;

    /// Reads a scan. To be called from one thread. @throws std::runtime_error if it cannot be read.
    mrpt::obs::CObservation::Ptr read(std::size_t index) const;

    /// The labels of the cameras in the index so far, in the order in which they come.
    std::vector<std::string> cameras() const;
    /// The number of a camera's image that is nearest in time to a scan, of those in the index; none if that is farther
    /// than 0.25 s.
    std::optional<std::size_t> imageBeside(const std::string& camera, std::size_t index) const;
    /// Reads an image; one that cannot be read says why. To be called from the thread of read().
    CameraImage readImage(const std::string& camera, std::size_t number) const;

  private:
    struct Entry {
        double time;
        std::size_t scan_index;
        ScanSpool::Place place;  ///< in the spool; in the rawlog `size` is the number of the observation in its object
    };

    struct ImageEntry {
        double time;
        ScanSpool::Place place;  ///< as of an Entry
    };

    void readThrough();
    bool add(const SourceItem& item);
    void append(const SourceItem& item);
    void appendImage(const mrpt::obs::CObservationImage& image);
    ScanSpool::Place placeOf(const mrpt::obs::CObservation& observation);
    void finish();
    void report(const std::string& problem, bool usage);
    Entry entry(std::size_t index) const;
    mrpt::obs::CObservation::Ptr readAt(const ScanSpool::Place& place) const;

    std::string path_;
    ScanSelection selection_;
    ExternalFiles files_;  ///< that the rawlog names
    std::unique_ptr<ScanSource> source_;
    std::unique_ptr<ScanSpool> spool_;  ///< null for rawlogs that are not compressed
    std::optional<std::string> label_;
    std::size_t seen_ = 0;               ///< scans of the lidar read so far
    std::optional<std::size_t> object_;  ///< of the item read last
    std::uint64_t part_ = 0;             ///< its number among the items of its object

    mutable std::mutex mutex_;
    mutable std::condition_variable grown_;
    std::vector<Entry> entries_;
    std::vector<std::string> cameras_;
    std::map<std::string, std::vector<ImageEntry>> images_;  ///< by camera, in the order of the file
    std::string problem_;
    std::atomic<bool> usage_{false};
    std::atomic<bool> complete_{false};
    std::atomic<bool> stop_{false};
    std::atomic<double> progress_{0.0};
    std::thread thread_;
};

}  // namespace lidar_obstacles::apps
