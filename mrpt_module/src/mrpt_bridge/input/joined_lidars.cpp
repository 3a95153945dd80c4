// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/joined_lidars.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "lidar_obstacles/joined_cloud.h"

namespace lidar_obstacles {
namespace {

constexpr double kApart = 0.1;           // half a turn of the slowest sensor [s]
constexpr double kAhead = 2.0 * kApart;  // then a nearer scan can come no more [s]
constexpr std::size_t kItems = 400;      // of an input whose stamps do not rise

/// Without spaces at its ends.
std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(' ');
    return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

}  // namespace

std::vector<std::string> JoinedLidars::namesIn(const std::string& choice) {
    std::vector<std::string> names;
    if (trimmed(choice) == "all") return names;
    for (std::size_t begin = 0; begin <= choice.size();) {
        const std::size_t comma = std::min(choice.find(',', begin), choice.size());
        const std::string name = trimmed(choice.substr(begin, comma - begin));
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        begin = comma + 1;
    }
    return names;
}

bool JoinedLidars::joins(const std::string& choice) { return trimmed(choice) == "all" || namesIn(choice).size() > 1; }

JoinedLidars::JoinedLidars(std::unique_ptr<ScanSource> source, const std::string& choice)
    : ScanSourceFilter(*source), owned_(std::move(source)), choice_(choice), names_(namesIn(choice)) {
    if (names_.empty()) return;
    first_ = names_.front();
    for (auto name = names_.begin() + 1; name != names_.end(); ++name) others_[*name] = {};
}

bool JoinedLidars::readOne() {
    auto item = source_.next();
    if (!item) return false;
    Entry entry{std::move(*item)};
    const SourceItem& read = entry.item;
    const bool is_wanted = names_.empty() || std::find(names_.begin(), names_.end(), read.lidar) != names_.end();
    entry.is_scan = is_wanted && !read.is_gap && read.observation && isLidarScan(*read.observation);
    if (entry.is_scan) {
        if (first_.empty()) first_ = read.lidar;
        if (read.lidar != first_) others_[read.lidar];
        entry.time = mrpt::Clock::toDouble(read.observation->timestamp);
    }
    ahead_.push_back(std::move(entry));
    return true;
}

/// Can nothing come any more that changes what becomes of the next item?
bool JoinedLidars::isReady() const {
    if (ahead_.empty()) return false;
    const Entry& front = ahead_.front();
    if (!front.is_scan || ahead_.size() >= kItems) return true;
    return std::any_of(ahead_.begin(), ahead_.end(), [&](const Entry& e) {
        const bool set_back = e.item.lidar == front.item.lidar && e.time < front.time - kAhead;
        return e.is_scan && (set_back || e.time >= front.time + kAhead);
    });
}

/// The scan of a lidar that is nearest in time; the end if none is near.
JoinedLidars::Entries::iterator JoinedLidars::nearestTo(const Entry& entry, const std::string& lidar) {
    auto nearest = ahead_.end();
    double apart = kApart;
    for (auto other = ahead_.begin(); other != ahead_.end(); ++other) {
        const double away = std::abs(other->time - entry.time);
        if (!other->is_scan || other->item.lidar != lidar || away > apart) continue;
        if (nearest != ahead_.end() && away == apart) continue;
        apart = away;
        nearest = other;
    }
    return nearest;
}

void JoinedLidars::join(Entry& first, Entries::iterator other) {
    first.item.beside.push_back(other->item.observation);
    first.beside.push_back(other->item.lidar);
    ++others_[other->item.lidar].joined;
    ahead_.erase(other);
}

/// The scans that are nearest to this one, and this to them.
void JoinedLidars::joinOthers(Entry& first) {
    for (const auto& [lidar, count] : others_) {
        if (std::find(first.beside.begin(), first.beside.end(), lidar) != first.beside.end()) continue;
        const auto other = nearestTo(first, lidar);
        if (other != ahead_.end() && &*nearestTo(*other, first_) == &first) join(first, other);
    }
}

/// True if the next item is a scan that was joined to a later one.
bool JoinedLidars::joinFront() {
    const Entry& front = ahead_.front();
    const auto first = nearestTo(front, first_);
    if (first == ahead_.end() || nearestTo(*first, front.item.lidar) != ahead_.begin()) return false;
    join(*first, ahead_.begin());
    return true;
}

std::optional<SourceItem> JoinedLidars::next() {
    for (;;) {
        while (!isReady())
            if (!readOne()) break;
        if (ahead_.empty()) return std::nullopt;
        Entry& front = ahead_.front();
        if (front.is_scan && front.item.lidar == first_)
            joinOthers(front);
        else if (front.is_scan && joinFront())
            continue;
        else if (front.is_scan)
            ++others_[front.item.lidar].alone;
        SourceItem item = std::move(front.item);
        ahead_.pop_front();
        objects_ = item.object + 1;
        if (item.lidar == first_ && !first_.empty()) {
            ++firsts_;
            item.lidar = choice_;
        }
        return item;
    }
}

std::string JoinedLidars::remarks() const {
    std::string text = source_.remarks();
    const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
    for (const auto& [lidar, count] : others_) {
        if (count.joined < firsts_)
            add(std::to_string(firsts_ - count.joined) + " of " + std::to_string(firsts_) + " scans of '" + first_ +
                "' without one of '" + lidar + "' (none within 0.1 s)");
        if (count.alone > 0)
            add(std::to_string(count.alone) + " scans of '" + lidar + "' left out, which belong to none of '" + first_ +
                "'");
    }
    return text;
}

PointCloud toPointCloud(const SourceItem& item, const SensorParams& params, DecodeStats* stats) {
    DecodeStats sum;
    std::vector<PointCloud> clouds;
    const auto add = [&](const mrpt::obs::CObservation* scan) {
        DecodeStats one;
        auto cloud = scan ? toPointCloud(*scan, params, &one) : std::nullopt;
        if (!cloud) throw std::invalid_argument("toPointCloud: the item is no lidar scan");
        clouds.push_back(std::move(*cloud));
        sum.packets += one.packets;
        sum.retimed_packets += one.retimed_packets;
        sum.damaged_blocks += one.damaged_blocks;
        sum.without_rings |= one.without_rings;
        sum.times_left_out |= one.times_left_out;
    };
    add(item.observation.get());
    for (const auto& scan : item.beside) add(scan.get());
    if (stats) *stats = sum;
    return joinedCloud(std::move(clouds));
}

}  // namespace lidar_obstacles
