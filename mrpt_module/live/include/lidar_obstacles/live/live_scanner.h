// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Scans as they happen: read this first.
///
///     LiveScanner scanner(std::make_unique<UdpSource>(Endpoint{}), {});
///     LiveDetector detector(params);  // live_detector.h; poses, if there are any: detector.addPose(pose)
///     while (!scanner.ended()) {
///         if (const auto scan = scanner.next(0.1)) {
///             const SequenceResult found = detector.process(*scan);
///             ...
///         }
///     }
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "lidar_obstacles/live/bounded_queue.h"
#include "lidar_obstacles/live/packet_source.h"
#include "lidar_obstacles/live/recorder.h"
#include "lidar_obstacles/live/scan_stream.h"

namespace lidar_obstacles::live {

struct ScannerOptions {
    StreamOptions stream;
    std::size_t queue = 2;         ///< scans that wait for whoever calls next()
    bool may_drop = true;          ///< a full queue drops its oldest scan; false: the source waits (captures)
    Recorder* recorder = nullptr;  ///< gets every scan; not owned
};

struct ScannerCounts {
    StreamCounts stream;
    std::size_t dropped = 0;    ///< scans that were not fetched in time
    std::size_t overflows = 0;  ///< datagrams that the system threw away because the reader was late
};

/// Reads a source on a thread of its own and holds its scans ready.
/// next() and damage() are for one thread at a time, all else may be called from any thread.
class LiveScanner {
  public:
    LiveScanner(std::unique_ptr<PacketSource> source, const ScannerOptions& options);
    /// Stops the thread.
    ~LiveScanner();

    /// Waits up to `timeout` [s] for the next scan. @throws what the source threw, when the scans before are fetched.
    std::optional<LiveScan> next(double timeout);
    /// True when the source ended or stop() was called, and all scans before were fetched.
    bool ended() const { return queue_.ended(); }
    /// Ends the reading within 0.1 s; the scan that has been begun is still delivered. From any thread.
    void stop() { stop_ = true; }

    ScannerCounts counts() const;
    /// See ScanStream::takeReports().
    std::vector<std::string> takeReports();
    /// See PacketSource::damage(); to be asked at the end.
    std::string damage() const { return source_->damage(); }

  private:
    void read();
    void work();
    void deliver(std::optional<LiveScan> scan);
    void publish();

    std::unique_ptr<PacketSource> source_;
    ScannerOptions options_;
    ScanStream stream_;  ///< of the thread
    BoundedQueue<LiveScan> queue_;
    std::atomic<bool> stop_{false};
    std::exception_ptr error_;  ///< of the thread; to be read when the queue is closed
    mutable std::mutex mutex_;  ///< of the next two
    ScannerCounts counts_;
    std::vector<std::string> reports_;
    std::size_t dropped_ = 0;  ///< of the thread
    std::thread thread_;
};

}  // namespace lidar_obstacles::live
