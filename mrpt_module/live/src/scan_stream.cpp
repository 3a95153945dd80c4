// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/live/scan_stream.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

#include "lidar_obstacles/mrpt_bridge/turn_assembler.h"
#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"

namespace lidar_obstacles::live {
namespace {

using Scan = mrpt::obs::CObservationVelodyneScan;

constexpr double kPause = 0.1;     // [s] without packets: the scan is over
constexpr double kBehind = 180.0;  // [deg]
constexpr std::size_t kMaxReports = 32;
constexpr double kReportEvery = 1.0;  // [s] of a kind

const char* modeName(std::uint8_t mode) {
    return mode == Scan::RETMODE_DUAL ? "dual" : mode == Scan::RETMODE_LAST ? "last" : "strongest";
}

/// True for a data packet as the known sensors send them: all blocks begin as they should.
bool isDataPacket(const Scan::TVelodyneRawPacket& packet) {
    const std::uint8_t mode = packet.laser_return_mode;
    return TurnAssembler::isKnownModel(packet) && mode >= Scan::RETMODE_STRONGEST && mode <= Scan::RETMODE_DUAL &&
           std::all_of(std::begin(packet.blocks), std::end(packet.blocks), isUsable);
}

int cutUnits(double deg) {
    const double turns = deg / 360.0;
    return static_cast<int>(std::lround((turns - std::floor(turns)) * 36000.0)) % 36000;
}

std::string seconds(double s) {
    char text[40];
    std::snprintf(text, sizeof text, "%.1f s", s);
    return text;
}

}  // namespace

ScanStream::ScanStream(StreamOptions options)
    : options_(std::move(options)),
      assembler_(
          std::make_unique<TurnAssembler>(options_.sensor_label, cutUnits(options_.cut_azimuth_deg.value_or(kBehind)))),
      cut_(cutUnits(options_.cut_azimuth_deg.value_or(kBehind))) {
    reported_.fill(-1.0);
}

ScanStream::~ScanStream() = default;
ScanStream::ScanStream(ScanStream&&) noexcept = default;
ScanStream& ScanStream::operator=(ScanStream&&) noexcept = default;

std::optional<LiveScan> ScanStream::add(const Datagram& datagram) {
    ++counts_.datagrams;
    if (last_good_ < 0.0) last_good_ = datagram.arrival;  // silence counts from here
    Packet packet;
    if (datagram.length != kDataPacketBytes) {
        ++counts_.malformed;
        report(Kind::Malformed, datagram.arrival,
               "not a data packet of a known sensor: " + std::to_string(datagram.length) + " bytes from " +
                   addressText(datagram.sender));
        return std::nullopt;
    }
    std::memcpy(&packet, datagram.bytes.data(), sizeof packet);
    if (!accepts(datagram, packet) || !admit(datagram, packet)) return std::nullopt;
    ++counts_.packets;
    auto ended = assembler_->add(packet, datagram.time);
    if (ended) {
        packets_of_whole_ = std::exchange(packets_in_scan_, 0);
        moveCut();
    }
    ++packets_in_scan_;
    std::optional<LiveScan> scan = finish(std::move(ended));
    last_in_scan_ = datagram.arrival;
    return scan;
}

bool ScanStream::accepts(const Datagram& datagram, const Packet& packet) {
    const bool wrong_sender = options_.sender && datagram.sender != *options_.sender;
    const std::string from = " from " + addressText(datagram.sender);
    if (!wrong_sender && !isDataPacket(packet)) {
        ++counts_.malformed;
        report(Kind::Malformed, datagram.arrival, "not a data packet of a known sensor:" + from);
        return false;
    }
    if (wrong_sender || (has_sensor_ && (datagram.sender != sender_ || packet.velodyne_model_ID != model_))) {
        ++counts_.foreign;
        report(Kind::Foreign, datagram.arrival, "packets of another sensor" + from + " are left out");
        return false;
    }
    return true;
}

/// True for a packet of another sensor than the last one that was listened to.
bool ScanStream::isAnother(const Datagram& datagram, const Packet& packet) const {
    return datagram.sender != sender_ || packet.velodyne_model_ID != model_;
}

bool ScanStream::admit(const Datagram& datagram, const Packet& packet) {
    using Verdict = PacketSequence::Verdict;
    const double now = datagram.arrival;
    const std::uint32_t clock = packet.gps_timestamp();
    const bool another_mode = !isAnother(datagram, packet) && packet.laser_return_mode != mode_;
    if (isAnother(datagram, packet)) view_.restart();
    if (isAnother(datagram, packet) || (another_mode && sequence_.fitsNext(clock, datagram.steady_time)))
        sequence_.restart();  // another clock, another rhythm
    const auto missing = sequence_.lost(), restarts = sequence_.restarts();
    const double period = packetPeriod(packet.velodyne_model_ID, packet.laser_return_mode);
    Verdict verdict = sequence_.add(clock, period, datagram.steady_time);
    if (another_mode && verdict == Verdict::Late) verdict = Verdict::Unclear;
    if (verdict == Verdict::Next) view_.add(packet, sequence_.lost() - missing);
    if (verdict == Verdict::Late) view_.addLate(packet);
    countLost(now);
    counts_.restarts = sequence_.restarts();
    if (counts_.restarts > restarts) report(Kind::Restart, now, "the sensor restarted, or its clock was set");
    countVerdict(verdict, now);
    if (verdict != Verdict::Next && verdict != Verdict::Late) return false;
    noticeMode(datagram, packet);
    last_good_ = now;
    return true;
}

/// A sensor that does not look somewhere sends nothing from there: that is no loss.
void ScanStream::countLost(double now) {
    const std::size_t before = counts_.lost;
    counts_.lost = sequence_.lost() - std::min(sequence_.lost(), view_.excused());
    if (counts_.lost > before) report(Kind::Lost, now, std::to_string(counts_.lost - before) + " packets lost");
}

void ScanStream::countVerdict(PacketSequence::Verdict verdict, double now) {
    using Verdict = PacketSequence::Verdict;
    if (verdict == Verdict::Late) {
        ++counts_.late;
        report(Kind::Late, now, "a packet came late");
    } else if (verdict == Verdict::Duplicate) {
        ++counts_.duplicates;
        report(Kind::Duplicate, now, "a packet came twice and is left out");
    } else if (verdict == Verdict::Unclear) {
        ++counts_.unclear;
        report(Kind::Unclear, now, "a packet's clock fits no other; it is left out");
    }
}

void ScanStream::noticeMode(const Datagram& datagram, const Packet& packet) {
    const std::string mode = modeName(packet.laser_return_mode);
    if (!has_sensor_) {
        report(Kind::Data, datagram.arrival,
               std::string("data of a ") + velodyneKind(packet.velodyne_model_ID)->name + " (" + mode +
                   " return) from " + addressText(datagram.sender));
    } else if (silent_) {
        report(Kind::Data, datagram.arrival, "data again after " + seconds(datagram.arrival - last_good_));
    }
    if (!isAnother(datagram, packet) && packet.laser_return_mode != mode_) {
        ++counts_.mode_changes;
        report(Kind::Mode, datagram.arrival, "the return mode changed to " + mode);
    }
    has_sensor_ = true;
    silent_ = false;
    sender_ = datagram.sender;
    model_ = packet.velodyne_model_ID;
    mode_ = packet.laser_return_mode;
}

std::optional<LiveScan> ScanStream::idle(double now) {
    if (last_good_ < 0.0) last_good_ = now;
    const double silence = now - last_good_;
    if (!silent_ && silence >= options_.no_data_after) {
        silent_ = true;
        ++counts_.outages;
        if (reports_.size() < kMaxReports) reports_.push_back("no data for " + seconds(silence));
        if (!options_.sender) has_sensor_ = false;  // another may take its place
    }
    return silence > kPause ? flush() : std::nullopt;
}

std::optional<LiveScan> ScanStream::flush() {
    packets_in_scan_ = 0;
    return finish(assembler_->flush());
}

std::optional<LiveScan> ScanStream::end() {
    const bool is_cut_off = view_.middleOfGap() && 3 * packets_in_scan_ < 2 * packets_of_whole_;
    if (!is_cut_off) return flush();
    assembler_->flush();
    counts_.packets -= packets_in_scan_;
    counts_.unfinished = std::exchange(packets_in_scan_, 0);
    return std::nullopt;
}

/// To where the sensor does not look, unless it was said where to cut.
void ScanStream::moveCut() {
    if (options_.cut_azimuth_deg) return;
    const int behind = cutUnits(kBehind);
    const int wanted = view_.isOutside(behind) ? behind : view_.middleOfGap().value_or(behind);
    if (wanted == cut_ || view_.isOutside(cut_)) return;
    cut_ = wanted;
    assembler_->setCut(wanted);
}

std::optional<LiveScan> ScanStream::finish(Scan::Ptr scan) {
    if (!scan) return std::nullopt;
    scan->sensorPose = options_.sensor_pose;
    return LiveScan{scan, counts_.scans++, last_in_scan_};
}

void ScanStream::report(Kind kind, double now, const std::string& text) {
    double& last = reported_[static_cast<std::size_t>(kind)];
    const bool often = kind == Kind::Data || kind == Kind::Mode || kind == Kind::Restart;
    if (last >= 0.0 && (!often || now - last < kReportEvery)) return;
    last = now;
    if (reports_.size() < kMaxReports) reports_.push_back(often ? text : text + " (told once, then counted)");
}

std::vector<std::string> ScanStream::takeReports() { return std::exchange(reports_, {}); }

}  // namespace lidar_obstacles::live
