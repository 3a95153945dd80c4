// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/live/field_of_view.h"

#include <algorithm>
#include <cmath>

namespace lidar_obstacles::live {
namespace {

constexpr int kTurn = mrpt::obs::CObservationVelodyneScan::ROTATION_MAX_UNITS;
constexpr long kRemembered = 3L * kTurn;  // what was not seen for so long is not looked at
constexpr int kNarrowest = 15;            // [deg]
constexpr int kWidestPacket = 2000;       // [0.01 deg]: more is a jump
constexpr double kRounding = 2.0;         // [deg] at the two ends of a row of whole degrees

/// Whole packets in so many degrees, where one more may be cut by the border of the field of view.
std::size_t wholePackets(int degrees, double width) {
    return static_cast<std::size_t>(std::max(0.0, (degrees - kRounding) / width));
}

}  // namespace

void FieldOfView::add(const Packet& packet, std::size_t missing) {
    const int first = packet.blocks[0].rotation();
    const int step = newest_ < 0 ? 0 : (first - newest_ + kTurn) % kTurn;
    const long before = turned_;
    const int from = newest_;
    turned_ += step;
    newest_ = first;
    if (missing == 0) {
        if (step > 0 && step < kWidestPacket) width_ = step;
    } else if (width_ > 0) {
        const double turned = static_cast<double>(width_) * static_cast<double>(missing + 1);
        if (turned < step + kTurn / 2.0)
            excuse(from, first, missing, before);
        else if (middleOfGap())  // it was silent for whole turns
            excused_ += static_cast<std::size_t>(static_cast<double>(missing) * shareUnseen());
    }
    see(packet);
}

void FieldOfView::restart() {
    const std::size_t excused = excused_;
    *this = {};
    excused_ = excused;
}

bool FieldOfView::isUnseen(int bin) const {
    const long at = seen_at_[static_cast<std::size_t>(bin % kBins)];
    return at == 0 || turned_ - at > kRemembered;
}

/// Of a turn.
double FieldOfView::shareUnseen() const {
    int unseen = 0;
    for (int bin = 0; bin < kBins; ++bin) unseen += isUnseen(bin) ? 1 : 0;
    return static_cast<double>(unseen) / kBins;
}

int FieldOfView::narrowest() const { return std::max(kNarrowest, 2 * (width_ / 100 + 1) + 2); }

/// Looks for the sector that is not seen among what is missing from one azimuth to another. @param before  turned_ at
/// the packet before: what that one showed is not missing.
void FieldOfView::excuse(int from, int to, std::size_t missing, long before) {
    const int first = from / 100, last = to / 100 + (to < from ? kBins : 0);
    int begin = first, size = 0, run = 0;
    for (int bin = first; bin < last; ++bin) {
        run = isUnseen(bin) ? run + 1 : 0;
        if (run > size) size = run, begin = bin - run + 1;
    }
    if (size < narrowest()) return;
    const double width = 0.01 * width_;
    int ahead = 0, behind = 0;  // degrees on either side that are seen as a rule
    for (int bin = first; bin < last; ++bin) {
        if (bin >= begin && bin < begin + size) continue;
        if (seen_at_[static_cast<std::size_t>(bin % kBins)] == before) continue;
        bin < begin ? ++ahead : ++behind;
    }
    const std::size_t lost = std::min(missing, wholePackets(ahead, width) + wholePackets(behind, width));
    excused_ += missing - lost;
    if (turned_ <= kRemembered) unseen_.push_back({begin, size, missing - lost, turned_});
}

/// Notes what a packet shows. Where that is a sector that was taken to be out of sight, packets were lost there.
void FieldOfView::see(const Packet& packet) {
    const int border = width_ / 100 + 1;  // packets do not always end at the same azimuth
    for (const auto& block : packet.blocks) {
        const int bin = std::min(block.rotation() / 100, kBins - 1);
        seen_at_[static_cast<std::size_t>(bin)] = turned_;
        const auto end = std::remove_if(unseen_.begin(), unseen_.end(), [&](const Unseen& u) {
            if (turned_ - u.since > kRemembered) return true;
            const int inside = (bin - u.from % kBins + kBins) % kBins;
            if (inside < border || inside >= u.size - border) return false;
            excused_ -= u.packets;
            return true;
        });
        unseen_.erase(end, unseen_.end());
    }
}

bool FieldOfView::isOutside(int azimuth) const {
    const auto gap = [this](int bin) { return isUnseen((bin % kBins + kBins) % kBins); };
    const int bin = azimuth / 100;
    if (turned_ <= kRemembered || !gap(bin)) return false;
    int size = 1;
    for (int k = 1; k < kBins && gap(bin + k); ++k) ++size;
    for (int k = 1; k < kBins && gap(bin - k); ++k) ++size;
    return size >= narrowest();
}

std::optional<int> FieldOfView::middleOfGap() const {
    if (turned_ <= kRemembered) return std::nullopt;
    int widest = 0, middle = 0, run = 0;
    for (int k = 0; k < 2 * kBins; ++k) {  // twice around, for gaps across zero
        run = isUnseen(k) ? run + 1 : 0;
        if (run <= widest || run > kBins) continue;
        widest = run;
        middle = 100 * ((k - run / 2 + kBins) % kBins);
    }
    return widest < narrowest() ? std::nullopt : std::optional<int>(middle);
}

}  // namespace lidar_obstacles::live
