// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// A queue between two threads that never grows.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>

namespace lidar_obstacles::live {

/// First in, first out. A full one drops the oldest (push) or makes the giver wait (pushWaiting).
/// All members may be called from any thread.
template <typename T>
class BoundedQueue {
  public:
    /// @param capacity  at least 1.
    explicit BoundedQueue(std::size_t capacity) : capacity_(capacity < 1 ? 1 : capacity) {}

    /// @return false if something was dropped to make room. Nothing is taken in after close().
    bool push(T item) {
        const std::lock_guard lock(mutex_);
        if (closed_) return true;
        const bool full = items_.size() >= capacity_;
        if (full) items_.pop_front();
        items_.push_back(std::move(item));
        changed_.notify_all();
        return !full;
    }

    /// Waits for room; gives up at close().
    void pushWaiting(T item) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return closed_ || items_.size() < capacity_; });
        if (closed_) return;
        items_.push_back(std::move(item));
        changed_.notify_all();
    }

    /// Waits for the next item; nullopt when the queue is closed and empty.
    std::optional<T> pop() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return closed_ || !items_.empty(); });
        return takeFirst();
    }

    /// The same, but gives up after `timeout` [s].
    std::optional<T> pop(double timeout) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, std::chrono::duration<double>(timeout), [this] { return closed_ || !items_.empty(); });
        return takeFirst();
    }

    /// True once the queue is closed and everything was taken.
    bool ended() const {
        const std::lock_guard lock(mutex_);
        return closed_ && items_.empty();
    }

    /// Nothing goes in any more; what is there can still be taken.
    void close() {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        changed_.notify_all();
    }

  private:
    std::optional<T> takeFirst() {
        if (items_.empty()) return std::nullopt;
        std::optional<T> item(std::move(items_.front()));
        items_.pop_front();
        changed_.notify_all();
        return item;
    }

    const std::size_t capacity_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<T> items_;
    bool closed_ = false;
};

}  // namespace lidar_obstacles::live
