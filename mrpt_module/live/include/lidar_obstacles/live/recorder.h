// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Records scans while they are used.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "lidar_obstacles/live/bounded_queue.h"
#include "lidar_obstacles/live/scan_stream.h"
#include "lidar_obstacles/mrpt_bridge/rawlog_writer.h"

namespace lidar_obstacles::live {

/// Writes scans to a rawlog on a thread of its own, so that a slow disk delays nobody. Up to 50 scans wait for the
/// disk, then the oldest is dropped and counted. A disk that cannot be written any more (full) ends the recording,
/// not the program: the file then holds the scans up to there.
/// add() and what only asks may be called from any thread; finish() once, when nobody adds any more.
class Recorder {
  public:
    /// @throws std::runtime_error naming the file and the reason.
    explicit Recorder(const std::string& file);
    /// As finish(); errors are lost here.
    ~Recorder();

    /// Hands a scan over; from any thread. @param may_drop  false: waits for the disk instead.
    void add(const LiveScan& scan, bool may_drop);
    /// Writes what waits and completes the file. @throws std::runtime_error if scans could not be written.
    void finish();

    /// Why the recording ended before its time; empty if it did not. May be asked while it runs.
    std::string error() const { return failed_ ? error_ : ""; }
    std::size_t written() const { return written_; }
    std::size_t dropped() const { return dropped_; }

  private:
    void work();

    RawlogWriter writer_;
    BoundedQueue<LiveScan> queue_;
    std::atomic<std::size_t> written_{0};
    std::atomic<std::size_t> dropped_{0};
    std::atomic<bool> failed_{false};
    std::string error_;  ///< set once, before `failed_`
    std::thread thread_;
};

}  // namespace lidar_obstacles::live
