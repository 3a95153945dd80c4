// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/velodyne_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace lidar_obstacles {
namespace {

using Scan = mrpt::obs::CObservationVelodyneScan;
using Laser = mrpt::obs::VelodyneCalibration::PerLaserCalib;

/// @param turned_deg  how far the sensor turned between the block's azimuth stamp and this firing.
ReturnModel returnModel(const Laser& laser, double turned_deg) {
    const double delta = (turned_deg - laser.azimuthCorrection) * M_PI / 180.0;
    const double cos_delta = std::cos(delta), sin_delta = std::sin(delta);
    const double cos_el = laser.cosVertCorrection, sin_el = laser.sinVertCorrection;
    const double h = laser.horizontalOffsetCorrection, v = laser.verticalOffsetCorrection;
    ReturnModel m{};
    // The vertical offset stands across the ray, as the sensor's maker means it: xy = d cos(el) - v sin(el),
    // z = d sin(el) + v cos(el). MRPT's decoder adds v sin(el) instead and leaves out the azimuth correction; both
    // are zero for the sensors that are decoded here.
    m.a = static_cast<float>(cos_el * cos_delta);
    m.b = static_cast<float>(cos_el * sin_delta);
    m.c = static_cast<float>(sin_el);
    m.a0 = static_cast<float>(-v * sin_el * cos_delta + h * sin_delta);
    m.b0 = static_cast<float>(-v * sin_el * sin_delta - h * cos_delta);
    m.c0 = static_cast<float>(v * cos_el);
    m.distance_correction = static_cast<float>(laser.distanceCorrection);
    return m;
}

/// The raw distances whose corrected range lies within the limits.
void setRawLimits(const RangeLimits& limits, double unit, ReturnModel& model) {
    constexpr double kSlack = 1e-6;  // 1 m / 0.002 m must not become 501 by rounding
    const double correction = model.distance_correction;
    const double lo = std::ceil((limits.min - correction) / unit - kSlack);
    const double hi = std::floor((limits.max - correction) / unit + kSlack);
    model.raw_min = 1;
    model.raw_max = 0;
    if (!(lo <= 65535.0 && hi >= 1.0)) return;                      // nothing, also where a limit is not a number
    model.raw_min = static_cast<std::uint16_t>(std::max(lo, 1.0));  // 0 = no return
    model.raw_max = static_cast<std::uint16_t>(std::min(hi, 65535.0));
}

/// Sines and cosines, degrees and metres of a calibration that was not damaged.
bool isSane(const Laser& laser) {
    const auto within = [](double value, double limit) { return std::abs(value) <= limit; };  // false for NaN
    return within(laser.sinVertCorrection, 1.001) && within(laser.cosVertCorrection, 1.001) &&
           within(laser.azimuthCorrection, 360.0) && within(laser.distanceCorrection, 100.0) &&
           within(laser.horizontalOffsetCorrection, 10.0) && within(laser.verticalOffsetCorrection, 10.0);
}

constexpr std::uint8_t kVlp16Id = 0x22, kHdl32Id = 0x21;

/// True for the calibration that MRPT takes for a VLP-16 or an HDL-32E, whatever the sensor was.
bool isDefault(const mrpt::obs::VelodyneCalibration& calibration) {
    const auto& lasers = calibration.laser_corrections;
    const auto& usual = calibrationOf(lasers.size() == 16 ? kVlp16Id : kHdl32Id)->laser_corrections;
    return std::equal(lasers.begin(), lasers.end(), usual.begin(), usual.end(), [](const Laser& a, const Laser& b) {
        return a.verticalCorrection == b.verticalCorrection && a.azimuthCorrection == b.azimuthCorrection &&
               a.distanceCorrection == b.distanceCorrection &&
               a.horizontalOffsetCorrection == b.horizontalOffsetCorrection &&
               a.verticalOffsetCorrection == b.verticalOffsetCorrection;
    });
}

/// The scan's calibration, unless there is none, or it is the default one of another sensor than the one its packets
/// name: recorders know no other for a Puck Hi-Res or a VLP-32C, or were told the wrong sensor.
const mrpt::obs::VelodyneCalibration& calibrationToUse(const Scan& scan) {
    if (scan.scan_packets.empty()) return scan.calibration;
    const auto* named = calibrationOf(scan.scan_packets.front().velodyne_model_ID);
    const std::size_t lasers = scan.calibration.laser_corrections.size();
    const bool fits = named == calibrationOf(lasers == 16 ? kVlp16Id : kHdl32Id) && lasers != 0;
    const bool is_own = fits || (lasers != 0 && !isDefault(scan.calibration));
    return named && !is_own ? *named : scan.calibration;
}

void checkCalibration(const mrpt::obs::VelodyneCalibration& calibration, const SensorParams& params) {
    const std::size_t lasers = calibration.laser_corrections.size();
    if (lasers != 16 && lasers != 32)
        throw std::runtime_error(
            "the scan's calibration has " + std::to_string(lasers) +
            " lasers; packets of 16 (VLP-16, Puck Hi-Res) and of 32 (HDL-32E, VLP-32C) can be decoded");
    for (const Laser& laser : calibration.laser_corrections)
        if (!isSane(laser)) throw std::runtime_error("the scan's calibration holds numbers that cannot be right");
    if (params.rings != 0 && params.rings != static_cast<int>(lasers))
        throw std::invalid_argument("[sensor] rings = " + std::to_string(params.rings) +
                                    ", but the scan's calibration has " + std::to_string(lasers) + " lasers");
}

/// Columns of the view from the block's azimuth to where a laser looks. @param step  of a column [0.01 deg].
int columnsOn(const Laser& laser, double step, int columns) {
    const auto on = static_cast<int>(std::lround(-100.0 * laser.azimuthCorrection / step)) % columns;
    return on < 0 ? on + columns : on;
}

}  // namespace

