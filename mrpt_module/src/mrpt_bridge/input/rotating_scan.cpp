// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/velodyne_kinds.h"
#include "mrpt_bridge/input/ring_view.h"
#include "mrpt_bridge/input/sensor_frame.h"
#include "mrpt_bridge/input/velodyne_model.h"

namespace lidar_obstacles {
namespace {

using RangeImage = mrpt::obs::CObservationRotatingScan;

/// Letters and figures of a name, in lower case: "VLP-16" and "vlp16" are the same.
std::string plainName(const std::string& name) {
    std::string plain;
    for (const char c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) != 0)
            plain += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return plain;
}

/// The lasers behind the rows, in row order.
const mrpt::obs::VelodyneCalibration& calibrationOf(const RangeImage& scan) {
    using Name = std::pair<const char*, std::uint8_t>;
    const std::string name = plainName(scan.lidarModel);
    const mrpt::obs::VelodyneCalibration* calibration = nullptr;
    for (const auto& [known, kind] : {Name("vlp16", 0x22), Name("puck", 0x22), Name("pucklite", 0x22),
                                      Name("puckhires", 0x24), Name("hdl32e", 0x21), Name("hdl32", 0x21)})
        if (name == known || name == std::string("velodyne") + known)
            calibration = lidar_obstacles::calibrationOf(kind);
    if (!calibration)
        throw std::runtime_error("the range image's lidarModel is \"" + scan.lidarModel +
                                 "\": elevations are known for \"VLP-16\", \"Puck Hi-Res\" and \"HDL-32E\" only");
    if (calibration->laser_corrections.size() != scan.rowCount)
        throw std::runtime_error("the range image of a " + scan.lidarModel + " has " + std::to_string(scan.rowCount) +
                                 " rows");
    return *calibration;
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

    /// Azimuth of a column [rad], counter-clockwise from the sensor's x axis.
    double azimuth(const RangeImage& scan, int column) const {
        const double turned = std::abs(scan.azimuthSpan) * column / used;
        // MRPT's converter copies Velodyne azimuths, which turn clockwise, as positive numbers although its
        // documentation calls positive spans counter-clockwise.
        return scan.azimuthSpan > 0.0 ? -(scan.startAzimuth + turned) : scan.startAzimuth - turned;
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
    std::vector<int> ring_of_row;  ///< after decimation; -1: dropped

    void append(int column, const ImageColumns& columns, PointCloud& cloud) const {
        const double azimuth = columns.azimuth(scan, column);
        const double cos_az = std::cos(azimuth), sin_az = std::sin(azimuth);
        for (int row = 0; row < scan.rowCount; ++row) {
            const int ring = ring_of_row[static_cast<std::size_t>(row)];
            const double range = scan.rangeImage(row, column) * scan.rangeResolution;
            if (ring < 0 || range == 0.0 || !limits.contains(range)) continue;
            const auto& laser = calibration.laser_corrections[static_cast<std::size_t>(row)];
            const Eigen::Vector3d p =
                range * Eigen::Vector3d(laser.cosVertCorrection * cos_az, laser.cosVertCorrection * sin_az,
                                        laser.sinVertCorrection);
            cloud.xyz.push_back(frame.toVehicle(p.cast<float>()));
            cloud.ring.push_back(static_cast<std::uint16_t>(ring));
            cloud.time_offset.push_back(static_cast<float>(scan.sweepDuration * column / columns.used));
            if (scan.intensityImage.size() != 0)
                cloud.intensity.push_back(static_cast<float>(scan.intensityImage(row, column)) / 255.0f);
            cloud.view.column_of.push_back(0);
            listInView(cloud, cloud.size() - 1, column / columns.stride % cloud.view.columns);
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

PointCloud toPointCloud(const RangeImage& scan, const SensorParams& params) {
    const SensorFrame frame = sensorFrame(scan.sensorPose);
    PointCloud cloud = emptyCloud(frame, scan.timestamp);
    if (scan.rangeImage.size() == 0) return cloud;
    checkImage(scan);
    const auto& calibration = calibrationOf(scan);
    const ImageColumns columns = imageColumns(scan);
    const ColumnReader reader{scan, calibration, frame, rangeLimits(params, scan.minRange, scan.maxRange),
                              ringOfRow(calibration, params)};
    OrganizedView& view = cloud.view;
    view.rings = params.planes == 0 ? scan.rowCount : params.planes;
    const double firings_per_turn = 2.0 * M_PI / std::abs(scan.azimuthSpan) * columns.used / columns.stride;
    view.columns = static_cast<int>(std::lround(std::clamp(firings_per_turn, 1.0, 7200.0)));
    view.index.assign(static_cast<std::size_t>(view.rings) * static_cast<std::size_t>(view.columns), -1);
    for (int column = 0; column < columns.used; column += columns.stride) reader.append(column, columns, cloud);
    return cloud;
}

}  // namespace lidar_obstacles
