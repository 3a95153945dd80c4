// SPDX-License-Identifier: BSD-3-Clause
#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "lidar_obstacles/mrpt_bridge/scan_source.h"

namespace lidar_obstacles {
namespace {

using mrpt::obs::VelodyneCalibration;

constexpr FiringTimes kVlp16{16, 1, 2.304, 55.296, 110.592, 0.002};
constexpr FiringTimes kHdl32{32, 1, 1.152, 46.08, 46.08, 0.002};
constexpr FiringTimes kVlp32c{32, 2, 2.304, 55.296, 55.296, 0.004};

constexpr std::array<VelodyneKind, 6> kKinds{{{0x22, "VLP-16", "vlp-16", kVlp16},
                                              {0x24, "Puck Hi-Res", "puck-hi-res", kVlp16},
                                              {0x21, "HDL-32E", "hdl-32e", kHdl32},
                                              {0x28, "VLP-32C", "vlp-32c", kVlp32c},
                                              {0x31, "Velarray", nullptr, {}},
                                              {0xa1, "VLS-128", nullptr, {}}}};

/// Elevation and azimuth of a laser beside the block's azimuth, clockwise [deg].
struct Beam {
    double elevation;
    double azimuth;
};

template <std::size_t N>
VelodyneCalibration calibrationFrom(const std::array<Beam, N>& beams) {
    VelodyneCalibration calibration;
    for (const Beam& beam : beams) {
        VelodyneCalibration::PerLaserCalib laser{};
        setElevation(laser, beam.elevation);
        laser.azimuthCorrection = -beam.azimuth;  // counter-clockwise, as MRPT has it
        calibration.laser_corrections.push_back(laser);
    }
    return calibration;
}

/// The Puck Hi-Res fires as the VLP-16 does, its elevations are two thirds of those.
const VelodyneCalibration& puckHiRes() {
    static const VelodyneCalibration calibration = [] {
        std::array<Beam, 16> beams{};
        for (std::size_t k = 0; k < beams.size(); ++k) {
            const auto ring = static_cast<double>(k % 2 == 0 ? k / 2 : 8 + k / 2);
            beams[k] = {-10.0 + ring * 4.0 / 3.0, 0.0};
        }
        return calibrationFrom(beams);
    }();
    return calibration;
}

const VelodyneCalibration& vlp32c() {
    static const VelodyneCalibration calibration = calibrationFrom(std::array<Beam, 32>{
        {{-25.0, 1.4},   {-1.0, -4.2},  {-1.667, 1.4},  {-15.639, -1.4}, {-11.31, 1.4},  {0.0, -1.4},    {-0.667, 4.2},
         {-8.843, -1.4}, {-7.254, 1.4}, {0.333, -4.2},  {-0.333, 1.4},   {-6.148, -1.4}, {-5.333, 4.2},  {1.333, -1.4},
         {0.667, 4.2},   {-4.0, -1.4},  {-4.667, 1.4},  {1.667, -4.2},   {1.0, 1.4},     {-3.667, -4.2}, {-3.333, 4.2},
         {3.333, -1.4},  {2.333, 1.4},  {-2.667, -1.4}, {-3.0, 1.4},     {7.0, -1.4},    {4.667, 1.4},   {-2.333, -4.2},
         {-2.0, 4.2},    {15.0, -1.4},  {10.333, 1.4},  {-1.333, -1.4}}});
    return calibration;
}

/// MRPT notes what it has loaded without a lock: it is asked once, for both.
struct OfMrpt {
    VelodyneCalibration hdl32e = VelodyneCalibration::LoadDefaultCalibration("HDL32");
    VelodyneCalibration vlp16 = VelodyneCalibration::LoadDefaultCalibration("VLP16");
};

const OfMrpt& ofMrpt() {
    static const OfMrpt calibrations;
    return calibrations;
}

}  // namespace

const VelodyneKind* velodyneKind(std::uint8_t id) {
    const auto* it = std::find_if(kKinds.begin(), kKinds.end(), [id](const auto& kind) { return kind.id == id; });
    return it == kKinds.end() ? nullptr : it;
}

const VelodyneCalibration* calibrationOf(std::uint8_t id) {
    switch (id) {
        case 0x21:
            return &ofMrpt().hdl32e;
        case 0x22:
            return &ofMrpt().vlp16;
        case 0x24:
            return &puckHiRes();
        case 0x28:
            return &vlp32c();
        default:
            return nullptr;
    }
}

void setElevation(VelodyneCalibration::PerLaserCalib& laser, double elevation) {
    laser.verticalCorrection = elevation;
    laser.sinVertCorrection = std::sin(elevation * M_PI / 180.0);
    laser.cosVertCorrection = std::cos(elevation * M_PI / 180.0);
}

std::optional<std::uint8_t> velodyneKindOf(const std::string& word) {
    for (const VelodyneKind& kind : kKinds)
        if (kind.word && word == kind.word) return kind.id;
    return std::nullopt;
}

std::vector<std::string> sensorModels() {
    std::vector<std::string> words;
    for (const VelodyneKind& kind : kKinds)
        if (kind.word) words.emplace_back(kind.word);
    return words;
}

bool isUsable(const mrpt::obs::CObservationVelodyneScan::raw_block_t& block) {
    using Scan = mrpt::obs::CObservationVelodyneScan;
    return block.header() == Scan::UPPER_BANK && block.rotation() < Scan::ROTATION_MAX_UNITS;
}

bool hasLowerLasers(const mrpt::obs::CObservationVelodyneScan::TVelodyneRawPacket& packet) {
    return std::any_of(std::begin(packet.blocks), std::end(packet.blocks), [](const auto& block) {
        return block.header() == mrpt::obs::CObservationVelodyneScan::LOWER_BANK;
    });
}

double withinHalfHour(double us) {
    constexpr double kHour = 3600e6;  // [us]
    return us - kHour * std::floor(us / kHour + 0.5);
}

double clockStep(std::uint32_t from, std::uint32_t to) {
    return withinHalfHour(static_cast<double>(to) - static_cast<double>(from));
}

std::string velodyneWords() {
    std::string text;
    for (const std::string& word : sensorModels()) text += (text.empty() ? "" : ", ") + word;
    return text;
}

}  // namespace lidar_obstacles