std::vector<int> ringOfLaser(const mrpt::obs::VelodyneCalibration& calibration) {
    const auto& lasers = calibration.laser_corrections;
    std::vector<std::size_t> by_elevation(lasers.size());
    std::iota(by_elevation.begin(), by_elevation.end(), std::size_t{0});
    std::stable_sort(by_elevation.begin(), by_elevation.end(), [&](std::size_t i, std::size_t j) {
        return std::atan2(lasers[i].sinVertCorrection, lasers[i].cosVertCorrection) <
               std::atan2(lasers[j].sinVertCorrection, lasers[j].cosVertCorrection);
    });
    std::vector<int> ring(lasers.size());
    for (std::size_t r = 0; r < ring.size(); ++r) ring[by_elevation[r]] = static_cast<int>(r);
    return ring;
}

VelodyneModel velodyneModel(const Scan& scan, const SensorParams& params) {
    const auto& calibration = calibrationToUse(scan);
    checkCalibration(calibration, params);
    const auto& lasers = calibration.laser_corrections;
    VelodyneModel model;
    model.frame = sensorFrame(scan.sensorPose);
    model.times = firingTimes(scan, calibration.laser_corrections.size());
    model.azimuth_step = azimuthStep(scan);
    const double firing_step = model.azimuth_step * model.times.firing_us / model.times.block_us;
    model.columns = std::clamp(static_cast<int>(std::lround(36000.0 / firing_step)), 90, 7200);
    model.rings = params.planes == 0 ? static_cast<int>(lasers.size()) : params.planes;

    const std::vector<int> ring_of_laser = ringOfLaser(calibration);
    const std::vector<int> new_ring = ringAfterDecimation(static_cast<int>(lasers.size()), params.planes);
    const RangeLimits limits = rangeLimits(params, scan.minRange, scan.maxRange);
    for (std::size_t k = 0; k < model.returns.size(); ++k) {
        const std::size_t laser = k % lasers.size();
        const double time_us = model.times.returnTime(static_cast<int>(k));
        ReturnModel& m = model.returns[k];
        m = returnModel(lasers[laser], 0.01 * model.azimuth_step * time_us / model.times.block_us);
        m.time = static_cast<float>(1e-6 * time_us);
        setRawLimits(limits, model.times.distance_m, m);
        m.column = columnsOn(lasers[laser], firing_step, model.columns);
        const int ring = new_ring[static_cast<std::size_t>(ring_of_laser[laser])];
        m.ring = static_cast<std::uint16_t>(std::max(ring, 0));
        if (ring < 0) m.raw_min = 1, m.raw_max = 0;
    }
    return model;
}

}  // namespace lidar_obstacles
