// SPDX-License-Identifier: BSD-3-Clause
#include "player.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>

namespace lidar_obstacles::apps {
namespace {

constexpr std::size_t kKept = 4;  // some 2 MB each

/// Longest wait for the next scan: recordings have gaps [s].
constexpr double kLongestWait = 1.0;

std::optional<double> number(const std::string& text) {
    double value = 0.0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || !(value >= 0.0) || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// Seconds of "12.5s" or "1:05".
std::optional<double> seconds(const std::string& text) {
    if (!text.empty() && (text.back() == 's' || text.back() == 'S')) return number(text.substr(0, text.size() - 1));
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return std::nullopt;
    const auto minutes = number(text.substr(0, colon));
    const auto rest = number(text.substr(colon + 1));
    if (!minutes || !rest) return std::nullopt;
    return 60.0 * *minutes + *rest;
}

}  // namespace

Player::Player(const ScanStore& store, const DetectorSetup& setup, TruthByScan truth)
    : store_(store), truth_(std::move(truth)) {
    poses_ = posesFor(setup.params);
    sequence_ = sequenceFor(setup, poses_);
    seek(0);
}

std::optional<Player::Poses> Player::posesFor(const DetectorParams& params) const {
    if (!usesPoses(params) || (poses_ && poses_->source == params.ego.source)) return poses_;
    if (params.ego.source == "none") return Poses{params.ego.source, nullptr};
    return Poses{params.ego.source, std::make_shared<const PoseIndex>(store_.path(), params.ego.source)};
}

std::unique_ptr<Sequence> Player::sequenceFor(const DetectorSetup& setup, const std::optional<Poses>& poses) const {
    const bool used = poses && usesPoses(setup.params);
    return std::make_unique<Sequence>(store_, used ? poses->index : nullptr, setup);
}

/// What is shown is done again when its poses are known, and when all are: some may have come late.
void Player::settle() {
    if (provisional_ && sequence_->ready(position_)) show(position_);
    if (settled_ || !poses() || !poses()->complete()) return;
    settled_ = true;
    ++generation_;
    kept_.clear();
    sequence_->restart();
    if (shown_) show(position_);
}

bool Player::tick(double now) {
    settle();
    if (wanted_) {
        const auto index = found(*wanted_);
        if (index && (!shown_ || sequence_->ready(*index))) {
            wanted_.reset();
            shown_at_ = now;
            show(*index);
        }
    } else if (playing_) {
        advance(now);
    }
    const bool other = shown_ != told_;
    told_ = shown_;
    return other;
}

void Player::play(double now) {
    if (playing_) return;
    const bool at_end = store_.complete() && position_ + 1 >= store_.size();
    const bool outside = range_ && (position_ < range_->first || position_ >= range_->second);
    if (!wanted_ && (at_end || outside)) seek(range_ ? range_->first : 0);  // again from the beginning
    playing_ = true;
    shown_at_ = now;
}

std::size_t Player::aim() const {
    if (!wanted_ || wanted_->target != Target::Place) return position_;
    return std::min(static_cast<std::size_t>(wanted_->value), std::max<std::size_t>(1, store_.size()) - 1);
}

void Player::setRange(std::optional<std::pair<std::size_t, std::size_t>> range) {
    if (range && range->first >= range->second)
        throw std::invalid_argument("a range ends after it begins: choose a later scan for its end");
    range_ = range;
}

void Player::setSpeed(int at, double now) {
    speed_at_ = std::clamp(at, 0, static_cast<int>(kSpeeds.size()) - 1);
    shown_at_ = now;
}

void Player::step(std::ptrdiff_t scans) {
    double from = static_cast<double>(position_);
    if (wanted_ && wanted_->target == Target::Place) from = wanted_->value;
    seek(static_cast<std::size_t>(std::max(0.0, from + static_cast<double>(scans))));
}

void Player::last() { want({Target::Last, 0.0}); }

void Player::jump(const std::string& where) {
    if (const auto scan = number(where)) return want({Target::Scan, *scan});
    if (const auto time = seconds(where)) return want({Target::Time, *time});
    throw std::invalid_argument("'" + where + "' is neither a scan number (120) nor a time (12.5s, 1:05)");
}

void Player::want(const Wanted& wanted) {
    playing_ = false;
    wanted_ = wanted;
}

/// The place of what is wanted; nothing while the index may still come to it.
std::optional<std::size_t> Player::found(const Wanted& wanted) const {
    const bool complete = store_.complete();  // asked before the size: it does not grow any more then
    const std::size_t size = store_.size();
    if (size == 0) return std::nullopt;
    switch (wanted.target) {
        case Target::Place:
            if (wanted.value < static_cast<double>(size)) return static_cast<std::size_t>(wanted.value);
            break;
        case Target::Scan:
            if (static_cast<double>(store_.scanIndex(size - 1)) >= wanted.value)
                return store_.atScanIndex(static_cast<std::size_t>(std::ceil(wanted.value)));
            break;
        case Target::Time:
            if (store_.time(size - 1) - store_.time(0) >= wanted.value)
                return store_.atTime(store_.time(0) + wanted.value);
            break;
        case Target::Last:
            break;
    }
    if (complete) return size - 1;
    return std::nullopt;
}

void Player::advance(double now) {
    if (!shown_) return;
    const bool complete = store_.complete();
    const bool end = range_ ? position_ >= range_->second : position_ + 1 >= store_.size();
    if (end && !range_ && !complete) return;  // the index will come to it
    if (end && !loop_) return pause();
    if (!end && position_ + 1 >= store_.size()) return;
    const double gap = end ? 0.1 : store_.time(position_ + 1) - store_.time(position_);
    const double due = shown_at_ + std::clamp(gap, 0.0, kLongestWait) / speed();
    const std::size_t next = end ? (range_ ? range_->first : 0) : position_ + 1;
    if (now < due || !sequence_->ready(next)) return;
    // a scan that came late does not make the next ones hurry
    shown_at_ = now - due > 0.1 ? now : due;
    show(next);
}

void Player::show(std::size_t index) {
    const auto known = std::find_if(kept_.begin(), kept_.end(), [&](const auto& k) { return k.first == index; });
    if (known != kept_.end()) {
        std::rotate(kept_.begin(), known, known + 1);
        shown_ = kept_.front().second;
        provisional_ = false;
    } else {
        const bool ready = sequence_->ready(index);
        shown_ = process(index, *sequence_);
        provisional_ = !ready;
        if (ready) keep(index, shown_);
    }
    position_ = index;
}

void Player::keep(std::size_t index, std::shared_ptr<const ShownScan> scan) {
    kept_.emplace_front(index, std::move(scan));
    if (kept_.size() > kKept) kept_.pop_back();
}

void Player::change(const DetectorSetup& setup) {
    validate(setup.params);
    auto poses = posesFor(setup.params);
    const bool complete = poses && poses->index && poses->index->complete();
    auto sequence = sequenceFor(setup, poses);
    const bool ready = !shown_ || sequence->ready(position_);
    std::shared_ptr<const ShownScan> again;
    if (shown_) again = process(position_, *sequence);
    poses_ = std::move(poses);
    sequence_ = std::move(sequence);
    settled_ = complete;
    ++generation_;
    provisional_ = !ready;
    kept_.clear();
    if (again && ready) keep(position_, again);
    if (again) shown_ = again;
}

std::shared_ptr<const ShownScan> Player::process(std::size_t index, Sequence& sequence) const {
    auto scan = sequence.process(index);
    if (const auto* truth = truthAt(index)) scan->truth = *truth;
    return scan;
}

const std::vector<TruthBox>* Player::truthAt(std::size_t index) const {
    const auto truth = truth_.find(store_.scanIndex(index));
    return truth == truth_.end() ? nullptr : &truth->second;
}

double Player::elapsed() const { return shown_ ? store_.time(position_) - store_.time(0) : 0.0; }

}  // namespace lidar_obstacles::apps
