/// @file
/// octomap-build: a map of what stands still, from a rawlog with poses. Parses, wires, reports.
#include <cstdio>
#include <exception>
#include <string>

#include "common/address_space.h"
#include "common/message_of.h"
#include "common/progress_bar.h"
#include "lidar_obstacles/deskew.h"
#include "lidar_obstacles/mrpt_bridge/config_file.h"
#include "lidar_obstacles/mrpt_bridge/observations.h"
#include "lidar_obstacles/mrpt_bridge/pose_feed.h"
#include "lidar_obstacles/static_map.h"
#include "options.h"

namespace {

using namespace lidar_obstacles;
using namespace lidar_obstacles::apps;

int report(int code, const std::string& message) {
    std::fprintf(stderr, "octomap-build: error: %s\n", message.c_str());
    return code;
}

DetectorParams readParams(const Options& options) {
    DetectorParams params = options.config.empty() ? DetectorParams{} : loadParams(options.config);
    for (const std::string& assignment : options.set) setParam(params, assignment);
    validate(params);
    return params;
}

EgoSource requirePoses(const Options& options, const DetectorParams& params) {
    const EgoSource source = chooseEgoSource(options.input, params.ego.source);
    if (source.kind == EgoKind::None) throw UsageError(options.input + ": no poses of the vehicle in it");
    if (source.kind == EgoKind::Imu)
        throw UsageError(options.input + ": '" + source.label + "' tells rotations only; a map needs positions");
    return source;
}

struct Count {
    std::size_t seen = 0;  ///< scans of the lidar
    std::size_t inserted = 0;
    std::size_t lost = 0;  ///< without a pose
};

/// Inserts the selected scans whose motion is known.
Count build(PoseFeed& feed, Trajectory& trajectory, const Options& options, const SensorParams& sensor,
            StaticMapBuilder& map) {
    Count count;
    ProgressBar progress;
    while (const auto item = feed.next()) {
        if (!item->observation || !isLidarScan(*item->observation)) continue;
        if (options.sensor_label && item->observation->sensorLabel != *options.sensor_label) continue;
        const auto index = static_cast<long>(count.seen++);
        if (index > options.to) break;
        if (index < options.from || (index - options.from) % options.every != 0) continue;
        const Deskewed scan = deskew(*toPointCloud(*item->observation, sensor), trajectory);
        const PoseAt pose = trajectory.at(scan.cloud.timestamp);
        trajectory.forgetBefore(scan.cloud.timestamp - 2.0);
        if (!pose.T_world_vehicle || scan.how == Deskewing::NoMotion) {
            ++count.lost;
            continue;
        }
        map.insert(scan.cloud, *pose.T_world_vehicle);
        ++count.inserted;
        progress.update(feed.progress(), count.inserted);
    }
    return count;
}

int run(const Options& options) {
    const DetectorParams params = readParams(options);
    const EgoSource ego = requirePoses(options, params);
    const auto source = openScanSource(options.input);
    Trajectory trajectory(params.ego);
    PoseFeed feed(*source, ego, [&](const StampedPose& pose) { trajectory.add(pose); });
    StaticMapBuilder map(params.octomap.resolution, params.octomap.range);
    const Count count = build(feed, trajectory, options, params.sensor, map);
    if (count.inserted == 0) throw std::runtime_error(options.input + ": no scan with a pose among those asked for");
    map.save(options.output);
    if (!feed.remarks().empty()) std::fprintf(stderr, "octomap-build: %s\n", feed.remarks().c_str());
    std::printf("%zu scans by the poses of '%s' (%zu without a pose left out), %zu nodes of %g m: see %s\n",
                count.inserted, ego.label.c_str(), count.lost, map.size(), params.octomap.resolution,
                options.output.c_str());
    return feed.status() == SourceStatus::Damaged ? report(1, feed.message()) : 0;
}

}  // namespace

int main(int argc, char** argv) {
    try {
        capAddressSpace();
        const auto options = parseOptions(argc, argv);
        return options ? run(*options) : 0;
    } catch (const UsageError& e) {
        return report(2, e.what());
    } catch (const ConfigError& e) {
        return report(2, e.what());
    } catch (const std::invalid_argument& e) {  // parameters that do not go together or do not fit the input
        return report(2, e.what());
    } catch (const std::bad_alloc&) {
        return report(1, "out of memory");
    } catch (const std::exception& e) {
        return report(1, messageOf(e));
    }
}
