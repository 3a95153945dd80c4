// SPDX-License-Identifier: BSD-3-Clause
// KITTI odometry (and what has its layout): which file is where.
#include <memory>

#include "kitti_files.h"
#include "point_files.h"

namespace lidar_obstacles::apps {
namespace {

namespace fs = std::filesystem;

/// Everything of an odometry sequence but its points. Rows of the files are scans by their number.
struct Odometry {
    std::vector<fs::path> scans;
    std::vector<Words> times;
    std::vector<Words> poses;  ///< of the left camera, in the frame it has at the beginning; empty if there are none
    Eigen::Isometry3d T_vehicle_camera = Eigen::Isometry3d::Identity();
    std::optional<KittiCamera> colour_camera;  ///< where images are asked for
};

fs::path sequenceFolder(const SequenceOptions& options) {
    const fs::path folder = options.folder;
    if (!fs::exists(folder / "sequences")) return folder;
    if (options.sequence.empty()) throw std::runtime_error(options.folder + ": which sequence? (--sequence 00)");
    return folder / "sequences" / options.sequence;
}

/// poses.txt beside the times, or poses/NN.txt two folders up. Nothing if there is neither.
std::optional<fs::path> posesFile(const fs::path& sequence) {
    const fs::path absolute = fs::canonical(sequence);
    const fs::path beside = absolute / "poses.txt";
    if (fs::exists(beside)) return beside;
    const fs::path file = absolute.parent_path().parent_path() / "poses" / (absolute.filename().string() + ".txt");
    return fs::exists(file) ? std::optional(file) : std::nullopt;
}

Odometry readOdometry(const SequenceOptions& options) {
    const fs::path folder = sequenceFolder(options);
    Odometry all;
    all.scans = scansIn(folder / "velodyne");
    all.times = rowsOf(folder / "times.txt");
    const auto poses = posesFile(folder);
    if (!poses && !options.images) return all;
    all.T_vehicle_camera = vehicleVelo(options) * readOdometryCalibration(folder / "calib.txt").inverse();
    if (poses) all.poses = rowsOf(*poses);
    if (options.images) {
        requireImages(folder / "image_2");
        all.colour_camera = readColourCamera(folder / "calib.txt", all.T_vehicle_camera);
    }
    return all;
}

/// Row of a scan. @throws std::runtime_error if the file has none.
const Words& rowOf(const std::vector<Words>& rows, std::size_t number, const fs::path& scan) {
    if (number < rows.size() && rows[number].size() > 0) return rows[number];
    if (number < rows.size()) rows[number].fail("no time for " + scan.string());
    throw std::runtime_error(scan.string() + ": no time for it: times.txt has " + std::to_string(rows.size()) +
                             " lines only");
}

}  // namespace

Sequence openKittiOdometry(const SequenceOptions& options) {
    const auto all = std::make_shared<Odometry>(readOdometry(options));
    const fs::path images = sequenceFolder(options) / "image_2";
    const auto load = [=](std::size_t k) {
        const fs::path& scan = all->scans.at(k);
        const std::size_t number = numberOf(scan);
        Frame frame;
        frame.timestamp = options.start_time + rowOf(all->times, number, scan).number(0);
        frame.T_vehicle_sensor = vehicleVelo(options);
        readKittiPoints(scan, kKittiPlanes, frame);
        if (number < all->poses.size() && all->poses[number].size() > 0)
            frame.T_world_vehicle =
                all->T_vehicle_camera * isometryOf(all->poses[number]) * all->T_vehicle_camera.inverse();
        if (all->colour_camera)
            frame.image = all->colour_camera->image(images / scan.stem().concat(".png"), frame.timestamp);
        return frame;
    };
    return {all->scans.size(), kKittiPlanes, load, missingOf(all->scans)};
}

}  // namespace lidar_obstacles::apps
