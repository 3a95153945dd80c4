// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/live/recorder.h"

#include <stdexcept>

namespace lidar_obstacles::live {
namespace {

constexpr std::size_t kWaiting = 50;  // scans: 5 s, some 5 MB

}  // namespace

Recorder::Recorder(const std::string& file) : writer_(file), queue_(kWaiting), thread_([this] { work(); }) {}

Recorder::~Recorder() {
    try {
        finish();
    } catch (const std::exception&) {  // finish() before if it matters
    }
}

void Recorder::add(const LiveScan& scan, bool may_drop) {
    if (!may_drop)
        queue_.pushWaiting(scan);
    else if (!queue_.push(scan))
        ++dropped_;
}

void Recorder::work() {
    while (const auto scan = queue_.pop()) {
        if (failed_) {
            ++dropped_;
            continue;
        }
        try {
            writer_.append(*scan->observation);
            ++written_;
        } catch (const std::exception& e) {
            error_ = e.what();
            failed_ = true;
            ++dropped_;
        }
    }
}

void Recorder::finish() {
    if (!thread_.joinable()) return;
    queue_.close();
    thread_.join();
    writer_.close();
    if (failed_) throw std::runtime_error(error_ + " (it holds the first " + std::to_string(written_) + " scans)");
}

}  // namespace lidar_obstacles::live
