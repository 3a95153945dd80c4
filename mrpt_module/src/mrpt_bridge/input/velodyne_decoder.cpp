// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt_bridge/input/velodyne_decoder.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "mrpt_bridge/input/velodyne_model.h"

namespace lidar_obstacles {
namespace {

using Scan = mrpt::obs::CObservationVelodyneScan;

/// cos and sin of every azimuth a block can name, in hundredths of a degree.
struct AzimuthTable {
    std::array<float, Scan::ROTATION_MAX_UNITS> cos, sin;

    AzimuthTable() {
        for (std::size_t i = 0; i < cos.size(); ++i) {
            const double azimuth = static_cast<double>(i) * M_PI / 18000.0;
            cos[i] = static_cast<float>(std::cos(azimuth));
            sin[i] = static_cast<float>(std::sin(azimuth));
        }
    }
};

const AzimuthTable& azimuthTable() {
    static const AzimuthTable table;
    return table;
}

void resizeReturns(PointCloud& cloud, std::size_t n) {
    cloud.xyz.resize(n);
    cloud.ring.resize(n);
    cloud.intensity.resize(n);
    cloud.time_offset.resize(n);
    cloud.view.column_of.resize(n);
}

/// The decoder of one scan: writes returns one after the other into a cloud with room for all of them.
class Decoder {
  public:
    Decoder(const VelodyneModel& model, PointCloud& cloud) : model_(model), cloud_(cloud), table_(azimuthTable()) {}

    void decode(const Scan::TVelodyneRawPacket& packet, double time, DecodeStats& stats) {
        const bool dual = isDualReturn(packet);
        for (int b = 0; b < Scan::BLOCKS_PER_PACKET; ++b) {
            const Scan::raw_block_t& block = packet.blocks[b];
            if (!isUsable(block)) {
                ++stats.damaged_blocks;
                continue;
            }
            const int firing = dual ? b / 2 : b;
            const bool second = dual && b % 2 == 1 && isUsable(packet.blocks[b - 1]);
            const double block_time = time + 1e-6 * model_.times.block_us * firing;
            decode(block, second ? &packet.blocks[b - 1] : nullptr, static_cast<float>(block_time));
        }
    }

    std::size_t size() const { return n_; }

  private:
    /// @param twin  the other block of the same firing if that was decoded already (dual return), else null.
    void decode(const Scan::raw_block_t& block, const Scan::raw_block_t* twin, float time) {
        const float cos_az = table_.cos[block.rotation()], sin_az = table_.sin[block.rotation()];
        const Eigen::Matrix3f& R = model_.frame.rotation;
        const Eigen::Vector3f A = cos_az * R.col(0) - sin_az * R.col(1);
        const Eigen::Vector3f B = -sin_az * R.col(0) - cos_az * R.col(1);
        const Eigen::Vector3f Z = R.col(2);
        const int lasers = model_.times.lasers;
        const auto unit = static_cast<float>(model_.times.distance_m);
        for (int first = 0; first < Scan::SCANS_PER_BLOCK; first += lasers) {
            const int column = columnOf(block.rotation() + model_.azimuth_step * first / Scan::SCANS_PER_BLOCK);
            for (int k = first; k < first + lasers; ++k) {
                const ReturnModel& m = model_.returns[static_cast<std::size_t>(k)];
                const std::uint16_t raw = block.laser_returns[k].distance();
                if (raw < m.raw_min || raw > m.raw_max) continue;
                if (twin && twin->laser_returns[k].distance() == raw) continue;
                const float d = static_cast<float>(raw) * unit + m.distance_correction;
                cloud_.xyz[n_] =
                    model_.frame.translation + (d * m.a + m.a0) * A + (d * m.b + m.b0) * B + (d * m.c + m.c0) * Z;
                cloud_.ring[n_] = m.ring;
                cloud_.intensity[n_] = static_cast<float>(block.laser_returns[k].intensity()) * (1.0f / 255.0f);
                cloud_.time_offset[n_] = time + m.time;
                list(m.ring, (column + m.column) % model_.columns);
            }
        }
    }

    /// Columns are counted from the scan's first firing, whose azimuth is the middle of column 0: rounding then puts
    /// each firing of a steadily turning sensor into a column of its own.
    int columnOf(double azimuth) {
        if (first_azimuth_ < 0.0) first_azimuth_ = azimuth;
        const double column = (azimuth - first_azimuth_ + 36000.0) * model_.columns / 36000.0 + 0.5;
        return static_cast<int>(column) % model_.columns;
    }

    /// Enters the newest return into the view, unless a nearer one stands at its place, and makes it count.
    void list(int ring, int column) {
        cloud_.view.column_of[n_] = column;
        std::int32_t& listed = cloud_.view.at(ring, column);
        if (listed < 0 || squaredRange(n_) < squaredRange(static_cast<std::size_t>(listed)))
            listed = static_cast<std::int32_t>(n_);
        ++n_;
    }

    float squaredRange(std::size_t i) const { return (cloud_.xyz[i] - model_.frame.translation).squaredNorm(); }

    const VelodyneModel& model_;
    PointCloud& cloud_;
    const AzimuthTable& table_;
    std::size_t n_ = 0;
    double first_azimuth_ = -1.0;  ///< [0.01 deg]; negative until a block was seen
};

}  // namespace

PointCloud decodePackets(const Scan& scan, const SensorParams& params, DecodeStats& stats) {
    constexpr std::size_t kMaxPackets = 1000;  // ten turns of a VLP-16 are 750
    if (scan.scan_packets.size() > kMaxPackets)
        throw std::runtime_error("the scan holds " + std::to_string(scan.scan_packets.size()) + " packets; more than " +
                                 std::to_string(kMaxPackets) + " cannot be one scan");
    const VelodyneModel model = velodyneModel(scan, params);
    const PacketClock clock = packetClock(scan, model.times.block_us / model.azimuth_step);

    PointCloud cloud = emptyCloud(model.frame, scan.timestamp);
    cloud.timestamp -= clock.first;  // the observation's stamp is that of its first packet, not of the earliest
    cloud.view.rings = model.rings;
    cloud.view.columns = model.columns;
    cloud.view.index.assign(static_cast<std::size_t>(model.rings) * static_cast<std::size_t>(model.columns), -1);
    resizeReturns(cloud, scan.scan_packets.size() * Scan::SCANS_PER_PACKET);

    Decoder decoder(model, cloud);
    stats.packets = static_cast<int>(scan.scan_packets.size());
    stats.retimed_packets = clock.set_anew;
    for (std::size_t i = 0; i < scan.scan_packets.size(); ++i)
        decoder.decode(scan.scan_packets[i], clock.offset[i], stats);
    resizeReturns(cloud, decoder.size());
    return cloud;
}

}  // namespace lidar_obstacles
