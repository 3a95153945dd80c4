// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "mrpt_bridge/input/ring_view.h"
#include "mrpt_bridge/input/row_elevations.h"
#include "mrpt_bridge/input/sensor_frame.h"
#include "mrpt_bridge/input/velodyne_model.h"

namespace lidar_obstacles {
namespace {

using RangeImage = mrpt::obs::CObservationRotatingScan;

const ImageRows& rowsOf(const RangeImage& scan) {
    const ImageRows* const rows = imageRows(scan.lidarModel);
    if (!rows)
        throw std::runtime_error("the range image's lidarModel is \"" + scan.lidarModel +
                                 "\": elevations are known for " + modelsOfRows() + " only");
    if (rows->lasers.laser_corrections.size() != scan.rowCount)
        throw std::runtime_error("the range image of a " + scan.lidarModel + " has " + std::to_string(scan.rowCount) +
                                 " rows");
    return *rows;
}

void checkImage(const RangeImage& scan) {
    const bool sizes_fit = scan.rangeImage.rows() == scan.rowCount && scan.rangeImage.cols() == scan.columnCount &&
                           (scan.intensityImage.size() == 0 || (scan.intensityImage.rows() == scan.rowCount &&
                                                                scan.intensityImage.cols() == scan.columnCount));
    if (!sizes_fit) throw std::runtime_error("the range image's matrices do not have the size the scan tells");
    const double span = std::abs(scan.azimuthSpan);
    if (!std::isfinite(scan.startAzimuth) || !(span > 0.0 && span < 4.0 * M_PI) || !std::isfinite(scan.sweepDuration) ||
        !std::isfinite(scan.rangeResolution))
        throw std::runtime_error("the range image's azimuths, duration or resolution cannot be right");
    if (!scan.rangeOtherLayers.empty()) throw std::runtime_error("range images of dual return scans are not supported");
}

bool isEmptyColumn(const RangeImage& scan, int column) {
    for (int row = 0; row < scan.rowCount; ++row)
        if (scan.rangeImage(row, column) != 0) return false;
    return true;
}

/// Which columns of the image hold firings, and where they look.
struct ImageColumns {
    int used;    ///< columns that the azimuth span covers
    int stride;  ///< of which every so many is filled
    /// MRPT's converter copies Velodyne azimuths, which turn clockwise, as positive numbers although its documentation
    /// calls positive spans counter-clockwise.
    bool clockwise = false;

    /// Azimuth of a column [rad], counter-clockwise from the sensor's x axis.
    double azimuth(const RangeImage& scan, int column) const {
        const double azimuth = scan.startAzimuth + scan.azimuthSpan * column / used;
        return clockwise ? -azimuth : azimuth;
    }
};

/// MRPT's converter makes the image `rowCount` times as wide as the firings it holds, and fills every second column
/// for a VLP-16 (it leaves out the second firing of a block).
ImageColumns imageColumns(const RangeImage& scan) {
    const auto allEmpty = [&scan](int first, int end, int step) {
        for (int c = first; c < end; c += step)
            if (!isEmptyColumn(scan, c)) return false;
        return true;
    };
    ImageColumns columns{scan.columnCount, 1};
    const int narrow = scan.columnCount / scan.rowCount;
    if (narrow > 0 && scan.columnCount % scan.rowCount == 0 && allEmpty(narrow, scan.columnCount, 1))
        columns.used = narrow;
    if (columns.used > 1 && allEmpty(1, columns.used, 2)) columns.stride = 2;
    return columns;
}

/// Appends the returns of one image column, all rows that are kept.
struct ColumnReader {
    const RangeImage& scan;
    const mrpt::obs::VelodyneCalibration& calibration;
    SensorFrame frame;
    RangeLimits limits;
    bool has_times;
    std::vector<int> ring_of_row;  ///< after decimation; -1: dropped

