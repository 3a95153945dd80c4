// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/live/live_scanner.h"

#include <utility>

namespace lidar_obstacles::live {
namespace {

constexpr double kWait = 0.05;  // [s] for data: how soon a stop is noticed
constexpr std::size_t kMaxReports = 64;

}  // namespace

LiveScanner::LiveScanner(std::unique_ptr<PacketSource> source, const ScannerOptions& options)
    : source_(std::move(source)), options_(options), stream_(options.stream), queue_(options.queue), thread_([this] {
          work();
      }) {}

LiveScanner::~LiveScanner() {
    stop_ = true;
    queue_.close();
    thread_.join();
}

std::optional<LiveScan> LiveScanner::next(double timeout) {
    auto scan = queue_.pop(timeout);
    if (!scan && ended() && error_) std::rethrow_exception(std::exchange(error_, nullptr));
    return scan;
}

void LiveScanner::work() {
    try {
        read();
    } catch (...) {
        error_ = std::current_exception();
    }
    publish();
    queue_.close();
}

void LiveScanner::read() {
    while (!stop_ && !source_->ended()) {
        double now = -1.0;
        source_->receive(kWait, [&](const Datagram& datagram) {
            deliver(stream_.add(datagram));
            now = datagram.arrival;  // not the clock: more may wait already
        });
        if (options_.may_drop) deliver(stream_.idle(now < 0.0 ? steadyClock() : now));
        publish();
    }
    deliver(stream_.end());
}

void LiveScanner::deliver(std::optional<LiveScan> scan) {
    if (!scan) return;
    if (options_.recorder) options_.recorder->add(*scan, options_.may_drop);
    if (!options_.may_drop)
        queue_.pushWaiting(std::move(*scan));
    else if (!queue_.push(std::move(*scan)))
        ++dropped_;
}

void LiveScanner::publish() {
    const std::lock_guard lock(mutex_);
    counts_ = {stream_.counts(), dropped_, source_->overflows()};
    for (std::string& text : stream_.takeReports())
        if (reports_.size() < kMaxReports) reports_.push_back(std::move(text));
}

ScannerCounts LiveScanner::counts() const {
    const std::lock_guard lock(mutex_);
    return counts_;
}

std::vector<std::string> LiveScanner::takeReports() {
    const std::lock_guard lock(mutex_);
    return std::exchange(reports_, {});
}

}  // namespace lidar_obstacles::live
