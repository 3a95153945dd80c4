#include "mrpt_bridge/input/turn_assembler.h"

#include <utility>

#include "mrpt_bridge/input/velodyne_timing.h"

namespace lidar_obstacles {
namespace {

using Scan = TurnAssembler::Scan;

constexpr int kFullTurn = Scan::ROTATION_MAX_UNITS;
constexpr std::size_t kMaxPackets = 1000;  // of a sensor that does not turn
constexpr double kReordered = 0.02;        // [s] packets overtake each other within less than this
constexpr double kPause = 0.1;             // [s] what follows after this is a turn of its own

/// Name of MRPT's default calibration; null for models that have none.
const char* calibrationName(std::uint8_t model) { return model == 0x21 ? "HDL32" : model == 0x22 ? "VLP16" : nullptr; }

bool isBehind(int azimuth, int reference) { return (azimuth - reference + kFullTurn) % kFullTurn > kFullTurn / 2; }

}  // namespace

bool TurnAssembler::isKnownModel(const Scan::TVelodyneRawPacket& packet) {
    return calibrationName(packet.velodyne_model_ID) != nullptr;
}

bool TurnAssembler::endsTurn(int azimuth, double time) const {
    if (scan_->scan_packets.size() >= kMaxPackets || time - last_time_ > kPause) return true;
    const bool late = isBehind(azimuth, last_azimuth_) && time - last_time_ < kReordered;
    return !late && azimuth < last_azimuth_;
}

Scan::Ptr TurnAssembler::add(const Scan::TVelodyneRawPacket& packet, double time) {
    const bool has_azimuth = isUsable(packet.blocks[0]);
    const int azimuth = has_azimuth ? (packet.blocks[0].rotation() - cut_ + kFullTurn) % kFullTurn : last_azimuth_;
    Scan::Ptr ended = scan_ && endsTurn(azimuth, time) ? flush() : nullptr;
    if (!scan_) {
        scan_ = std::make_shared<Scan>();
        scan_->sensorLabel = label_;
        scan_->timestamp = mrpt::Clock::fromDouble(time);
        scan_->originalReceivedTimestamp = scan_->timestamp;
        scan_->minRange = 0.0;  // left to the user's parameters
        scan_->maxRange = Scan::DISTANCE_MAX;
        scan_->calibration =
            mrpt::obs::VelodyneCalibration::LoadDefaultCalibration(calibrationName(packet.velodyne_model_ID));
        last_azimuth_ = azimuth;
    }
    scan_->scan_packets.push_back(packet);
    if (!isBehind(azimuth, last_azimuth_) || time - last_time_ >= kReordered) last_azimuth_ = azimuth;
    last_time_ = time;
    return ended;
}

Scan::Ptr TurnAssembler::flush() { return std::exchange(scan_, nullptr); }

}  // namespace lidar_obstacles