    void append(int column, const ImageColumns& columns, PointCloud& cloud) const {
        const double ahead = columns.azimuth(scan, column);
        for (int row = 0; row < scan.rowCount; ++row) {
            const int ring = ring_of_row[static_cast<std::size_t>(row)];
            const double range = scan.rangeImage(row, column) * scan.rangeResolution;
            if (ring < 0 || range == 0.0 || !limits.contains(range)) continue;
            const auto& laser = calibration.laser_corrections[static_cast<std::size_t>(row)];
            const double azimuth = ahead + laser.azimuthCorrection * M_PI / 180.0;
            const Eigen::Vector3d p =
                range * Eigen::Vector3d(laser.cosVertCorrection * std::cos(azimuth),
                                        laser.cosVertCorrection * std::sin(azimuth), laser.sinVertCorrection);
            cloud.xyz.push_back(frame.toVehicle(p.cast<float>()));
            cloud.ring.push_back(static_cast<std::uint16_t>(ring));
            if (has_times) cloud.time_offset.push_back(static_cast<float>(scan.sweepDuration * column / columns.used));
            if (scan.intensityImage.size() != 0)
                cloud.intensity.push_back(static_cast<float>(scan.intensityImage(row, column)) / 255.0f);
            cloud.view.column_of.push_back(0);
            const int ahead_of_it = static_cast<int>(std::lround(laser.azimuthCorrection / 360.0 * cloud.view.columns));
            const int place = column / columns.stride - ahead_of_it + cloud.view.columns;
            listInView(cloud, cloud.size() - 1, place % cloud.view.columns);
        }
    }
};

/// @throws std::invalid_argument if the parameters do not fit the image's rows.
std::vector<int> ringOfRow(const mrpt::obs::VelodyneCalibration& calibration, const SensorParams& params) {
    std::vector<int> ring = ringOfLaser(calibration);
    const int rings = static_cast<int>(ring.size());
    if (params.rings != 0 && params.rings != rings)
        throw std::invalid_argument("[sensor] rings = " + std::to_string(params.rings) + ", but the range image has " +
                                    std::to_string(rings) + " rows");
    const std::vector<int> kept = ringAfterDecimation(rings, params.planes);
    for (int& r : ring) r = kept[static_cast<std::size_t>(r)];
    return ring;
}

}  // namespace

PointCloud toPointCloud(const RangeImage& scan, const SensorParams& params, DecodeStats* stats) {
    if (stats) *stats = DecodeStats{};
    const SensorFrame frame = sensorFrame(scan.sensorPose);
    PointCloud cloud = emptyCloud(frame, scan.timestamp);
    if (scan.rangeImage.size() == 0) return cloud;
    checkImage(scan);
    const ImageRows& rows = rowsOf(scan);
    ImageColumns columns = imageColumns(scan);
    columns.clockwise = rows.of_velodyne && scan.azimuthSpan > 0.0;
    // MRPT tells the sense of the turn by the span, and leaves a duration of 0 where it knows none
    const bool has_times = scan.sweepDuration > 0.0 && isTimeOfTurn(scan.sweepDuration);
    if (stats) stats->times_left_out = !has_times && scan.sweepDuration != 0.0;
    const ColumnReader reader{scan,      rows.lasers,
                              frame,     rangeLimits(params, scan.minRange, scan.maxRange),
                              has_times, ringOfRow(rows.lasers, params)};
    OrganizedView& view = cloud.view;
    view.rings = params.planes == 0 ? scan.rowCount : params.planes;
    const double firings_per_turn = 2.0 * M_PI / std::abs(scan.azimuthSpan) * columns.used / columns.stride;
    view.columns = static_cast<int>(std::lround(std::clamp(firings_per_turn, 1.0, 7200.0)));
    view.index.assign(static_cast<std::size_t>(view.rings) * static_cast<std::size_t>(view.columns), -1);
    for (int column = 0; column < columns.used; column += columns.stride) reader.append(column, columns, cloud);
    return cloud;
}

}  // namespace lidar_obstacles
