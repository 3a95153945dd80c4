// SPDX-License-Identifier: BSD-3-Clause
#include "shown_scan.h"

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <chrono>
#include <cstring>
#include <stdexcept>

#include "common/message_of.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#ifdef LIDAR_OBSTACLES_WITH_TRUTH
#include "lidar_obstacles/evaluation/truth.h"
#endif

namespace lidar_obstacles::apps {
namespace {

using Clock = std::chrono::steady_clock;
using VelodyneScan = mrpt::obs::CObservationVelodyneScan;

double msSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// Takes the returns of one kind out of the packets in dual return mode: of a pair of blocks the first holds the last
/// returns, the second the strongest ones. A distance of zero is no return.
void keepReturns(VelodyneScan& scan, const DualReturns& dual) {
    constexpr std::size_t kBlocks = 12;
    constexpr std::size_t kBlockBytes = 100;
    for (auto& packet : scan.scan_packets) {
        if (packet.laser_return_mode != VelodyneScan::RETMODE_DUAL) continue;
        auto* bytes = reinterpret_cast<std::uint8_t*>(&packet);
        for (std::size_t b = 0; b < kBlocks; ++b) {
            const bool keep = b % 2 == 0 ? dual.last : dual.strongest;
            if (!keep) std::memset(bytes + b * kBlockBytes + 4, 0, kBlockBytes - 4);
        }
    }
}

std::optional<PointCloud> decode(const mrpt::obs::CObservation& scan, const DetectorSetup& setup) {
    const auto* velodyne = dynamic_cast<const VelodyneScan*>(&scan);
    if (!velodyne || (setup.dual.last && setup.dual.strongest)) return toPointCloud(scan, setup.params.sensor);
    VelodyneScan kept = *velodyne;
    keepReturns(kept, setup.dual);
    return toPointCloud(kept, setup.params.sensor);
}

}  // namespace

std::shared_ptr<ShownScan> decodeScan(const mrpt::obs::CObservation& scan, std::size_t scan_index,
                                      const DetectorSetup& setup) {
    auto shown = std::make_shared<ShownScan>();
    shown->scan_index = scan_index;
    const auto start = Clock::now();
    try {
        shown->cloud = decode(scan, setup).value_or(PointCloud{});
        shown->decode_ms = msSince(start);
    } catch (const std::invalid_argument&) {
        throw;  // parameters that do not fit the sensor: not the input's fault
    } catch (const std::exception& e) {
        shown->error = "scan " + std::to_string(scan_index) + ": " + messageOf(e);
    }
    return shown;
}

void ShownScan::take(SequenceResult found, const ObstacleDetector& detector, const DetectorParams& params) {
    used = usedText(found, params);
    clustering = params.clustering;
    region = params.region;
    own_body = OwnBody(params.region.own_body);
    voxels = detector.filterVoxels();
    const Trajectory& trajectory = detector.trajectory();
    if (!trajectory.rotationOnly()) T_map_vehicle = trajectory.at(found.cloud.timestamp).T_world_vehicle;
    cloud = std::move(found.cloud);
    result = std::move(found.detection);
}

double totalMs(const ShownScan& scan) {
    double total = scan.decode_ms;
    for (const StageTime& t : scan.result.timing) total += t.ms;
    return total;
}

std::string usedText(const SequenceResult& found, const DetectorParams& params) {
    std::string text = usesPoses(params) ? std::string("pose: ") + toString(found.pose) : "";
    const auto add = [&text](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
    if (found.deskewing == Deskewing::Done) add("de-skewed");
    if (found.deskewing == Deskewing::NoPointTimes) add("not de-skewed: no point times");
    if (found.deskewing == Deskewing::NoMotion)
        add(std::string("not de-skewed: poses ") + toString(found.deskew_poses));
    if (found.filtered)
        add("3D filter: " + std::to_string(found.detection.filtered.size()) + " returns out, " +
            std::to_string(found.filter_voxels) + " voxels");
    if (found.earlier_scans > 0) add("grid of " + std::to_string(found.earlier_scans + 1) + " scans");
    if (found.mended) add("seam mended");
    return text;
}

#ifdef LIDAR_OBSTACLES_WITH_TRUTH
TruthByScan readTruthByScan(const std::string& file) {
    TruthByScan truth;
    for (const auto& object : evaluation::readTruth(file, evaluation::TruthPose::Observed)) {
        if (object.num_points == 0 || !object.box.center.allFinite()) continue;
        truth[static_cast<std::size_t>(object.scan_index)].push_back(
            {object.type + " " + object.object_id, object.box});
    }
    return truth;
}
#else
TruthByScan readTruthByScan(const std::string& file) {
    throw std::runtime_error(file + ": this obstacle-replay was built without lidar_obstacles::evaluation");
}
#endif

}  // namespace lidar_obstacles::apps
